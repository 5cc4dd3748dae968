// A closed geodesic in the class of a loop: the loop is shortened as a strand without ends (homotopy/shortening), and
// from time to time a polygon of geodesic arcs with free corners is solved for from it (homotopy/geodesic_polygon),
// whose second derivatives tell minima from saddles. A loop that can shrink does, to a point. What is no minimum is
// taken only if it lies where the loop is: a class may hold several, and the one the loop comes to is meant.
#include "taut/query/closed_geodesic.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/stopwatch.hpp"
#include "homotopy/class_setting.hpp"
#include "homotopy/geodesic_polygon.hpp"
#include "homotopy/shortening.hpp"
#include "query/taut_over_faces.hpp"
#include "search/cell_levels.hpp"
#include "search/check_options.hpp"
#include "search/explain.hpp"

namespace taut {
namespace {

using detail::GeodesicPolygon;
using detail::Shortening;

ClosedGeodesic point_loop(const Vector& x) {
  ClosedGeodesic result;
  result.status = Status::ok;
  result.is_point = true;
  result.message = "the loop shrinks to a point";
  result.locally_shortest = true;
  result.index = 0;
  result.points = x.replicate(1, 2);
  return result;
}

ClosedGeodesic closed(const GeodesicPolygon& polygon, double tolerance) {
  ClosedGeodesic result;
  static_cast<Geodesic&>(result) = polygon.geodesic(tolerance);
  result.kink = polygon.kink();
  result.neutral = polygon.neutral();
  return result;
}

ClosedGeodesic unfinished(const Shortening& shortening, Status status, std::string message) {
  ClosedGeodesic result;
  result.status = status;
  result.points = shortening.strand().polyline();
  result.length = shortening.strand().length();
  result.length_error = std::numeric_limits<double>::infinity();
  result.message = std::move(message);
  return result;
}

/// On one face as on any smooth surface, as long as it stays there.
ClosedGeodesic loop_over_faces(detail::OverFaces& over, const PointsIn& polyline, const PathOptions& options,
                               const Context& context) {
  const detail::Stopwatch watch;
  ClosedGeodesic result;
  if (over.only_face >= 0) {
    result = closed_geodesic(over.surface->face(over.only_face).surface, polyline, options, context);
    if (result.status == Status::ok && over.stays(result.points)) return result;
    result = {};
  }
  detail::pull_loop_taut(over, result, result.neutral, context);
  result.seconds.correct = watch.seconds();
  return result;
}

}  // namespace

ClosedGeodesic closed_geodesic(const Surface& surface, const PointsIn& polyline, const PathOptions& options,
                               const Context& context) {
  detail::check_options(options);
  if (options.method != CorrectionMethod::newton) {
    throw InvalidArgument("closed geodesics are found by method newton only");
  }
  detail::check_polyline(surface, polyline, true);
  detail::Stopwatch watch;
  if (std::optional<detail::OverFaces> over = detail::lay_over_faces(surface, polyline, true)) {
    return loop_over_faces(*over, polyline, options, context);
  }
  const detail::StrandMaker maker(surface);
  const double cell = detail::first_cell_size(surface, {options.grid, options.cell, {}}, polyline, context);
  detail::ClassSetting setting = detail::class_setting(surface, maker, polyline, true, cell);
  const double cells_seconds = watch.restart();
  Shortening shortening(maker, std::move(setting.strand), setting.gap);
  GeodesicPolygon polygon(surface, maker, options.tolerance, setting.gap);
  std::optional<ClosedGeodesic> found;
  std::string problem;
  Status status = Status::not_converged;
  const auto close = [&] {
    const GeodesicPolygon::Outcome outcome = polygon.solve(shortening.strand(), context);
    if (outcome == GeodesicPolygon::Outcome::smooth) {
      // Newton's method does not care whether it finds a minimum: one that is none must be where the loop is.
      const bool minimum = polygon.index() == 0 && shortening.num_steps() > 0;
      if (minimum || shortening.is_followed_by(polygon.points())) found = closed(polygon, options.tolerance);
      problem = "the loop has not come to rest on a closed geodesic";
      return;
    }
    if (outcome == GeodesicPolygon::Outcome::too_many_unknowns) {
      problem = "the loop bends too often, in too many dimensions, for its joints to be solved for";
      return;
    }
    // Why: the first arc that failed says it best.
    const NewtonResult* bad = polygon.bad_arc();
    if (bad != nullptr) status = bad->status;
    problem = bad != nullptr ? std::string(bad->reason) : "the arcs of the loop do not come to rest";
  };
  // Near a closed geodesic already: then that one is meant, even where shortening would slide off it.
  if (shortening.strand().num_points() > 2) close();
  for (const double settled : detail::kSettled) {
    if (found && found->status == Status::ok) break;
    const Shortening::Outcome outcome = shortening.run(settled * setting.gap, context);
    if (outcome == Shortening::Outcome::a_point) {
      found = point_loop(shortening.strand().points.col(0));
      break;
    }
    status = Status::not_converged;
    close();
  }
  ClosedGeodesic result = found ? *std::move(found) : unfinished(shortening, status, problem);
  if (result.status != Status::ok) result.obstacle = {Obstacle::Kind::no_geodesic};
  // Shorter than a segment, yet no point: round a spike or through a singular point.
  if (!found && shortening.strand().length() < setting.gap) {
    result.obstacle = {Obstacle::Kind::contracts};
    result.message = detail::explain(result);
  }
  if (result.message.empty()) result.message = std::string(result.reason);
  result.from = result.points.col(0);
  result.to = result.from;
  result.grid_path = shortening.strand().polyline();
  result.num_iterations = shortening.num_steps();
  result.cell = setting.cell;
  result.seconds.cells = cells_seconds;
  result.seconds.correct = watch.seconds();
  result.doubts = {Doubt::rivals_not_sought};
  if (result.status == Status::ok) {
    result.candidates.push_back({result.length, result.length_error, result.locally_shortest, result.points});
  }
  return result;
}

}  // namespace taut
