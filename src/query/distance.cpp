#include "taut/query/distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/check_tolerance.hpp"
#include "core/parallel.hpp"
#include "curve/polished.hpp"
#include "fan/fan_answers.hpp"
#include "fan/geodesic_fan.hpp"
#include "query/curve_foot.hpp"
#include "search/cell_levels.hpp"
#include "strata/faceted_surface.hpp"
#include "surface/describe.hpp"
#include "surface/point_text.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/projection.hpp"

namespace taut {

using detail::FanCurve;
using detail::FanHit;
using detail::FanOptions;
using detail::GeodesicFan;

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A target farther off the surface than so many cells is a mistake.
constexpr double kMostCellsOff = 10;

void check(const DistanceOptions& options) {
  using detail::describe;
  detail::check_tolerance(options.tolerance);
  if (!(options.max_distance > 0)) {
    throw InvalidArgument("max_distance is " + describe(options.max_distance) + ", must be > 0");
  }
  if (options.max_patches < 1) throw InvalidArgument("max_patches must be at least 1");
}

}  // namespace

struct DistanceSolver::Impl {
  Surface surface;
  DistanceOptions options;
  Context context;
  Vector values;
  detail::CellLevels levels;
  Points sources;
  std::vector<FanCurve> curves;  // empty: the sources are points
  std::optional<GeodesicFan> fan;
  std::optional<PathSolver> paths;
  bool kinked;

  Impl(Surface s, const DistanceOptions& o, Context c)
      : surface(std::move(s)),
        options(o),
        context(std::move(c)),
        levels(surface, {o.grid, o.cell, o.seeds}, context),
        kinked(detail::is_kinked(surface)) {}

  /// A fan follows rays on surfaces in R^3. Over edges it does not.
  [[nodiscard]] bool has_fan() const { return surface.dim() == 3 && surface.codim() == 1 && !kinked; }

  void make_fan() {
    if (!has_fan() || fan) return;
    (void)levels.cells(0, sources);  // finds the size that follows the surface's bends
    const FanOptions wanted{.tolerance = options.tolerance,
                            .max_panel = detail::kPanelCells * levels.size(0),
                            .max_patches = options.max_patches,
                            .max_evaluated = detail::most_evaluated(surface)};
    if (curves.empty()) {
      fan.emplace(surface, sources, values, wanted);
    } else {
      fan.emplace(surface, curves, wanted);
    }
  }

  /// The targets on the surface; what is wrong with one goes to its status and message.
  [[nodiscard]] Points settle(const PointsIn& targets, Distances& result) const {
    Points x = targets;
    const std::unique_ptr<Evaluator> evaluator = surface.make_evaluator();
    const auto found = project_to_surface(*evaluator, surface.dim(), surface.codim(), x,
                                          {.max_distance = kMostCellsOff * levels.size(0)});
    for (Index j = 0; j < x.cols(); ++j) {
      if (found(j)) continue;
      result.status[static_cast<std::size_t>(j)] = Status::not_converged;
      result.message[j] = targets.col(j).allFinite()
                              ? fmt::format("point {}: no point of the surface was found near it; give one closer",
                                            detail::text_of(targets.col(j)))
                              : fmt::format("point {}: coordinates must be finite", detail::text_of(targets.col(j)));
    }
    return x;
  }

  /// Distances on the fan for the columns `open`; those that are proved leave the list.
  void ask_fan(const Points& x, std::vector<Index>& open, Distances& result) {
    std::vector<std::uint8_t> is_open(static_cast<std::size_t>(x.cols()), 0);
    const auto take_answer = [&](Index j, const detail::FanAnswer& answer) {
      const std::size_t slot = static_cast<std::size_t>(j);
      const bool beyond = answer.kind == detail::FanAnswer::Kind::beyond;
      is_open[slot] = answer.kind == detail::FanAnswer::Kind::open ? 1 : 0;
      if (beyond) {
        forget(j, result);
      } else if (std::isfinite(answer.hit.distance)) {
        take(j, answer.hit, result);
      }
      if (is_open[slot] != 0) return;
      result.status[slot] = Status::ok;
      result.proof[slot] = beyond ? DistanceProof::none : DistanceProof::fan;
    };
    detail::ask_fan(*fan, surface, sources, values, x, open, options.max_distance, context, take_answer);
    std::erase_if(open, [&](Index j) { return is_open[static_cast<std::size_t>(j)] == 0; });
  }

