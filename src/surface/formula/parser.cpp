#include "surface/formula/parser.hpp"

#include <cmath>
#include <span>
#include <string>

#include "surface/formula/diagnostic.hpp"
#include "surface/formula/lexer.hpp"
#include "surface/formula/limits.hpp"
#include "surface/formula/solids.hpp"

namespace taut::detail {
namespace {

/// How tightly an operator binds. Sums are collected apart, see Parser::end_term.
enum Precedence : int { kProduct = 1, kSign = 2, kPower = 3 };

struct Operator {
  Op op;
  int precedence;
  std::size_t column;
};

/// An open parenthesis, function call or absolute value, or the whole expression: where its parts begin on the shared
/// stacks.
struct Frame {
  const Function* function = nullptr;  // of |...|: abs
  const SolidFunction* solid = nullptr;
  bool bars = false;
  double power = 1;  // of the call's value, as in sin^2(x)
  std::size_t column = 0;
  std::size_t operators = 0;
  std::size_t terms = 0;
  std::size_t arguments = 0;
  bool minus = false;  // the sign before the term being read
  std::size_t sign_column = 0;
};

class Parser {
 public:
  Parser(std::string_view text, Names& names, Graph& graph) : lexer_(text), names_(names), graph_(graph) { advance(); }

  std::vector<NodeId> statements(Statements allowed);
  NodeId only_expression();

 private:
  void statement(Statements allowed);
  void inequality(NodeId lhs);
  void require_variables() const;
  NodeId expression();

  bool operand();        // reads one operand, or an opening (then false: another operand must follow)
  bool after_operand();  // reads what follows an operand; false at the end of the expression
  void name();
  bool function_call(const Function& function);
  [[nodiscard]] const SolidFunction* solid_named(std::string_view name) const;
  void solid_call(const SolidFunction& solid);
  NodeId make_solid(const SolidFunction& solid, std::size_t column, std::size_t first_argument);
  static std::string usage(const SolidFunction& solid) {
    return std::string(solid.name) + "(" + std::string(solid.parameters) + ")";
  }
  double power_of_call(const Function& function);
  void bare_argument(const Function& function, std::size_t column, double power);
  void superscript();
  void close();
  void implicit_product();
  [[nodiscard]] bool ends_an_exponent() const;

  Frame& push_frame(const Function* function, std::size_t column);
  void reduce(int precedence);
  void end_term(bool minus, std::size_t column);
  NodeId end_sum();
  NodeId call(const Function& function, std::size_t column, std::size_t first_argument);
  NodeId checked(NodeId result, std::size_t column) const;

  void advance() {
    previous_ = token_;
    token_ = lexer_.next();
    if (token_.kind != TokenKind::name) return;
    const std::size_t length = names_.first_factor(token_.text);
    if (length < token_.text.size()) token_ = lexer_.shorten(token_, length);
  }
  [[noreturn]] void fail(std::size_t column, const std::string& reason) const {
    throw parse_error(lexer_.text(), column, reason);
  }
  [[nodiscard]] std::string shown() const { return token_.kind == TokenKind::end ? "the end" : quoted(token_.text); }

