#include "taut/query/path.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "query/cell_levels.hpp"
#include "query/walk_towards.hpp"
#include "taut/cells/components.hpp"
#include "taut/curve/flow.hpp"
#include "taut/curve/newton.hpp"
#include "taut/march/descend.hpp"
#include "taut/march/march.hpp"

namespace taut {
namespace {

/// A corrected path is never much longer than its start; one that is has jumped somewhere.
constexpr double kMostGrowth = 1.1;

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

void check_options(const PathOptions& options) {
  if (!(options.tolerance >= 1e-13) || !(options.tolerance <= 1e-3)) {
    throw InvalidArgument(fmt::format("tolerance {}: must be from 1e-13 to 1e-3", options.tolerance));
  }
  if (!(options.spacing >= 0) || !std::isfinite(options.spacing)) {
    throw InvalidArgument(fmt::format("node spacing {}: must be positive, or 0 to have it chosen", options.spacing));
  }
  if (!(options.beta > 0) || !std::isfinite(options.beta)) {
    throw InvalidArgument(fmt::format("beta {}: must be positive", options.beta));
  }
}

double polyline_length(const Points& x) {
  double length = 0;
  for (Index i = 1; i < x.cols(); ++i) length += (x.col(i) - x.col(i - 1)).norm();
  return length;
}

Points chord(const VectorIn& p, const VectorIn& q) {
  Points x(p.size(), 2);
  x << p, q;
  return x;
}

/// p and the columns of `targets` without a NaN or infinity.
Points with_finite_columns(const VectorIn& p, const PointsIn& targets) {
  Points all(p.size(), targets.cols() + 1);
  all.col(0) = p;
  Index count = 1;
  for (Index j = 0; j < targets.cols() && targets.rows() == p.size(); ++j) {
    if (targets.col(j).allFinite()) all.col(count++) = targets.col(j);
  }
  return all.leftCols(count);
}

}  // namespace

struct PathSolver::Impl {
  Surface surface;
  PathOptions options;
  Context context;
  detail::CellLevels levels;

