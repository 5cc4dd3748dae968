// Paths on a surface whose border is rough, such as that of a scan. Ways over a graph of all edges (facet_search) would
// want cells smaller than everything on the border; this follows one way that stays inside.
#include "search/border_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/stopwatch.hpp"
#include "search/candidates.hpp"
#include "search/way_inside.hpp"
#include "strata/border_band.hpp"
#include "taut/curve/newton.hpp"

namespace taut::detail {
namespace {

/// A path may lie so far outside, in cells: what lies between looks is taken for closed.
constexpr double kOutside = 0.03;

/// Runs of points that touch the border, and the rest.
void add_pieces(const BorderBand& band, PathResult& result) {
  const Points& x = band.points;
  const auto touches = [&](Index i) { return band.touching[static_cast<std::size_t>(i)] >= 0; };
  for (Index i = 0; i + 1 < x.cols(); ++i) {
    const auto kind = touches(i) && touches(i + 1) ? PathPiece::Kind::border : PathPiece::Kind::face;
    if (result.pieces.empty() || result.pieces.back().kind != kind) {
      PathPiece piece;
      piece.kind = kind;
      piece.point = x.col(i);
      result.pieces.push_back(std::move(piece));
    }
    result.pieces.back().length += (x.col(i + 1) - x.col(i)).norm();
  }
}

}  // namespace

BorderAnswer search_along_border(const Surface& surface, const PathOptions& options, const SurfaceCells& cells,
                                 const Vector& p, const Vector& q, const Context& context) {
  BorderAnswer answer;
  PathResult& result = answer.result;
  result.from = p;
  result.to = q;
  result.cell = cells.grid().size();
  result.num_cells = cells.num_cells();
  Stopwatch watch;
  std::optional<StartPath> way = way_inside(surface, cells, p, q, context);
  result.seconds.march = watch.restart();
  if (!way) return answer;
  answer.kind = BorderAnswer::Kind::coarse;
  result.marched = way->length;
  BorderBand band = pull_taut(surface, way->points, result.cell, context);
  result.seconds.correct = watch.restart();
  if (band.points.cols() < 2 || band.outside > kOutside * result.cell) return answer;
  const bool touches = std::ranges::any_of(band.touching, [](int component) { return component >= 0; });
  if (!touches) {
    NewtonSolver newton(surface, {.tolerance = options.tolerance});
    Geodesic geodesic = newton.solve(band.points, context);
    const bool same = std::abs(geodesic.length - band.length) <= 1e-2 * band.length;
    if (geodesic.status == Status::ok && same) static_cast<Geodesic&>(result) = std::move(geodesic);
  }
  if (result.status != Status::ok) {
    result.status = Status::ok;
    result.length = band.length;
    result.length_error = std::max(band.error, options.tolerance * band.length);
    result.points = band.points;
    const Index n = result.points.cols();
    result.start_direction = (band.points.col(1) - band.points.col(0)).normalized();
    result.end_direction = (band.points.col(n - 1) - band.points.col(n - 2)).normalized();
    add_pieces(band, result);
    if (!band.settled) result.doubts.add(Doubt::start_failed);
  }
  result.grid_path = std::move(way->points);
  result.doubts.add(Doubt::rivals_not_sought);
  add_candidate(result.candidates, candidate_of(result));
  result.seconds.correct += watch.restart();
  answer.kind = BorderAnswer::Kind::path;
  return answer;
}

}  // namespace taut::detail
