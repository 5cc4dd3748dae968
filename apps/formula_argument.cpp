#include "formula_argument.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>
#include <vector>

#include "points_argument.hpp"
#include "taut/core/error.hpp"

namespace taut::app {
namespace {

/// "torus.txt" of "@torus.txt"; empty where the formula itself is given.
std::string file_of(const std::string& surface) { return surface.starts_with('@') ? surface.substr(1) : ""; }

/// The file's text, comments (# or // to the end of a line) blanked so that columns stay.
std::string read_formula_file(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw IoError(file, "no such file, or not readable; @FILE reads a formula from a text file");
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '#' && text.compare(at, 2, "//") != 0) continue;
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(at), text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  }
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  if (text.empty()) throw IoError(file, "holds no formula");
  return text;
}

bool continues_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || (c & 0x80) != 0; }

bool uses(const std::string& text, const std::string& name) {
  for (std::size_t at = text.find(name); at != text.npos; at = text.find(name, at + 1)) {
    const std::size_t end = at + name.size();
    // A digit in front belongs to a factor: 2R.
    const bool starts =
        at == 0 || !continues_name(text[at - 1]) || std::isdigit(static_cast<unsigned char>(text[at - 1]));
    if (starts && (end == text.size() || !continues_name(text[end]))) return true;
  }
  return false;
}

/// The message with a hint behind its first line: a formula's error goes on with the formula and a caret.
std::string with_hint(const std::string& message, const std::string& hint) {
  const std::size_t end = std::min(message.find('\n'), message.size());
  return message.substr(0, end) + hint + message.substr(end);
}

/// The statement around byte `column`, without the blanks around it.
std::string statement_at(const std::string& text, std::size_t column) {
  const std::size_t before = column == 0 ? text.npos : text.rfind(';', column - 1);
  std::size_t begin = before == text.npos ? 0 : before + 1;
  std::size_t end = std::min(text.find(';', column), text.size());
  while (begin < end && text[begin] == ' ') ++begin;
  while (end > begin && text[end - 1] == ' ') --end;
  return text.substr(begin, end - begin);
}

/// What the user may have meant, as options that say it; empty where nothing is known.
std::string hint_for(const ParseError& error, const std::string& text, const std::string& name) {
  if (!name.empty()) return fmt::format("; if it is a parameter, give --set {}=1; if a variable, --vars", name);
  const std::size_t at = error.column();
  const bool inequality =
      at < text.size() && (text[at] == '<' || text[at] == '>' || text.compare(at, 2, "\xE2\x89") == 0);
  return inequality ? fmt::format("; write --domain '{}'", statement_at(text, at)) : "";
}

/// A formula without "=" means "= 0". Where it takes one sign only, such as a sum of squares, that leaves no surface.
void refuse_forgotten_value(const Surface& surface, const std::string& text) {
  constexpr double kEverywhere = 1e100;  // its fourth power is infinite, and such bounds do no harm
  constexpr double kRounding = 1e-200;   // bounds are rounded outwards, that of a sum of squares to just below 0
  if (text.find('=') != text.npos || surface.codim() != 1) return;
  const Vector lower = Vector::Constant(surface.dim(), -kEverywhere);
  const Vector upper = -lower;
  double least = 0;
  double most = 0;
  if (!surface.function().make_evaluator()->bounds(
          {.n = 1, .lower = lower.data(), .upper = upper.data(), .value_lower = &least, .value_upper = &most})) {
    return;
  }
  if (!(least >= -kRounding) && !(most <= kRounding)) return;
  throw InvalidArgument(
      fmt::format("the formula has no '=' and so means ... = 0, but it is nowhere {} 0: that leaves no "
                  "surface; write = and a value behind it, as in x^2+y^2+4z^2 = 1",
                  least >= -kRounding ? "below" : "above"));
}

/// A=1,B=2 as A=1 and B=2.
std::vector<std::string> single_parameters(const std::vector<std::string>& given) {
  std::vector<std::string> single;
  for (const std::string& text : given) {
    std::istringstream parts(text);
    for (std::string part; std::getline(parts, part, ',');) {
      if (part.size() < text.size() && part.find('=') == std::string::npos) {
        throw UsageError(
            fmt::format("--set {}: '{}' has no name; write NAME=VALUE, as in --set R=1.5,r=0.5", text, part));
      }
      single.push_back(part);
    }
  }
  return single;
}

}  // namespace

FormulaOptions formula_options(const SurfaceArguments& arguments, const std::string& text) {
  FormulaOptions options;
  options.dim = arguments.dim;
  options.domain = arguments.domain;
  std::string all_text = text;
  for (const std::string& condition : arguments.domain) all_text += ";" + condition;
  for (const std::string& given : single_parameters(arguments.parameters)) {
    const std::size_t equals = given.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError("--set " + given + ": write NAME=VALUE, as in --set R=1.5");
    }
    const std::string name = given.substr(0, equals);
    const Vector value =
        parse_numbers(given.substr(equals + 1), "--set " + name, "write one number, as in --set R=1.5");
    options.parameters[name] = value(0);
    if (!text.empty() && !uses(all_text, name)) {
      throw UsageError(fmt::format("--set {}: the formula has no {}; write its name as in the formula", given, name));
    }
  }
  std::istringstream names(arguments.variables);
  for (std::string name; std::getline(names, name, ',');) options.variables.push_back(name);
  return options;
}

bool holds_formula(const std::string& file) {
  constexpr int kLinesLooked = 20;
  std::ifstream in(file, std::ios::binary);
  std::string line;
  for (int i = 0; i < kLinesLooked && std::getline(in, line); ++i) {
    const bool comment = line.starts_with("#") || line.starts_with("//") || line.starts_with("%");
    if (!comment && line.find('=') != line.npos) return true;
  }
  return false;
}

Surface read_formula(const SurfaceArguments& arguments) {
  const std::string file = file_of(arguments.surface);
  const std::string text = file.empty() ? arguments.surface : read_formula_file(file);
  const auto say = [&](const ParseError& error, const std::string& name) {
    std::string message = with_hint(error.what(), hint_for(error, text, name));
    if (!file.empty()) {
      const auto begin = text.begin();
      const auto line =
          1 + std::count(begin, begin + static_cast<std::ptrdiff_t>(std::min(error.column(), text.size())), '\n');
      message = fmt::format("{}: line {}: {}", file, line, message);
    }
    return ParseError(message, error.column());
  };
  const FormulaOptions options = formula_options(arguments, text);
  try {
    Surface surface = parse_surface(text, options);
    refuse_forgotten_value(surface, text);
    return surface;
  } catch (const UnknownName& error) {
    throw say(error, error.name());
  } catch (const ParseError& error) {
    throw say(error, "");
  }
}

}  // namespace taut::app