  bool start_path(PathResult& result, int level);
  void correct(PathResult& result) const;
  bool apart(int level, const Vector& p, const Vector& q);
  PathResult between(const Vector& p, const Vector& q);
};

PathSolver::PathSolver(Surface surface, PathOptions options, Context context) {
  check_options(options);
  detail::CellLevels levels(surface, options.grid, options.cell, context);
  impl_.reset(new Impl{std::move(surface), options, std::move(context), std::move(levels)});
}
PathSolver::~PathSolver() = default;
PathSolver::PathSolver(PathSolver&&) noexcept = default;
PathSolver& PathSolver::operator=(PathSolver&&) noexcept = default;

const Surface& PathSolver::surface() const { return impl_->surface; }

/// Marches from result.from to result.to on the cells of one level. Returns false when no way was found.
bool PathSolver::Impl::start_path(PathResult& result, int level) {
  if (!levels.exist()) {
    const Stopwatch watch;
    result.grid_path = detail::walk_towards(surface, result.from, result.to);
    result.seconds.march += watch.seconds();
    return result.grid_path.cols() >= 2;
  }
  const Stopwatch cells_watch;
  SurfaceCells& cells = levels.cells(level, chord(result.from, result.to));
  result.seconds.cells += cells_watch.seconds();
  const Stopwatch watch;
  const DistanceField field =
      march(surface, cells, result.from, MarchOptions{.method = options.march, .target = result.to}, context);
  result.grid_path = descend(surface, cells, field, result.to);
  result.seconds.march += watch.seconds();
  result.cell = cells.grid().size();
  result.num_cells = cells.num_cells();
  return result.grid_path.cols() >= 2;
}

/// Replaces the Geodesic part of `result` by the corrected grid path.
void PathSolver::Impl::correct(PathResult& result) const {
  const Stopwatch watch;
  Geodesic& geodesic = result;
  switch (options.method) {
    case CorrectionMethod::newton:
      geodesic = correct_newton(surface, result.grid_path, NewtonOptions{.tolerance = options.tolerance}, context);
      break;
    case CorrectionMethod::flow:
      geodesic =
          correct_flow(surface, result.grid_path,
                       FlowOptions{.spacing = options.spacing, .cell = result.cell, .beta = options.beta}, context);
      break;
    case CorrectionMethod::grid:
      geodesic = Geodesic{};
      geodesic.points = result.grid_path;
      geodesic.length = polyline_length(result.grid_path);
      geodesic.length_error = std::numeric_limits<double>::infinity();  // nothing is known about it
      geodesic.status = Status::ok;
      break;
  }
  result.message = std::string(geodesic.reason);
  result.seconds.correct += watch.seconds();
  const double grid_length = polyline_length(result.grid_path);
  if (result.status == Status::ok && result.length > kMostGrowth * grid_length) {
    result.status = Status::not_converged;
    result.message = fmt::format("the corrected path is longer ({:.6g}) than the one on the cells ({:.6g})",
                                 result.length, grid_length);
  }
}

/// True when the cells of p and q lie in different components of all cells, which is a proof where the surface has
/// interval bounds.
bool PathSolver::Impl::apart(int level, const Vector& p, const Vector& q) {
  SurfaceCells& cells = levels.cells(level, chord(p, q));
  const Index i = cells.cell_at(p);
  const Index j = cells.cell_at(q);
  if (i == CellGrid::kNone || j == CellGrid::kNone) return false;
  const std::vector<std::int32_t> label = components(cells.grid()).label;
  return label[static_cast<std::size_t>(i)] != label[static_cast<std::size_t>(j)];
}

PathResult PathSolver::Impl::between(const Vector& p, const Vector& q) {
  PathResult result;
  result.from = p;
  result.to = q;
  if (p == q) {
    result.status = Status::ok;
    result.locally_shortest = true;
    result.points = chord(p, q);
    result.grid_path = result.points;
    result.cell = levels.size(0);
    return result;
  }
  // Cells that cannot tell sheets apart lead nowhere, or to a start from which the correction fails: try finer ones.
  // The first converged path is returned; failing that, the one that came nearest.
  std::optional<PathResult> best;
  for (int level = 0; level < levels.num_levels(); ++level) {
    bool reached = false;
    try {
      reached = start_path(result, level);
    } catch (const OutOfMemory&) {
      if (level == 0) throw;
      break;
    }
    if (!reached && !levels.exist()) {
      result.message = fmt::format(
          "no start path: in {} dimensions there are no cells to search, and a walk straight "
          "towards the end gets stuck",
          surface.dim());
      return result;
    }
    if (!reached) {
      if (apart(level, p, q)) {
        result.status = Status::disconnected;
        result.message = "the two points lie on different components of the surface";
        return result;
      }
      context.tell(fmt::format("cells of {:.3g} cannot tell the sheets of the surface apart; trying finer ones",
                               levels.size(level)));
      continue;
    }
    correct(result);
    const bool second_try = best.has_value();
    if (!best || result.status == Status::ok || result.length_error < best->length_error) best = result;
    // Within a cell the start is as good as it gets.
    if (result.status == Status::ok || second_try || (p - q).norm() < result.cell) break;
  }
  if (!best) {
    result.status = Status::disconnected;
    result.message = fmt::format("no path was found on cells down to {:.3g}", result.cell);
    return result;
  }
  if (best->status == Status::ok) {
    best->candidates.push_back({best->length, best->locally_shortest, best->points});
  }
  return *std::move(best);
}

PathResult PathSolver::solve(const VectorIn& p, const VectorIn& q) {
  detail::check_point(impl_->surface, p, "start");
  detail::check_point(impl_->surface, q, "end");
  impl_->levels.prepare(chord(p, q));
  const Vector from = impl_->levels.on_surface(p, "start");
  const Vector to = impl_->levels.on_surface(q, "end");
  return impl_->between(from, to);
}

/// As solve, with what is wrong with the request as the result's message.
PathResult PathSolver::solve_or_explain(const VectorIn& p, const VectorIn& q) {
  try {
    return solve(p, q);
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    PathResult result;
    result.from = p;
    result.to = q;
    result.message = error.what();
    return result;
  }
}

std::vector<PathResult> PathSolver::solve_from(const VectorIn& p, const PointsIn& targets) {
  Impl& impl = *impl_;
  detail::check_point(impl.surface, p, "start");
  impl.levels.prepare(with_finite_columns(p, targets));
  const Vector from = impl.levels.on_surface(p, "start");
  if (!impl.levels.exist()) {
    std::vector<PathResult> results;
    for (Index j = 0; j < targets.cols(); ++j) results.push_back(solve_or_explain(p, targets.col(j)));
    return results;
  }
  PathSeconds shared;
  const Stopwatch cells_watch;
  SurfaceCells& cells = impl.levels.cells(0, from);
  shared.cells = cells_watch.seconds();
  const Stopwatch march_watch;
  const DistanceField field =
      march(impl.surface, cells, from, MarchOptions{.method = impl.options.march, .target = {}}, impl.context);
  shared.march = march_watch.seconds();

  std::vector<PathResult> results(static_cast<std::size_t>(targets.cols()));
  for (Index j = 0; j < targets.cols(); ++j) {
    PathResult& result = results[static_cast<std::size_t>(j)];
    result.from = from;
    result.to = targets.col(j);
    try {
      detail::check_point(impl.surface, targets.col(j), "end");
      result.to = impl.levels.on_surface(targets.col(j), "end");
      result.grid_path = descend(impl.surface, cells, field, result.to);
      result.cell = cells.grid().size();
      result.num_cells = cells.num_cells();
      if (result.grid_path.cols() >= 2 && result.to != from) impl.correct(result);
      // What the shared field cannot answer gets the whole treatment: finer cells, and the reason.
      if (result.status != Status::ok) result = impl.between(from, result.to);
      if (j == 0) {
        result.seconds.cells += shared.cells;
        result.seconds.march += shared.march;
      }
    } catch (const Cancelled&) {
      throw;
    } catch (const Error& error) {
      result.status = Status::not_converged;
      result.points.resize(0, 0);
      result.message = error.what();
    }
    impl.context.report("paths", static_cast<double>(j + 1) / static_cast<double>(targets.cols()));
  }
  return results;
}

PathResult shortest_path(const Surface& surface, const VectorIn& p, const VectorIn& q, const PathOptions& options,
                         const Context& context) {
  return PathSolver(surface, options, context).solve(p, q);
}

}  // namespace taut
