#include "surface/formula/names.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "surface/formula/diagnostic.hpp"
#include "surface/formula/limits.hpp"
#include "surface/formula/solids.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

constexpr std::string_view kLetters = "xyzw";
constexpr int kAny = 1 << 30;

constexpr Function kFunctions[] = {
    {"sqrt", Op::sqrt, 1, 1},      {"cbrt", Op::cbrt, 1, 1}, {"abs", Op::absolute, 1, 1}, {"exp", Op::exp, 1, 1},
    {"log", Op::log, 1, 1},        {"sin", Op::sin, 1, 1},   {"cos", Op::cos, 1, 1},      {"tan", Op::tan, 1, 1},
    {"asin", Op::asin, 1, 1},      {"acos", Op::acos, 1, 1}, {"atan", Op::atan, 1, 1},    {"atan2", Op::atan2, 2, 2},
    {"sinh", Op::sinh, 1, 1},      {"cosh", Op::cosh, 1, 1}, {"tanh", Op::tanh, 1, 1},    {"min", Op::minimum, 2, kAny},
    {"max", Op::maximum, 2, kAny}, {"pow", Op::power, 2, 2}, {"sign", Op::sign, 1, 1},
};

/// Other names of these functions.
constexpr std::pair<std::string_view, std::string_view> kSynonyms[] = {
    {"ln", "log"},        {"arcsin", "asin"}, {"arccos", "acos"}, {"arctan", "atan"},
    {"arctan2", "atan2"}, {"fabs", "abs"},    {"sgn", "sign"},
};

/// What people coming from elsewhere write.
constexpr std::pair<std::string_view, std::string_view> kForeignNames[] = {
    {"power", "pow"},
    {"tg", "tan"},
    {"sh", "sinh"},
    {"ch", "cosh"},
    {"th", "tanh"},
    {"minimum", "min"},
    {"maximum", "max"},
    {"Pi", "pi"},
    {"PI", "pi"},
    {"log10", "log(t)/log(10)"},
    {"log2", "log(t)/log(2)"},
    {"lg", "log(t)/log(10)"},
    {"cot", "1/tan(t)"},
    {"ctg", "1/tan(t)"},
    {"sec", "1/cos(t)"},
    {"csc", "1/sin(t)"},
    {"asinh", "log(t+sqrt(t^2+1))"},
    {"acosh", "log(t+sqrt(t^2-1))"},
    {"atanh", "log((1+t)/(1-t))/2"},
    {"coth", "1/tanh(t)"},
    {"sech", "1/cosh(t)"},
    {"and", ";"},
};

bool is_numbered(std::string_view name) {
  return name.size() > 1 && name[0] == 'x' &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_letter_variable(std::string_view name) { return name.size() == 1 && kLetters.find(name[0]) != kLetters.npos; }

}  // namespace

const Function* find_function(std::string_view name) {
  for (const auto& [synonym, ours] : kSynonyms) {
    if (name == synonym) name = ours;
  }
  const auto* found = std::find_if(std::begin(kFunctions), std::end(kFunctions),
                                   [&](const Function& function) { return function.name == name; });
  return found == std::end(kFunctions) ? nullptr : found;
}

Names::Names(const std::vector<std::string>& variables, const std::map<std::string, double>& parameters,
             std::optional<Index> dim)
    : variables_(&variables), parameters_(&parameters), dim_(dim) {
  for (const std::string& name : variables) {
    check_new("the variable", name);
    if (std::count(variables.begin(), variables.end(), name) > 1) {
      throw InvalidArgument("the variable " + quoted(name) + " is named twice");
    }
  }
  const auto num_variables = static_cast<Index>(variables.size());
  if (!variables.empty() && dim.value_or(num_variables) != num_variables) {
    throw InvalidArgument(std::to_string(num_variables) + " variables are named, but the dimension is " +
                          std::to_string(*dim));
  }
  variables_used_ = num_variables;
  for (const auto& [name, value] : parameters) {
    check_new("the parameter", name);
    const bool is_variable =
        variables.empty() ? is_letter_variable(name) || is_numbered(name) : own_variable(name).has_value();
    if (is_variable) throw InvalidArgument("the parameter " + quoted(name) + " is the name of a variable");
    if (!std::isfinite(value)) {
      throw InvalidArgument("the parameter " + quoted(name) + " is " + std::to_string(value) + ", it must be finite");
    }
  }
}

void Names::check_new(const std::string& kind, const std::string& name) const {
  const std::string who = kind + " " + quoted(name);
  if (!is_name(name)) throw InvalidArgument(who + " is not a name: letters, digits and _, a letter first");
  if (name == "pi" || name == "e") throw InvalidArgument(who + " is the name of a constant");
  if (find_function(name) != nullptr) throw InvalidArgument(who + " is the name of a function");
}

std::optional<Index> Names::own_variable(std::string_view name) const {
  const auto found = std::find(variables_->begin(), variables_->end(), name);
  if (found == variables_->end()) return std::nullopt;
  return static_cast<Index>(found - variables_->begin());
}

