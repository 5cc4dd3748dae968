#include "taut/surface/formula.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "surface/formula/clauses.hpp"
#include "surface/formula/formula_function.hpp"
#include "surface/formula/limits.hpp"
#include "surface/formula/names.hpp"
#include "surface/formula/parser.hpp"
#include "surface/formula/scene_lines.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

using detail::Graph;
using detail::Names;
using detail::NodeId;
using detail::Statements;

void require_dim(const std::optional<Index>& dim) {
  if (!dim || (*dim >= 2 && *dim <= detail::kMaxDim)) return;
  throw InvalidArgument("the dimension is " + std::to_string(*dim) + ", it must be 2 to " +
                        std::to_string(detail::kMaxDim));
}

std::shared_ptr<const ImplicitFunction> compile(Graph graph, std::vector<NodeId> components, Index dim) {
  return std::make_shared<detail::FormulaFunction>(
      std::make_shared<const detail::FormulaProgram>(std::move(graph), std::move(components), dim));
}

std::shared_ptr<const ImplicitFunction> parse(std::string_view formula, Statements allowed,
                                              const FormulaOptions& options) {
  require_dim(options.dim);
  Graph graph;
  Names names(options.variables, options.parameters, options.dim);
  std::vector<NodeId> components = detail::parse_statements(formula, allowed, names, graph);
  const Index dim = options.dim.value_or(std::max<Index>(2, names.variables_used()));
  return compile(std::move(graph), std::move(components), dim);
}

/// All inequalities of a surface as one function.
std::shared_ptr<const ImplicitFunction> parse_domain(const FormulaOptions& options, Index dim) {
  Graph graph;
  std::vector<NodeId> components;
  for (const std::string& text : options.domain) {
    try {
      Names names(options.variables, options.parameters, dim);
      const std::vector<NodeId> found = detail::parse_statements(text, Statements::inequalities, names, graph);
      components.insert(components.end(), found.begin(), found.end());
    } catch (const ParseError& error) {
      throw ParseError("in the domain: " + std::string(error.what()), error.column());
    }
  }
  return compile(std::move(graph), std::move(components), dim);
}

}  // namespace

Surface parse_surface(std::string_view formula, const FormulaOptions& options) {
  std::shared_ptr<const ImplicitFunction> function = parse(formula, Statements::equations, options);
  SurfaceExtras extras;
  extras.box = options.box;
  if (!options.domain.empty()) extras.domain = parse_domain(options, function->dim());
  return Surface(std::move(function), std::move(extras));
}

Surface parse_clauses(std::string_view clauses, const FormulaOptions& options) {
  require_dim(options.dim);
  Graph graph;
  const detail::Clauses found = detail::parse_clauses(clauses, graph);
  const Index dim = options.dim.value_or(std::max<Index>(2, found.num_variables));
  if (dim < found.num_variables) throw InvalidArgument("the clauses use z: give at least 3 dimensions");
  SurfaceExtras extras;
  extras.box = options.box;
  if (!options.domain.empty()) extras.domain = parse_domain(options, dim);
  return Surface(compile(std::move(graph), {found.root}, dim), std::move(extras));
}

Surface parse_scene(std::string_view text, const FormulaOptions& options) {
  require_dim(options.dim);
  Graph graph;
  Names names(options.variables, options.parameters, options.dim);
  std::vector<NodeId> components = detail::parse_scene_lines(text, options.parameters, names, graph);
  const Index dim = options.dim.value_or(std::max<Index>(2, names.variables_used()));
  SurfaceExtras extras;
  extras.box = options.box;
  if (!options.domain.empty()) extras.domain = parse_domain(options, dim);
  return Surface(compile(std::move(graph), std::move(components), dim), std::move(extras));
}

std::shared_ptr<const ImplicitFunction> parse_function(std::string_view formula, const FormulaOptions& options) {
  return parse(formula, Statements::any, options);
}

}  // namespace taut