  static void take(Index j, const FanHit& hit, Distances& result) {
    result.distance(j) = hit.distance;
    result.error(j) = hit.error;
    result.source[static_cast<std::size_t>(j)] = static_cast<std::int32_t>(hit.source);
    result.foot.col(j) = hit.foot;
    result.departure.col(j) = hit.departure;
    result.arrival.col(j) = hit.arrival;
  }

  static void forget(Index j, Distances& result) {
    result.distance(j) = result.error(j) = kInfinity;
    result.source[static_cast<std::size_t>(j)] = -1;
    result.foot.col(j).setConstant(kNaN);
    result.departure.col(j).setConstant(kNaN);
    result.arrival.col(j).setConstant(kNaN);
  }

  /// A target lies on a component of the complete cells on which no source lies: a proof that no path leads there.
  void drop_disconnected(const Points& x, std::vector<Index>& open, Distances& result) {
    if (!fan || std::isfinite(fan->reach())) return;
    const std::shared_ptr<SurfaceCells> cells = levels.cells(0, sources);
    const std::shared_ptr<const std::vector<std::int32_t>> label = levels.components(0);
    const auto component = [&](const VectorIn& p) {
      const Index cell = cells->grid().find_point(p);
      return cell == CellGrid::kNone ? -1 : (*label)[static_cast<std::size_t>(cell)];
    };
    std::vector<std::int32_t> reached;
    for (Index s = 0; s < sources.cols(); ++s) reached.push_back(component(sources.col(s)));
    if (std::ranges::count(reached, -1) > 0) return;
    std::erase_if(open, [&](Index j) {
      const std::int32_t own = component(x.col(j));
      if (own < 0 || std::ranges::count(reached, own) > 0) return false;
      result.status[static_cast<std::size_t>(j)] = Status::disconnected;
      result.message[j] =
          fmt::format("point {}: lies on another component of the surface than the sources", detail::text_of(x.col(j)));
      return true;
    });
  }

  /// A corrected path to each of the columns `open` from each source; the best of them and of what the fan has.
  void ask_paths(const Points& x, const std::vector<Index>& open, Distances& result) {
    if (!options.paths) {
      for (const Index j : open) {
        forget(j, result);
        result.status[static_cast<std::size_t>(j)] = Status::not_converged;
        result.message[j] =
            fmt::format("point {}: lies beyond where all geodesics could be followed", detail::text_of(x.col(j)));
      }
      return;
    }
    if (open.empty()) return;
    need_paths();
    if (!curves.empty()) return ask_feet(x, open, result);
    Points targets(x.rows(), static_cast<Index>(open.size()));
    for (Index i = 0; i < targets.cols(); ++i) targets.col(i) = x.col(open[static_cast<std::size_t>(i)]);
    std::vector<Way> ways(open.size());  // the shortest path so far
    for (Index s = 0; s < sources.cols(); ++s) {
      std::vector<PathResult> found;
      if (surface.kind() == "formula" && surface.domain() != nullptr) {
        // One by one, paths follow the border where that is the way; over one marched field they do not.
        for (Index i = 0; i < targets.cols(); ++i) found.push_back(paths->solve(sources.col(s), targets.col(i)));
      } else {
        found = paths->solve_from(sources.col(s), targets);
      }
      for (std::size_t i = 0; i < open.size(); ++i) {
        if (take(open[i], s, found[i], result)) {
          ways[i] = {std::move(found[i].points), found[i].start_direction, found[i].pieces.size() > 1};
        }
      }
    }
    find_directions(open, ways, result);
    for (const Index j : open) {
      const std::size_t i = static_cast<std::size_t>(j);
      if (!std::isfinite(result.distance(j))) continue;
      result.message.erase(j);
      result.proof[i] = DistanceProof::path;
      result.status[i] = Status::ok;
      if (result.distance(j) > options.max_distance) {
        forget(j, result);
        result.proof[i] = DistanceProof::none;
      }
    }
  }