  Lexer lexer_;
  Names& names_;
  Graph& graph_;
  Token token_;
  Token previous_;
  std::vector<NodeId> components_;
  std::vector<std::size_t> columns_;  // where each component's statement begins
  std::vector<NodeId> values_;
  std::vector<NodeId> terms_;
  std::vector<Operator> operators_;
  std::vector<Frame> frames_;
};

std::vector<NodeId> Parser::statements(Statements allowed) {
  if (token_.kind == TokenKind::end) fail(0, "the formula is empty");
  while (token_.kind != TokenKind::end) {
    const std::size_t column = token_.column;
    statement(allowed);
    if (components_.size() > static_cast<std::size_t>(kMaxDim)) {
      fail(column, "more than " + std::to_string(kMaxDim) + " equations");
    }
    columns_.resize(components_.size(), column);
    if (token_.kind == TokenKind::semicolon) advance();
  }
  require_variables();
  return std::move(components_);
}

NodeId Parser::only_expression() {
  if (token_.kind == TokenKind::end) fail(0, "nothing is defined here");
  const NodeId result = expression();
  if (token_.kind != TokenKind::end) fail(token_.column, "a definition is one expression, it ends before " + shown());
  return result;
}

void Parser::require_variables() const {
  std::vector<bool> varies(graph_.size());
  for (NodeId id = 0; id < graph_.size(); ++id) {
    const Node& node = graph_[id];
    const int operands = operand_count(node.op);
    varies[id] = node.op == Op::variable || (operands > 0 && varies[node.a]) || (operands > 1 && varies[node.b]) ||
                 (operands > 2 && varies[node.c]);
  }
  for (std::size_t i = 0; i < components_.size(); ++i) {
    if (!varies[components_[i]]) fail(columns_[i], "there is no variable in this: it is the same everywhere");
  }
}

void Parser::statement(Statements allowed) {
  if (token_.kind == TokenKind::semicolon) fail(token_.column, "there is nothing before this ';'");
  const NodeId lhs = expression();
  const std::size_t column = token_.column;
  const bool compares = token_.kind == TokenKind::at_least || token_.kind == TokenKind::at_most;
  if (compares && allowed == Statements::equations) {
    fail(column, "an inequality cuts a surface and belongs to its domain; the formula takes = only");
  }
  if (!compares && allowed == Statements::inequalities) {
    fail(column, "a domain is an inequality such as 'z >= 0', and here is none");
  }
  if (compares) {
    inequality(lhs);
  } else if (token_.kind == TokenKind::equal) {
    advance();
    components_.push_back(checked(graph_.subtract(lhs, expression()), column));
  } else {
    components_.push_back(lhs);
  }
  if (token_.kind == TokenKind::equal) fail(token_.column, "a second '=': write several equations as a = b; b = c");
  if (token_.kind != TokenKind::semicolon && token_.kind != TokenKind::end) {
    fail(token_.column, "an equation and an inequality do not mix");
  }
}

void Parser::inequality(NodeId lhs) {
  const TokenKind direction = token_.kind;
  while (token_.kind == TokenKind::at_least || token_.kind == TokenKind::at_most) {
    const Token comparison = token_;
    if (comparison.kind != direction) fail(comparison.column, "the inequalities of a chain must point the same way");
    advance();
    const NodeId rhs = expression();
    const bool at_least = comparison.kind == TokenKind::at_least;
    components_.push_back(checked(at_least ? graph_.subtract(lhs, rhs) : graph_.subtract(rhs, lhs), comparison.column));
    lhs = rhs;
  }
}

NodeId Parser::expression() {
  push_frame(nullptr, token_.column);
  do {
    while (!operand()) {
    }
  } while (after_operand());
  if (frames_.size() > 1) {
    const Frame& open = frames_.back();
    if (open.bars) fail(open.column, "this '|' is never closed");
    if (open.solid != nullptr)
      fail(open.column, "the '(' of this " + std::string(open.solid->name) + " is never closed");
    fail(open.column, open.function ? "the '(' of this " + std::string(open.function->name) + " is never closed"
                                    : "this '(' is never closed");
  }
  const NodeId result = end_sum();
  frames_.pop_back();
  return result;
}

Frame& Parser::push_frame(const Function* function, std::size_t column) {
  frames_.push_back({.function = function,
                     .column = column,
                     .operators = operators_.size(),
                     .terms = terms_.size(),
                     .arguments = values_.size(),
                     .sign_column = column});
  return frames_.back();
}

bool Parser::operand() {
  const std::size_t column = token_.column;
  switch (token_.kind) {
    case TokenKind::number:
      values_.push_back(graph_.constant(token_.number));
      advance();
      return true;
    case TokenKind::name: {
      if (const Function* found = find_function(token_.text)) return function_call(*found);
      if (const SolidFunction* solid = solid_named(token_.text)) {
        solid_call(*solid);
        return false;
      }
      name();
      return true;
    }
    case TokenKind::open:
      push_frame(nullptr, column);
      advance();
      return false;
    case TokenKind::bar:
      push_frame(find_function("abs"), column).bars = true;
      advance();
      return false;
    case TokenKind::minus: operators_.push_back({Op::negate, kSign, column}); [[fallthrough]];
    case TokenKind::plus: advance(); return false;
    case TokenKind::close:
      if (frames_.size() > 1 && previous_.kind == TokenKind::open) fail(column, "there is nothing between '(' and ')'");
      [[fallthrough]];
    default: fail(column, "a number, a variable or '(' is missing before " + shown());
  }
}

void Parser::name() {
  const Token token = token_;
  NodeId node = kNoNode;
  if (const auto index = names_.variable(lexer_.text(), token)) {
    node = graph_.variable(*index);
  } else if (const auto value = names_.value(token.text)) {
    node = graph_.constant(*value);
  } else if (const auto defined = names_.definition(token.text)) {
    node = *defined;
  } else {
    throw names_.unknown(lexer_.text(), token);
  }
  values_.push_back(node);
  advance();
}

/// A call; true if it was read to its end: its argument may do without parentheses.
bool Parser::function_call(const Function& function) {
  const std::size_t column = token_.column;
  advance();
  const double power = power_of_call(function);
  if (token_.kind != TokenKind::open) {
    bare_argument(function, column, power);
    return true;
  }
  push_frame(&function, column).power = power;
  advance();
  return false;
}

/// A parameter or definition of the same name comes first.
const SolidFunction* Parser::solid_named(std::string_view name) const {
  const SolidFunction* const solid = find_solid_function(name);
  return solid == nullptr || names_.value(name) || names_.definition(name) ? nullptr : solid;
}

void Parser::solid_call(const SolidFunction& solid) {
  const std::size_t column = token_.column;
  advance();
  if (token_.kind != TokenKind::open) {
    fail(column, std::string(solid.name) + " is a function and needs parentheses: " + usage(solid));
  }
  if (!names_.use_space()) fail(column, std::string(solid.name) + " is for bodies in space: it needs 3 dimensions");
  push_frame(nullptr, column).solid = &solid;
  advance();
}

NodeId Parser::make_solid(const SolidFunction& solid, std::size_t column, std::size_t first_argument) {
  const std::span<const NodeId> arguments(values_.data() + first_argument, values_.size() - first_argument);
  const std::size_t count = arguments.size();
  // scale takes one factor or three
  const bool between = solid.max_arguments == 4 && solid.min_arguments == 2 && count == 3;
  if (count < solid.min_arguments || count > solid.max_arguments || between) {
    fail(column, usage(solid) + ": here it has " + std::to_string(count) + (count == 1 ? " argument" : " arguments"));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!solid.must_be_positive(i, count) || !graph_.is_constant(arguments[i])) continue;
    const double value = graph_[arguments[i]].value;
    if (value > 0) continue;
    fail(column, usage(solid) + ": argument " + std::to_string(i + 1) + " must be above 0");
  }
  return checked(solid.make(graph_, arguments), column);
}

/// The power between a function's name and its argument, as in sin^2(x); 1 if there is none.
double Parser::power_of_call(const Function& function) {
  if (token_.kind != TokenKind::power && token_.kind != TokenKind::superscript) return 1;
  const std::size_t column = token_.column;
  if (token_.kind == TokenKind::power) advance();
  const double power = token_.number;
  const bool exponent = token_.kind == TokenKind::number || token_.kind == TokenKind::superscript;
  if (!exponent || power < 1 || power != std::floor(power)) {
    fail(column, "only a whole power may stand here: write " + std::string(function.name) + "(...)^p, or " +
                     "the inverse function's own name");
  }
  advance();
  return power;
}

/// One number or name without parentheses, as in sin x. What follows must not be taken for a part of it.
void Parser::bare_argument(const Function& function, std::size_t column, double power) {
  const std::string name(function.name);
  const bool operand =
      token_.kind == TokenKind::number || (token_.kind == TokenKind::name && find_function(token_.text) == nullptr);
  if (!operand || function.max_arguments > 1) {
    fail(column, name + " is a function and needs parentheses: " + name + "(...)");
  }
  if (token_.kind == TokenKind::number) {
    values_.push_back(graph_.constant(token_.number));
    advance();
  } else {
    this->name();
  }
  const NodeId value = call(function, column, values_.size() - 1);
  values_.back() = power == 1 ? value : checked(graph_.binary(Op::power, value, graph_.constant(power)), column);
  const TokenKind next = token_.kind;
  const bool continues = next == TokenKind::power || next == TokenKind::superscript || next == TokenKind::divide ||
                         next == TokenKind::number || next == TokenKind::open ||
                         (next == TokenKind::bar && !frames_.back().bars) ||
                         (next == TokenKind::name && find_function(token_.text) == nullptr);
  if (continues) {
    fail(token_.column, "this can be read two ways, since nothing says where the argument of " + name +
                            " ends: write " + name + "(...)");
  }
}

/// x² = x^2
void Parser::superscript() {
  operators_.push_back({Op::power, kPower, token_.column});
  values_.push_back(graph_.constant(token_.number));
  advance();
  if (token_.kind == TokenKind::power || token_.kind == TokenKind::superscript) {
    fail(token_.column, "two powers in a row: use parentheses");
  }
}

bool Parser::after_operand() {
  while (true) {
    const Token token = token_;
    switch (token.kind) {
      case TokenKind::close:
        if (frames_.back().bars) fail(frames_.back().column, "this '|' is never closed");
        close();
        continue;
      case TokenKind::superscript: superscript(); continue;
      case TokenKind::bar:
        if (frames_.back().bars) {
          close();
          continue;
        }
        implicit_product();
        return true;
      case TokenKind::comma: {
        Frame& frame = frames_.back();
        if (frame.function == nullptr && frame.solid == nullptr) {
          fail(token.column, "a ',' outside of a function's arguments (decimals are written with a point)");
        }
        values_.push_back(end_sum());
        frame.minus = false;
        frame.sign_column = token.column;
        advance();
        return true;
      }
      case TokenKind::plus:
      case TokenKind::minus:
        end_term(token.kind == TokenKind::minus, token.column);
        advance();
        return true;
      case TokenKind::times:
      case TokenKind::divide:
        reduce(kProduct);
        operators_.push_back({token.kind == TokenKind::times ? Op::multiply : Op::divide, kProduct, token.column});
        advance();
        return true;
      case TokenKind::power:
        operators_.push_back({Op::power, kPower, token.column});
        advance();
        return true;
      case TokenKind::number:
      case TokenKind::name:
      case TokenKind::open: implicit_product(); return true;
      default: return false;
    }
  }
}

void Parser::implicit_product() {
  const std::size_t column = token_.column;
  // |x|y|z| has two readings, and which bar opens is only told by the operators between them.
  if (previous_.kind == TokenKind::bar) fail(column, "an operator is missing between '|' and " + shown());
  if (token_.kind == TokenKind::number) fail(column, "an operator is missing before " + shown());
  const bool glued = previous_.kind == TokenKind::name && previous_.end == column;
  if (glued && token_.kind == TokenKind::open && previous_.text == "e") {
    fail(previous_.column, "'e' is a number and no function: write exp(...), or e*(...) for a product");
  }
  if (glued && ends_an_exponent()) fail(column, "a^b c can be read two ways: write a^(b*c) or a^b*c");
  reduce(kSign);
  if (operators_.size() > frames_.back().operators && operators_.back().op == Op::divide) {
    fail(column, "a/b c can be read two ways: write a/(b*c) or (a/b)*c");
  }
  reduce(kProduct);
  operators_.push_back({Op::multiply, kProduct, column});
}

/// Is the last operand read an exponent?
bool Parser::ends_an_exponent() const {
  std::size_t n = operators_.size();
  while (n > frames_.back().operators && operators_[n - 1].op == Op::negate) --n;
  return n > frames_.back().operators && operators_[n - 1].op == Op::power;
}

/// Ends what the innermost frame has opened.
void Parser::close() {
  if (frames_.size() == 1) fail(token_.column, "this ')' closes nothing");
  const NodeId inner = end_sum();
  const Frame frame = frames_.back();
  frames_.pop_back();
  values_.push_back(inner);
  if (frame.function != nullptr) {
    NodeId result = call(*frame.function, frame.column, frame.arguments);
    if (frame.power != 1)
      result = checked(graph_.binary(Op::power, result, graph_.constant(frame.power)), frame.column);
    values_.resize(frame.arguments);
    values_.push_back(result);
  }
  if (frame.solid != nullptr) {
    const NodeId result = make_solid(*frame.solid, frame.column, frame.arguments);
    values_.resize(frame.arguments);
    values_.push_back(result);
  }
  advance();
}

NodeId Parser::call(const Function& function, std::size_t column, std::size_t first_argument) {
  const std::size_t count = values_.size() - first_argument;
  if (count < static_cast<std::size_t>(function.min_arguments) ||
      count > static_cast<std::size_t>(function.max_arguments)) {
    const bool open_ended = function.max_arguments > 2;
    fail(column, std::string(function.name) + " takes " + (open_ended ? "at least " : "") +
                     std::to_string(function.min_arguments) +
                     (function.min_arguments == 1 ? " argument" : " arguments") + ", here it has " +
                     std::to_string(count));
  }
  const NodeId* arguments = values_.data() + first_argument;
  if (function.max_arguments == 1) return checked(graph_.unary(function.op, arguments[0]), column);
  NodeId result = graph_.binary(function.op, arguments[0], arguments[1]);
  for (std::size_t i = 2; i < count; ++i) result = graph_.binary(function.op, result, arguments[i]);
  return checked(result, column);
}

/// Applies the operators of this frame that bind at least as tightly as `precedence`.
void Parser::reduce(int precedence) {
  while (operators_.size() > frames_.back().operators && operators_.back().precedence >= precedence) {
    const Operator top = operators_.back();
    operators_.pop_back();
    const NodeId right = values_.back();
    if (top.op == Op::negate) {
      values_.back() = graph_.negate(right);
      continue;
    }
    values_.pop_back();
    values_.back() = checked(graph_.binary(top.op, values_.back(), right), top.column);
  }
}

void Parser::end_term(bool minus, std::size_t column) {
  reduce(kProduct);
  Frame& frame = frames_.back();
  const NodeId value = values_.back();
  values_.pop_back();
  terms_.push_back(frame.minus ? graph_.negate(value) : value);
  frame.minus = minus;
  frame.sign_column = column;
}

NodeId Parser::end_sum() {
  end_term(false, frames_.back().sign_column);
  return checked(graph_.sum(terms_, frames_.back().terms), frames_.back().sign_column);
}

NodeId Parser::checked(NodeId result, std::size_t column) const {
  if (graph_.size() > kMaxNodes) {
    fail(column, "the formula is too large: more than " + std::to_string(kMaxNodes) + " operations");
  }
  if (graph_.is_constant(result) && !std::isfinite(graph_[result].value)) {
    fail(column, std::isnan(graph_[result].value) ? "this is not a number for any x"
                                                  : "this is infinite, or too large for a double");
  }
  return result;
}

}  // namespace

std::vector<NodeId> parse_statements(std::string_view text, Statements allowed, Names& names, Graph& graph) {
  if (text.size() > kMaxFormulaBytes) {
    throw parse_error(text, kMaxFormulaBytes,
                      "the formula is longer than the " + std::to_string(kMaxFormulaBytes) + " bytes that are read");
  }
  return Parser(text, names, graph).statements(allowed);
}

NodeId parse_expression(std::string_view text, Names& names, Graph& graph) {
  if (text.size() > kMaxFormulaBytes) throw parse_error(text, kMaxFormulaBytes, "the expression is too long");
  return Parser(text, names, graph).only_expression();
}

}  // namespace taut::detail
