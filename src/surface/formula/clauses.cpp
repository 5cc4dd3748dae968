// Clause files (.vm), as fidget and libfive's tools write them: a clause a line, each a name, an operation and the
// names of earlier clauses; the last one is the function. `#` starts a comment.

#include "surface/formula/clauses.hpp"

#include <charconv>
#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

#include "surface/formula/diagnostic.hpp"
#include "surface/formula/limits.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

struct Operation {
  std::string_view name;
  Op op;
  int operands;
};

constexpr Operation kOperations[] = {
    {"add", Op::add, 2},     {"sub", Op::subtract, 2}, {"mul", Op::multiply, 2},  {"div", Op::divide, 2},
    {"min", Op::minimum, 2}, {"max", Op::maximum, 2},  {"atan2", Op::atan2, 2},   {"pow", Op::power, 2},
    {"neg", Op::negate, 1},  {"abs", Op::absolute, 1}, {"square", Op::square, 1}, {"sqrt", Op::sqrt, 1},
    {"exp", Op::exp, 1},     {"ln", Op::log, 1},       {"sin", Op::sin, 1},       {"cos", Op::cos, 1},
    {"tan", Op::tan, 1},     {"asin", Op::asin, 1},    {"acos", Op::acos, 1},     {"atan", Op::atan, 1},
};

/// They jump: no surface with a tangent plane, and no geodesic.
constexpr std::string_view kSteps[] = {"floor", "ceil", "round", "mod", "compare", "not", "and", "or"};

class ClauseParser {
 public:
  explicit ClauseParser(Graph& graph) : graph_(graph) {}

  Clauses run(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      read_line(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
      position_ += end + 1;
    }
    if (clauses_.root == kNoNode) fail("there is no clause; the file is empty or no clause file");
    if (clauses_.num_variables == 0) fail("the function is constant: no clause is var-x, var-y or var-z");
    return clauses_;
  }

 private:
  [[noreturn]] void fail(const std::string& problem) const {
    throw ParseError("line " + std::to_string(line_) + ": " + problem, position_);
  }

  void read_line(std::string_view line) {
    words_.clear();
    line = line.substr(0, line.find('#'));
    constexpr std::string_view kBlank = " \t\r";
    for (std::size_t begin = line.find_first_not_of(kBlank); begin != std::string_view::npos;) {
      const std::size_t end = std::min(line.find_first_of(kBlank, begin), line.size());
      words_.push_back(line.substr(begin, end - begin));
      begin = line.find_first_not_of(kBlank, end);
    }
    if (words_.empty()) return;
    if (words_.size() < 2) fail("a clause is a name, an operation and its operands");
    if (graph_.size() > kMaxNodes) fail("more than " + std::to_string(kMaxNodes) + " different clauses");
    clauses_.root = clause();
    if (!names_.emplace(words_[0], clauses_.root).second) fail(quoted(words_[0]) + " is named twice");
  }

  NodeId clause() {
    const std::string_view name = words_[1];
    if (name == "const") return constant();
    if (name.starts_with("var-")) return variable(name.substr(4));
    if (name == "recip") {
      require_operands(1);
      return graph_.divide(graph_.constant(1), operand(0));
    }
    for (const Operation& operation : kOperations) {
      if (operation.name != name) continue;
      require_operands(operation.operands);
      if (operation.operands == 1) return graph_.unary(operation.op, operand(0));
      return graph_.binary(operation.op, operand(0), operand(1));
    }
    for (const std::string_view step : kSteps) {
      if (step == name) fail(quoted(name) + " jumps: such a function has no smooth surface");
    }
    fail("there is no operation " + quoted(name));
  }

  NodeId constant() {
    require_operands(1);
    const std::string_view text = words_[2];
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
      fail(quoted(text) + " is no finite number");
    }
    return graph_.constant(value);
  }

  NodeId variable(std::string_view name) {
    require_operands(0);
    constexpr std::string_view kNames = "xyz";
    const std::size_t index = name.size() == 1 ? kNames.find(name[0]) : std::string_view::npos;
    if (index == std::string_view::npos) fail(quoted(words_[1]) + ": the variables are x, y and z");
    clauses_.num_variables = std::max(clauses_.num_variables, static_cast<Index>(index) + 1);
    return graph_.variable(static_cast<std::uint32_t>(index));
  }

  void require_operands(int count) const {
    const auto found = static_cast<int>(words_.size()) - 2;
    if (found == count) return;
    fail(quoted(words_[1]) + " takes " + std::to_string(count) + (count == 1 ? " operand" : " operands") + ", not " +
         std::to_string(found));
  }

  [[nodiscard]] NodeId operand(std::size_t i) const {
    const auto found = names_.find(words_[2 + i]);
    if (found == names_.end()) fail("no clause before it is named " + quoted(words_[2 + i]));
    return found->second;
  }

  Graph& graph_;
  Clauses clauses_;
  std::unordered_map<std::string_view, NodeId> names_;
  std::vector<std::string_view> words_;
  std::size_t line_ = 0;
  std::size_t position_ = 0;
};

}  // namespace

Clauses parse_clauses(std::string_view text, Graph& graph) { return ClauseParser(graph).run(text); }

}  // namespace taut::detail
