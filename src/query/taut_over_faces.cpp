// Polylines and loops on a surface with edges. The row of faces under the polyline makes a chain of arcs, which is
// shortened as a path's is; so it stays near the polyline, but where it slides over a corner to other faces.
#include "query/taut_over_faces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "search/chain_result.hpp"
#include "search/explain.hpp"
#include "strata/chain_tolerances.hpp"
#include "strata/closed_chain.hpp"
#include "strata/polyline_way.hpp"
#include "strata/shorten_chain.hpp"
#include "strata/way_chain.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// A loop is next to a closed geodesic where their lengths differ by no more than this part.
constexpr double kNextTo = 0.02;

/// The shortest of a chain and those that pass its corners on their other sides; not solved where none is.
FacetChain shortened(FacetedSurface& surface, FacetChain chain, const Context& context) {
  std::optional<FacetChain> best;
  for (FacetChain& one : shorten_with_others(surface, std::move(chain), context)) {
    const bool better = !best || (one.solved && (!best->solved || one.length < best->length));
    if (better) best = std::move(one);
  }
  return *std::move(best);
}

void tell(OverFaces& over, const FacetChain& chain, PathResult& result) {
  result.grid_path.resize(3, static_cast<Index>(over.way.points.size()));
  for (std::size_t i = 0; i < over.way.points.size(); ++i) {
    result.grid_path.col(static_cast<Index>(i)) = over.way.points[i];
  }
  result.doubts = {Doubt::rivals_not_sought};
  if (chain.solved) {
    add_chain(*over.surface, chain, result);
    result.candidates.push_back({result.length, result.length_error, result.locally_shortest, result.points});
  } else {
    add_trouble(chain.trouble, over.way.length, result);
    result.length = over.way.length;
    result.length_error = std::numeric_limits<double>::infinity();
    result.points = result.grid_path;
    result.message = explain(result);
  }
}

}  // namespace

bool OverFaces::stays(const Points& curve) {
  const std::vector<Index> suspects = surface->not_inside(only_face, curve);
  return std::all_of(suspects.begin(), suspects.end(), [&](Index j) {
    return surface->violation(only_face, curve.col(j)) <= ChainTolerances::off_face * surface->scale;
  });
}

std::optional<OverFaces> lay_over_faces(const Surface& surface, const PointsIn& polyline, bool closed) {
  if (!is_kinked(surface)) return std::nullopt;
  OverFaces over;
  over.surface = FacetedSurface::of(surface);
  if (over.surface == nullptr) return std::nullopt;
  over.surface->scale = (polyline.rowwise().maxCoeff() - polyline.rowwise().minCoeff()).norm();
  Points points = polyline;
  if (closed && points.col(0) != points.col(points.cols() - 1)) {
    points.conservativeResize(3, points.cols() + 1);
    points.rightCols(1) = points.col(0);
  }
  std::optional<FacetWay> way = way_along_polyline(*over.surface, points);
  if (!way || way->faces.empty()) {
    throw InvalidArgument("the polyline cannot be laid over the faces of this surface: give it more points, on them");
  }
  over.way = *std::move(way);
  const int face = over.way.faces.front().front();
  const bool one = std::all_of(over.way.faces.begin(), over.way.faces.end(),
                               [&](const std::vector<int>& faces) { return faces.front() == face; });
  if (one) over.only_face = face;
  return over;
}

void pull_taut(OverFaces& over, PathResult& result, const Context& context) {
  result.from = over.way.points.front();
  result.to = over.way.points.back();
  tell(over, shortened(*over.surface, chain_of(*over.surface, over.way), context), result);
}

void pull_loop_taut(OverFaces& over, PathResult& result, int& neutral, const Context& context) {
  result.from = result.to = over.way.points.front();
  const std::optional<FacetChain> start = closed_chain_of(*over.surface, over.way);
  if (!start) {
    result.obstacle = {Obstacle::Kind::faces, over.way.points.front()};
    result.reason = in_words(ChainFault::no_edge);
    result.message = explain(result);
    return;
  }
  // Near a closed geodesic already: that one is meant, even where shortening would slide off it.
  FacetChain chain = *start;
  chain.stationary = true;
  std::vector<FacetChain> others;
  shorten_chain(*over.surface, chain, others, context);
  if (!chain.solved || std::abs(chain.length - over.way.length) > kNextTo * over.way.length) {
    chain = shortened(*over.surface, *start, context);
  }
  if (chain.solved) result.from = result.to = chain.stops.front().x;
  neutral = chain.neutral;
  tell(over, chain, result);
}

}  // namespace taut::detail