  /// The foot on the curves, by single paths, for each of the columns `open`.
  void ask_feet(const Points& x, const std::vector<Index>& open, Distances& result) {
    std::vector<std::vector<SpectralCurve>> arcs;
    for (const FanCurve& curve : curves) arcs.push_back(curve.arcs);
    std::vector<Way> ways(open.size());
    for (std::size_t i = 0; i < open.size(); ++i) {
      const Index j = open[i];
      const auto slot = static_cast<std::size_t>(j);
      context.check_cancelled();
      detail::CurveFoot foot = detail::nearest_on_curves(*paths, arcs, x.col(j), options.tolerance);
      result.status[slot] = foot.status;
      if (foot.status != Status::ok) {
        forget(j, result);
        result.message[j] = std::move(foot.message);
        continue;
      }
      if (result.distance(j) <= foot.distance) {  // the fan's
        foot.distance = result.distance(j);
        foot.error = result.error(j);
      } else {
        result.source[slot] = foot.curve;
        result.foot.col(j) = foot.foot;
        ways[i] = {foot.path.points.rowwise().reverse(), -foot.path.end_direction, foot.path.pieces.size() > 1};
      }
      result.distance(j) = foot.distance;
      result.error(j) = foot.error;
      result.message.erase(j);
      result.proof[slot] = DistanceProof::path;
      if (foot.distance > options.max_distance) {
        forget(j, result);
        result.proof[slot] = DistanceProof::none;
      }
    }
    find_directions(open, ways, result);
  }

  void need_paths() {
    if (paths) return;
    paths.emplace(surface,
                  PathOptions{.march = options.march,
                              .grid = options.grid,
                              .cell = options.cell,
                              .seeds = options.seeds,
                              .tolerance = options.tolerance},
                  context);
  }

  /// The shortest paths from each point of a polyline to the next, on the surface.
  [[nodiscard]] FanCurve make_curve(const PointsIn& polyline) {
    FanCurve curve;
    need_paths();
    paths->expect(polyline, polyline.cols() - 1);
    for (Index i = 0; i + 1 < polyline.cols(); ++i) {
      const PathResult path = paths->solve(polyline.col(i), polyline.col(i + 1));
      if (path.status != Status::ok) {
        throw InvalidArgument(fmt::format("no path from point {} of the curve to the next: {}", i, path.message));
      }
      if (path.pieces.size() > 1) {
        throw InvalidArgument(fmt::format("the curve goes over an edge between its points {} and {}", i, i + 1));
      }
      if (!(path.length > 0)) continue;
      const NewtonResult fine = detail::polished(surface, path.points, context);
      curve.arcs.push_back(fine.curve);
    }
    if (curve.arcs.empty()) throw InvalidArgument("a curve to measure from takes two distinct points");
    return curve;
  }

  /// True where the path is the shortest so far.
  [[nodiscard]] bool take(Index j, Index source, const PathResult& path, Distances& result) const {
    const std::size_t i = static_cast<std::size_t>(j);
    const double length = values(source) + path.length;
    if (path.status != Status::ok) {
      if (!std::isfinite(result.distance(j))) {
        result.status[i] = path.status;
        result.message[j] = path.message;
      }
      return false;
    }
    if (!(length < result.distance(j))) return false;
    result.distance(j) = length;
    result.error(j) = path.length_error;
    result.source[i] = static_cast<std::int32_t>(source);
    result.foot.col(j) = sources.col(source);
    return true;
  }

  struct Way {
    Points points;
    Vector start;  // direction
    bool over_edges = false;
  };

  /// A path that is good for its length is not for its directions: those come from a curve that is as exact as
  /// rounding allows.
  void find_directions(const std::vector<Index>& open, const std::vector<Way>& ways, Distances& result) const {
    constexpr Index kGrain = 8;
    detail::parallel_for(context, 0, static_cast<Index>(open.size()), kGrain, [&](Index begin, Index end) {
      Context own = context;
      own.threads = 1;
      for (Index k = begin; k < end; ++k) {
        const std::size_t i = static_cast<std::size_t>(k);
        const Points& points = ways[i].points;
        const Index last = points.cols() - 1;
        if (last < 1) continue;
        const Index j = open[i];
        result.departure.col(j).setConstant(kNaN);
        result.arrival.col(j).setConstant(kNaN);
        if ((points.colwise() - points.col(0)).cwiseAbs().maxCoeff() == 0) continue;
        if (ways[i].over_edges) {
          if (ways[i].start.size() == surface.dim()) result.departure.col(j) = ways[i].start;
          result.arrival.col(j) = (points.col(last) - points.col(last - 1)).normalized();
          continue;
        }
        const NewtonResult fine = detail::polished(surface, points, own);
        if (fine.curve.num_elements() == 0) continue;
        const detail::EndDirections ends = detail::end_directions(surface, fine, own);
        result.departure.col(j) = ends.departure;
        result.arrival.col(j) = ends.arrival;
      }
    });
  }
};

