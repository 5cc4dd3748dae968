#include "surface/formula/names.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "surface/formula/diagnostic.hpp"
#include "surface/formula/limits.hpp"
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

/// What people coming from elsewhere write.
constexpr std::pair<std::string_view, std::string_view> kForeignNames[] = {
    {"ln", "log"},   {"arcsin", "asin"}, {"arccos", "acos"}, {"arctan", "atan"}, {"arctan2", "atan2"},
    {"fabs", "abs"}, {"sgn", "sign"},    {"power", "pow"},   {"tg", "tan"},      {"sh", "sinh"},
    {"ch", "cosh"},  {"th", "tanh"},     {"minimum", "min"}, {"maximum", "max"}, {"Pi", "pi"},
};

bool is_numbered(std::string_view name) {
  return name.size() > 1 && name[0] == 'x' &&
         std::all_of(name.begin() + 1, name.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool is_letter_variable(std::string_view name) { return name.size() == 1 && kLetters.find(name[0]) != kLetters.npos; }

bool is_name(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !name.empty() && letter(name[0]) &&
         std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

/// Levenshtein distance, letter case ignored at half price so that `Sin` is nearest to `sin`.
double distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  std::vector<double> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = static_cast<double>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    double diagonal = row[0];
    row[0] = static_cast<double>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const double change = a[i - 1] == b[j - 1] ? 0 : lower(a[i - 1]) == lower(b[j - 1]) ? 0.5 : 1;
      const double best = std::min({row[j] + 1, row[j - 1] + 1, diagonal + change});
      diagonal = row[j];
      row[j] = best;
    }
  }
  return row[b.size()];
}

}  // namespace

const Function* find_function(std::string_view name) {
  const auto* found = std::find_if(std::begin(kFunctions), std::end(kFunctions),
                                   [&](const Function& function) { return function.name == name; });
  return found == std::end(kFunctions) ? nullptr : found;
}

Names::Names(const std::map<std::string, double>& parameters, std::optional<Index> dim)
    : parameters_(&parameters), dim_(dim) {
  for (const auto& [name, value] : parameters) {
    const std::string who = "the parameter " + quoted(name);
    if (!is_name(name)) throw InvalidArgument(who + " is not a name: letters, digits and _, a letter first");
    if (is_letter_variable(name) || is_numbered(name)) throw InvalidArgument(who + " is the name of a variable");
    if (name == "pi" || name == "e") throw InvalidArgument(who + " is the name of a constant");
    if (find_function(name) != nullptr) throw InvalidArgument(who + " is the name of a function");
    if (!std::isfinite(value)) throw InvalidArgument(who + " is " + std::to_string(value) + ", it must be finite");
  }
}

std::optional<std::uint32_t> Names::variable(std::string_view text, const Token& token) {
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

std::optional<double> Names::value(std::string_view name) const {
  if (name == "pi") return std::numbers::pi;
  if (name == "e") return std::numbers::e;
  const auto found = parameters_->find(std::string(name));
  if (found == parameters_->end()) return std::nullopt;
  return found->second;
}

ParseError Names::unknown(std::string_view text, const Token& token) const {
  constexpr std::size_t kLongestShown = 40;
  const std::string_view name = token.text.substr(0, kLongestShown);  // enough to compare
  std::string reason = quoted(name) + " is unknown";

  std::vector<std::string_view> known;
  for (const auto& [parameter, value] : *parameters_) known.push_back(parameter);
  for (const char& letter : kLetters) known.emplace_back(&letter, 1);
  known.insert(known.end(), {"pi", "e"});
  for (const Function& function : kFunctions) known.push_back(function.name);

  std::string_view nearest;
  double best = name.size() < 2 ? 0.5 : name.size() <= 4 ? 1 : 2;  // farther names are no suggestion
  for (const std::string_view candidate : known) {
    const double d = distance(name, candidate);
    if (d < best || (d == best && nearest.empty())) {
      best = d;
      nearest = candidate;
    }
  }
  for (const auto& [foreign, ours] : kForeignNames) {
    if (name == foreign) nearest = ours;
  }
  const bool product = name.find_first_not_of(kLetters) == name.npos;
  if (product) {
    reason += ": for a product write ";
    for (std::size_t i = 0; i < name.size(); ++i) reason.append(i > 0 ? "*" : "").append(1, name[i]);
  } else if (!nearest.empty()) {
    reason += ", did you mean " + quoted(nearest) + "?";
  }
  reason += " (known: x y z w or x1 x2 ..., pi, e";
  for (const auto& [parameter, value] : *parameters_) reason += ", " + parameter;
  reason += "; functions";
  for (const Function& function : kFunctions) reason.append(" ").append(function.name);
  return parse_error(text, token.column, reason + ")");
}

}  // namespace taut::detail