std::optional<std::uint32_t> Names::variable(std::string_view text, const Token& token) {
  if (!variables_->empty()) {
    const auto own = own_variable(token.text);
    return own ? std::optional(static_cast<std::uint32_t>(*own)) : std::nullopt;
  }
  Index index = 0;
  Style style = Style::letters;
  if (is_letter_variable(token.text)) {
    index = static_cast<Index>(kLetters.find(token.text[0]));
  } else if (is_numbered(token.text)) {
    style = Style::numbers;
    const auto result = std::from_chars(token.text.data() + 1, token.text.data() + token.text.size(), index);
    if (token.text[1] == '0') {
      throw parse_error(text, token.column,
                        "there is no variable " + quoted(token.text) + ": they are x1, x2, ..., without leading zeros");
    }
    if (result.ec != std::errc() || index > kMaxDim) {
      throw parse_error(
          text, token.column,
          "the variable " + quoted(token.text) + " is beyond the largest dimension, " + std::to_string(kMaxDim));
    }
    --index;
  } else {
    return std::nullopt;
  }
  if (style_ != Style::undecided && style_ != style) {
    throw parse_error(
        text, token.column,
        "x y z w and x1 x2 ... are mixed in one formula: use one kind (x1 is x, x2 is y, x3 is z, x4 is w)");
  }
  style_ = style;
  if (dim_ && index >= *dim_) {
    throw parse_error(text, token.column,
                      std::string(token.text) + " is variable number " + std::to_string(index + 1) +
                          ", but the dimension is " + std::to_string(*dim_));
  }
  variables_used_ = std::max(variables_used_, index + 1);
  return static_cast<std::uint32_t>(index);
}

bool Names::use_space() {
  constexpr Index kSpace = 3;
  const Index most = variables_->empty() ? dim_.value_or(kSpace) : static_cast<Index>(variables_->size());
  if (most < kSpace) return false;
  variables_used_ = std::max(variables_used_, kSpace);
  return true;
}

std::optional<NodeId> Names::definition(std::string_view name) const {
  const auto found = definitions_.find(name);
  return found == definitions_.end() ? std::nullopt : std::optional(found->second);
}

void Names::check_definable(const std::string& name) const {
  check_new("the definition", name);
  const bool is_variable =
      variables_->empty() ? is_letter_variable(name) || is_numbered(name) : own_variable(name).has_value();
  if (is_variable) throw InvalidArgument("the definition " + quoted(name) + " is the name of a variable");
  if (find_solid_function(name) != nullptr) {
    throw InvalidArgument("the definition " + quoted(name) + " is the name of a function");
  }
  if (definition(name)) throw InvalidArgument(quoted(name) + " is defined twice");
}

std::optional<double> Names::value(std::string_view name) const {
  if (name == "pi") return std::numbers::pi;
  if (name == "e") return std::numbers::e;
  const auto found = parameters_->find(std::string(name));
  if (found == parameters_->end()) return std::nullopt;
  return found->second;
}

std::size_t Names::first_factor(std::string_view name) const {
  if (!variables_->empty() || value(name) || definition(name)) return name.size();
  std::size_t first = 0;
  for (std::size_t at = 0; at < name.size();) {
    std::size_t end = at + 1;
    if (kLetters.find(name[at]) == kLetters.npos) return name.size();
    while (end < name.size() && name[end] >= '0' && name[end] <= '9') ++end;
    if (end > at + 1 && name[at] != 'x') return name.size();
    if (first == 0) first = end;
    at = end;
  }
  return first;
}

UnknownName Names::unknown(std::string_view text, const Token& token) const {
  constexpr std::size_t kLongestShown = 40;
  const std::string_view name = token.text.substr(0, kLongestShown);  // enough to compare
  std::string reason = quoted(name) + " is unknown";

  std::vector<std::string_view> known;
  for (const auto& [parameter, value] : *parameters_) known.push_back(parameter);
  for (const std::string& variable : *variables_) known.push_back(variable);
  if (variables_->empty()) {
    for (const char& letter : kLetters) known.emplace_back(&letter, 1);
  }
  known.insert(known.end(), {"pi", "e"});
  for (const Function& function : kFunctions) known.push_back(function.name);
  for (const SolidFunction& function : solid_functions()) known.push_back(function.name);
  for (const auto& [defined, node] : definitions_) known.push_back(defined);

  std::string_view nearest = nearest_name(name, known);
  for (const auto& [foreign, ours] : kForeignNames) {
    if (name == foreign) nearest = ours;
  }
  if (!nearest.empty()) reason += ", did you mean " + quoted(nearest) + "?";

  const std::size_t next = text.find_first_not_of(' ', token.end);
  if (next != text.npos && text[next] == '(') {
    reason += " (functions:";
    for (const Function& function : kFunctions) reason.append(" ").append(function.name);
    reason += ", and bodies such as sphere(0,0,0,1)";  // thirty names more would hide the rest
    return {parse_error(text, token.column, reason + ")").what(), token.column, std::string(token.text)};
  }
  reason += " (known: ";
  for (const std::string& variable : *variables_) reason += variable + ", ";
  reason += variables_->empty() ? "x y z w or x1 x2 ..., pi, e" : "pi, e";
  for (const auto& [parameter, value] : *parameters_) reason += ", " + parameter;
  return {parse_error(text, token.column, reason + ")").what(), token.column, std::string(token.text)};
}

}  // namespace taut::detail
