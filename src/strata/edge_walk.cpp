#include "strata/edge_walk.hpp"

#include <algorithm>
#include <optional>

#include "strata/chain_tolerances.hpp"

namespace taut::detail {
namespace {

/// Is x, with the edge's conditions zero, a point of it. If not, `condition` is what it breaks, -1 where none does.
///
/// Conditions alone do not tell where faces of one plane are joined (two bars with their tops level): there both hold
/// inside the face. The ring of faces does.
bool is_on_edge(FacetedSurface& surface, int e, const Point3& x, int& condition) {
  const SharpEdge edge = surface.edge(e);
  const double slack = ChainTolerances::on_edge * surface.scale;
  condition = -1;
  double beyond = surface.violation(edge.a, x, &condition);
  if (edge.b >= 0) {
    int other = -1;
    const double there = surface.violation(edge.b, x, &other);
    if (there > beyond) {
      beyond = there;
      condition = other;
    }
  }
  if (beyond > slack) return false;
  const std::optional<Star> star = surface.star(x, slack);
  if (!star) return false;
  const auto same = [&](int i) { return i >= 0 && surface.edge(i).a == edge.a && surface.edge(i).b == edge.b; };
  return std::any_of(star->wedges.begin(), star->wedges.end(),
                     [&](const Wedge& wedge) { return same(wedge.first_edge) || same(wedge.second_edge); });
}

}  // namespace

EdgeWalk walk_along(FacetedSurface& surface, int edge, const Point3& from, double step) {
  EdgeWalk walk;
  walk.x = from;
  if (!surface.move(edge, step, walk.x)) return walk;
  walk.possible = true;
  int condition = -1;
  if (is_on_edge(surface, edge, walk.x, condition)) return walk;
  double good = 0;
  double bad = 1;
  walk.x = from;
  constexpr int kBisections = 40;
  for (int k = 0; k < kBisections; ++k) {
    const double u = (good + bad) / 2;
    Point3 x = from;
    int failed = -1;
    if (surface.move(edge, u * step, x) && is_on_edge(surface, edge, x, failed)) {
      good = u;
      walk.x = x;
    } else {
      bad = u;
      condition = failed;
    }
  }
  walk.end = step > 0 ? 1 : -1;
  walk.condition = condition;
  return walk;
}

}  // namespace taut::detail
