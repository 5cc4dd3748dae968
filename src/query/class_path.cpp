// The shortest path among those that can be deformed into a given polyline on the surface. The polyline becomes a dense
// strand, which is shortened in steps too small to leave its class (homotopy/shortening). From time to time it is near
// enough to rest for the correction to be tried: its outcome counts only if it stays so close to the strand that no
// handle of the surface fits between them. Where Newton's method on the whole curve jumps, a polygon of short geodesic
// arcs is solved for instead (homotopy/geodesic_polygon). Where nothing stays close, the strand itself is the answer,
// its error unknown.
#include "taut/query/path.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <utility>

#include "core/stopwatch.hpp"
#include "homotopy/class_setting.hpp"
#include "homotopy/geodesic_polygon.hpp"
#include "homotopy/shortening.hpp"
#include "query/taut_over_faces.hpp"
#include "search/cell_levels.hpp"
#include "search/check_options.hpp"
#include "search/flow_options.hpp"
#include "taut/cells/cell_grid.hpp"
#include "taut/curve/newton.hpp"

namespace taut {
namespace {

using detail::Shortening;

/// The polyline itself, with nothing known about its error.
Geodesic uncorrected(const Shortening& shortening) {
  Geodesic geodesic;
  geodesic.points = shortening.strand().polyline();
  geodesic.length = shortening.strand().length();
  geodesic.length_error = std::numeric_limits<double>::infinity();
  geodesic.reason = "the corrected curve left the class of the polyline (smaller cells may help)";
  return geodesic;
}

/// On one face as on any smooth surface, as long as it stays there.
PathResult over_faces(detail::OverFaces& over, const PointsIn& polyline, const PathOptions& options,
                      const Context& context) {
  const detail::Stopwatch watch;
  if (over.only_face >= 0) {
    PathResult result = path_in_class(over.surface->face(over.only_face).surface, polyline, options, context);
    if (result.status == Status::ok && over.stays(result.points)) return result;
  }
  if (options.method != CorrectionMethod::newton) {
    throw InvalidArgument("over edges a polyline is pulled taut by method newton only");
  }
  PathResult result;
  detail::pull_taut(over, result, context);
  result.seconds.correct = watch.seconds();
  return result;
}

}  // namespace

PathResult path_in_class(const Surface& surface, const PointsIn& polyline, const PathOptions& options,
                         const Context& context) {
  detail::check_options(options);
  detail::check_polyline(surface, polyline, false);
  if (options.method == CorrectionMethod::grid) {
    throw InvalidArgument("method grid: a polyline is shortened by newton or flow");
  }
  detail::Stopwatch watch;
  if (std::optional<detail::OverFaces> over = detail::lay_over_faces(surface, polyline, false)) {
    return over_faces(*over, polyline, options, context);
  }
  const detail::StrandMaker maker(surface);
  const double cell = detail::first_cell_size(surface, {options.grid, options.cell, {}}, polyline, context);
  detail::ClassSetting setting = detail::class_setting(surface, maker, polyline, false, cell);
  PathResult result;
  result.from = setting.strand.points.col(0);
  result.to = setting.strand.points.rightCols(1);
  result.cell = setting.cell;
  result.seconds.cells = watch.restart();
  Shortening shortening(maker, std::move(setting.strand), setting.gap);
  detail::GeodesicPolygon polygon(surface, maker, options.tolerance, setting.gap);
  std::optional<NewtonSolver> newton;
  const auto correct = [&](const Points& start) -> Geodesic {
    if (options.method == CorrectionMethod::flow) {
      FlowLattice lattice{setting.cell, lattice_origin(result.from, setting.cell)};
      FlowResult flowed = correct_flow(surface, start, detail::flow_options(options, std::move(lattice)), context);
      result.flow = flowed.summary;
      return std::move(static_cast<Geodesic&>(flowed));
    }
    if (!newton) newton.emplace(surface, NewtonOptions{.tolerance = options.tolerance});
    return newton->solve(start, context);
  };
  bool followed = false;
  bool is_point = false;
  Geodesic geodesic;
  int round = 0;
  for (const double settled : detail::kSettled) {
    const Shortening::Outcome outcome = shortening.run(settled * setting.gap, context);
    is_point = outcome == Shortening::Outcome::a_point;
    result.grid_path = shortening.strand().polyline();
    result.num_iterations = shortening.num_steps();
    if (is_point) break;
    geodesic = correct(result.grid_path);
    // Near the strand all along: no handle of the surface lies between them.
    followed = shortening.is_followed_by(geodesic.points);
    if (!followed) {
      // Too far for one jump: Newton's method on a polygon of arcs, in steps that keep the class.
      const bool smooth = polygon.solve(shortening.strand(), context) == detail::GeodesicPolygon::Outcome::smooth;
      // A polygon that is no minimum would be left by shortening, too.
      if (smooth && polygon.index() == 0) {
        result.grid_path = polygon.points();
        geodesic = correct(result.grid_path);
        followed = maker.is_near(result.grid_path, geodesic.points, 2 * setting.gap);
        if (!followed && options.method == CorrectionMethod::newton) {
          // A direction in which the length hardly changes: the polygon is as good as it gets, and knows its error.
          geodesic = polygon.geodesic(options.tolerance);
          geodesic.locally_shortest = polygon.neutral() == 0;
          followed = true;
        }
      }
    }
    // Ends that are one point: the loop may yet shrink to it, and then the short geodesic is no answer.
    const bool comes_undone = shortening.returns() && geodesic.length < setting.gap;
    if (followed && !comes_undone) break;
    // Slid off a saddle perhaps: then so shall the strand.
    if (options.method == CorrectionMethod::newton && ++round > 1) shortening.disturb(round);
  }
  if (is_point) {
    geodesic = {};
    geodesic.status = Status::ok;
    geodesic.locally_shortest = true;
    geodesic.index = 0;
    geodesic.points.resize(surface.dim(), 2);
    geodesic.points << result.from, result.to;
    geodesic.length = (result.to - result.from).norm();
  } else if (!followed) {
    geodesic = uncorrected(shortening);
  }
  // The flow's summary belongs to a curve that is not the answer.
  if (is_point || !followed) result.flow.reset();
  geodesic.num_iterations += result.num_iterations;
  static_cast<Geodesic&>(result) = std::move(geodesic);
  result.message =
      is_point ? "the polyline comes undone: its ends are one point, and so is the path" : std::string(result.reason);
  result.doubts = {Doubt::rivals_not_sought};
  if (result.status == Status::ok) {
    result.candidates.push_back({result.length, result.length_error, result.locally_shortest, result.points});
  }
  result.seconds.correct = watch.seconds();
  return result;
}

}  // namespace taut
