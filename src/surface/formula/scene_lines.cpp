#include "surface/formula/scene_lines.hpp"

#include <algorithm>

#include "surface/formula/diagnostic.hpp"
#include "surface/formula/lexer.hpp"
#include "surface/formula/parser.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

struct SceneLine {
  std::string text;  // without remarks and the blanks around it
  std::size_t number = 0;
};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == text.npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// Lines that leave a parenthesis open joined with those that follow; empty ones left out.
std::vector<SceneLine> scene_lines(std::string_view text) {
  std::vector<SceneLine> lines;
  std::ptrdiff_t open = 0;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    line = trimmed(line.substr(0, std::min(line.find('#'), line.find("//"))));
    if (line.empty()) continue;
    if (open > 0) {
      lines.back().text.append(" ").append(line);
    } else {
      lines.push_back({std::string(line), number});
    }
    open += std::count(line.begin(), line.end(), '(') - std::count(line.begin(), line.end(), ')');
  }
  return lines;
}

/// The name that a line defines, or nothing where it is an equation or an expression.
std::string_view defined_name(std::string_view line) {
  const std::size_t equal = line.find('=');
  if (equal == line.npos) return {};
  const std::string_view name = trimmed(line.substr(0, equal));
  return is_name(name) ? name : std::string_view();
}

}  // namespace

std::vector<NodeId> parse_scene_lines(std::string_view text, const std::map<std::string, double>& parameters,
                                      Names& names, Graph& graph) {
  const std::vector<SceneLine> lines = scene_lines(text);
  if (lines.empty()) throw ParseError("the scene is empty", 0);
  for (const SceneLine& line : lines) {
    const auto in_line = [&](const std::string& reason, std::size_t column) {
      return ParseError("line " + std::to_string(line.number) + ": " + reason, column);
    };
    try {
      const bool is_last = &line == &lines.back();
      const std::string name(is_last ? std::string_view() : defined_name(line.text));
      if (is_last) return parse_statements(line.text, Statements::equations, names, graph);
      if (name.empty()) {
        throw parse_error(line.text, 0, "only the last line is the surface; a line before it is NAME = BODY");
      }
      const std::string body = line.text.substr(line.text.find('=') + 1);
      const NodeId node = parse_expression(body, names, graph);
      if (parameters.contains(name)) {
        if (!graph.is_constant(node)) throw InvalidArgument("the parameter " + quoted(name) + " is defined as a body");
        continue;
      }
      names.check_definable(name);
      names.define(name, node);
    } catch (const UnknownName& error) {
      throw UnknownName("line " + std::to_string(line.number) + ": " + error.what(), error.column(), error.name());
    } catch (const ParseError& error) {
      throw in_line(error.what(), error.column());
    } catch (const InvalidArgument& error) {
      throw in_line(error.what(), 0);
    }
  }
  return {};
}

}  // namespace taut::detail