DistanceSolver::DistanceSolver(Surface surface, const PointsIn& sources, const Vector& values,
                               const DistanceOptions& options, Context context) {
  check(options);
  impl_ = std::make_unique<Impl>(std::move(surface), options, std::move(context));
  set_sources(sources, values);
}

void DistanceSolver::set_sources(const PointsIn& sources, const Vector& values) {
  Impl& impl = *impl_;
  if (sources.cols() == 0) throw InvalidArgument("distances need at least one source");
  if (values.size() != 0 && values.size() != sources.cols()) {
    throw InvalidArgument(fmt::format("{} sources have {} values: give one each", sources.cols(), values.size()));
  }
  if (!values.allFinite()) throw InvalidArgument("the values of sources must be finite");
  for (Index j = 0; j < sources.cols(); ++j) detail::check_point(impl.surface, sources.col(j), "source");
  impl.levels.prepare(sources);
  Points on_surface(sources.rows(), sources.cols());
  for (Index j = 0; j < sources.cols(); ++j) on_surface.col(j) = impl.levels.on_surface(sources.col(j), "source");
  impl.fan.reset();
  impl.curves.clear();
  impl.values = values.size() > 0 ? values : Vector(Vector::Zero(sources.cols()));
  impl.sources = std::move(on_surface);
}

void DistanceSolver::set_curves(const std::vector<Points>& polylines) {
  Impl& impl = *impl_;
  if (polylines.empty()) throw InvalidArgument("distances need at least one curve");
  std::vector<FanCurve> curves;
  Index count = 0;
  for (const Points& polyline : polylines) {
    if (polyline.rows() != impl.surface.dim() || polyline.cols() < 2) {
      throw InvalidArgument(fmt::format("a curve ({} x {}) to measure from: must be {} x n, n >= 2", polyline.rows(),
                                        polyline.cols(), impl.surface.dim()));
    }
    curves.push_back(impl.make_curve(polyline));
    count += static_cast<Index>(curves.back().arcs.size()) + 1;
  }
  Points joints(impl.surface.dim(), count);
  Index next = 0;
  for (const FanCurve& curve : curves) {
    for (const SpectralCurve& arc : curve.arcs) joints.col(next++) = arc.point(0);
    joints.col(next++) = curve.arcs.back().point(curve.arcs.back().period());
  }
  impl.levels.prepare(joints);
  impl.fan.reset();
  impl.curves = std::move(curves);
  impl.values = Vector::Zero(count);
  impl.sources = std::move(joints);
}

DistanceSolver::~DistanceSolver() = default;
DistanceSolver::DistanceSolver(DistanceSolver&&) noexcept = default;
DistanceSolver& DistanceSolver::operator=(DistanceSolver&&) noexcept = default;

const Surface& DistanceSolver::surface() const { return impl_->surface; }
bool DistanceSolver::has_fan() const { return impl_->has_fan(); }
const Points& DistanceSolver::sources() const { return impl_->sources; }
Index DistanceSolver::num_patches() const { return impl_->fan ? impl_->fan->num_patches() : 0; }

Distances DistanceSolver::at(const PointsIn& targets) {
  Impl& impl = *impl_;
  const Index n = targets.cols();
  const Index d = impl.surface.dim();
  if (n > 0 && targets.rows() != d) {
    throw InvalidArgument(
        fmt::format("the targets have {} coordinates, the surface lies in {} dimensions", targets.rows(), d));
  }
  const std::size_t count = static_cast<std::size_t>(n);
  Distances result{.distance = Vector::Constant(n, kInfinity),
                   .error = Vector::Constant(n, kInfinity),
                   .status = std::vector<Status>(count, Status::ok),
                   .proof = std::vector<DistanceProof>(count, DistanceProof::none),
                   .source = std::vector<std::int32_t>(count, -1),
                   .foot = Points::Constant(d, n, kNaN),
                   .departure = Points::Constant(d, n, kNaN),
                   .arrival = Points::Constant(d, n, kNaN),
                   .message = {}};
  if (n == 0) return result;
  const Points x = impl.settle(targets, result);
  std::vector<Index> open;
  for (Index j = 0; j < n; ++j) {
    if (!result.message.contains(j)) open.push_back(j);
  }
  impl.make_fan();
  if (impl.fan) impl.ask_fan(x, open, result);
  impl.drop_disconnected(x, open, result);
  impl.ask_paths(x, open, result);
  return result;
}

}  // namespace taut
