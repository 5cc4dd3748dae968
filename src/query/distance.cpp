#include "taut/query/distance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "query/cell_levels.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"
#include "taut/fan/geodesic_fan.hpp"
#include "taut/surface/projection.hpp"

namespace taut {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Longest and widest panel of a fan, in cells: its nodes are then closer than the cells that are known to follow the
/// surface.
constexpr double kPanelCells = 8;
/// The fan is grown beyond the straight distance to the farthest target by this, and again while any is not reached.
constexpr double kBeyondStraight = 1.1;
constexpr double kGrowth = 1.4;
/// A target farther off the surface than so many cells is a mistake.
constexpr double kMostCellsOff = 10;

void check(const DistanceOptions& options) {
  using detail::describe;
  if (!(options.tolerance >= 1e-13 && options.tolerance <= 1e-3)) {
    throw InvalidArgument("tolerance is " + describe(options.tolerance) + ", must be in 1e-13 .. 1e-3");
  }
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
  std::optional<GeodesicFan> fan;
  std::optional<PathSolver> paths;

  Impl(Surface s, const DistanceOptions& o, Context c)
      : surface(std::move(s)), options(o), context(std::move(c)), levels(surface, {o.grid, o.cell, o.seeds}, context) {}

  /// A fan follows rays on surfaces in R^3 that have no border.
  [[nodiscard]] bool has_fan() const {
    return surface.dim() == 3 && surface.codim() == 1 && surface.domain() == nullptr;
  }

  void make_fan() {
    if (!has_fan() || fan) return;
    (void)levels.cells(0, sources);  // finds the size that follows the surface's bends
    fan.emplace(surface, sources, values,
                FanOptions{.tolerance = options.tolerance,
                           .max_panel = kPanelCells * levels.size(0),
                           .max_patches = options.max_patches});
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
    double straight = 0;
    for (const Index j : open) {
      double nearest = kInfinity;
      for (Index s = 0; s < sources.cols(); ++s) {
        nearest = std::min(nearest, values(s) + (x.col(j) - sources.col(s)).norm());
      }
      straight = std::max(straight, nearest);
    }
    double goal = kBeyondStraight * straight;
    while (!open.empty()) {
      fan->extend(std::min(goal, options.max_distance), context);
      goal = std::max(kGrowth * goal, straight);
      Points targets(3, static_cast<Index>(open.size()));
      for (Index i = 0; i < targets.cols(); ++i) targets.col(i) = x.col(open[static_cast<std::size_t>(i)]);
      const std::vector<FanHit> hits = fan->locate(targets, context);
      const double reach = fan->reach();
      std::vector<Index> left;
      for (std::size_t i = 0; i < hits.size(); ++i) {
        const Index j = open[i];
        const FanHit& hit = hits[i];
        if (std::isfinite(hit.distance)) take(j, hit, result);
        const bool known = std::isfinite(hit.distance) && hit.distance <= reach;
        // Without a limit, what no geodesic of a complete fan meets is left to drop_disconnected and ask_paths.
        const bool beyond =
            std::isfinite(options.max_distance) && std::min(hit.distance, reach) >= options.max_distance;
        if (known || beyond) {
          if (beyond) forget(j, result);
          result.status[static_cast<std::size_t>(j)] = Status::ok;
          result.proof[static_cast<std::size_t>(j)] = beyond ? DistanceProof::none : DistanceProof::fan;
        } else {
          left.push_back(j);
        }
      }
      open = std::move(left);
      if (fan->finished() || fan->broken_at() <= reach) break;
    }
  }

  static void take(Index j, const FanHit& hit, Distances& result) {
    result.distance(j) = hit.distance;
    result.error(j) = hit.error;
    result.source[static_cast<std::size_t>(j)] = static_cast<std::int32_t>(hit.source);
    result.departure.col(j) = hit.departure;
    result.arrival.col(j) = hit.arrival;
  }

  static void forget(Index j, Distances& result) {
    result.distance(j) = result.error(j) = kInfinity;
    result.source[static_cast<std::size_t>(j)] = -1;
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
    if (!paths) {
      paths.emplace(surface,
                    PathOptions{.march = options.march,
                                .grid = options.grid,
                                .cell = options.cell,
                                .seeds = options.seeds,
                                .tolerance = options.tolerance},
                    context);
    }
    Points targets(x.rows(), static_cast<Index>(open.size()));
    for (Index i = 0; i < targets.cols(); ++i) targets.col(i) = x.col(open[static_cast<std::size_t>(i)]);
    for (Index s = 0; s < sources.cols(); ++s) {
      const std::vector<PathResult> found = paths->solve_from(sources.col(s), targets);
      for (std::size_t i = 0; i < open.size(); ++i) take(open[i], s, found[i], result);
    }
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

  void take(Index j, Index source, const PathResult& path, Distances& result) const {
    const std::size_t i = static_cast<std::size_t>(j);
    const double length = values(source) + path.length;
    if (path.status != Status::ok) {
      if (!std::isfinite(result.distance(j))) {
        result.status[i] = path.status;
        result.message[j] = path.message;
      }
      return;
    }
    if (!(length < result.distance(j))) return;
    result.distance(j) = length;
    result.error(j) = path.length_error;
    result.source[i] = static_cast<std::int32_t>(source);
    const Index last = path.points.cols() - 1;
    const bool moved = last > 0 && path.length > 0;
    result.departure.col(j).setConstant(kNaN);
    result.arrival.col(j).setConstant(kNaN);
    if (path.start_direction.size() == x_dim()) result.departure.col(j) = path.start_direction;
    if (moved) result.arrival.col(j) = (path.points.col(last) - path.points.col(last - 1)).normalized();
  }

  [[nodiscard]] Index x_dim() const { return surface.dim(); }
};

DistanceSolver::DistanceSolver(Surface surface, const PointsIn& sources, const Vector& values,
                               const DistanceOptions& options, Context context) {
  check(options);
  if (sources.cols() == 0) throw InvalidArgument("distances need at least one source");
  if (values.size() != 0 && values.size() != sources.cols()) {
    throw InvalidArgument(fmt::format("{} sources have {} values: give one each", sources.cols(), values.size()));
  }
  if (!values.allFinite()) throw InvalidArgument("the values of sources must be finite");
  for (Index j = 0; j < sources.cols(); ++j) detail::check_point(surface, sources.col(j), "source");
  impl_ = std::make_unique<Impl>(std::move(surface), options, std::move(context));
  Impl& impl = *impl_;
  impl.values = values.size() > 0 ? values : Vector(Vector::Zero(sources.cols()));
  impl.levels.prepare(sources);
  impl.sources.resize(sources.rows(), sources.cols());
  for (Index j = 0; j < sources.cols(); ++j) impl.sources.col(j) = impl.levels.on_surface(sources.col(j), "source");
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
