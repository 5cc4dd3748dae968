#include "taut/query/path.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "query/candidates.hpp"
#include "query/cell_levels.hpp"
#include "query/walk_towards.hpp"
#include "taut/cells/components.hpp"
#include "taut/curve/flow.hpp"
#include "taut/curve/newton.hpp"
#include "taut/march/descend.hpp"
#include "taut/march/march.hpp"
#include "taut/march/start_paths.hpp"

namespace taut {
namespace {

/// A corrected path is never much longer than its start; one that is has jumped somewhere.
constexpr double kMostGrowth = 1.1;
/// Ways round up to this part longer than the shortest, by the marched distances, are looked at as its rivals...
constexpr double kExcess = 0.15;
/// ... and those are corrected that may turn out the shortest, the marched distances being this wrong, or this many
/// times as wrong as those of the ways corrected before...
constexpr double kMarchError = 0.1;
constexpr double kMarchErrorFactor = 3;
/// ... while a path this much longer than what was marched has missed the way that the march has seen.
constexpr double kDoubt = 0.03;
constexpr Index kMostRivals = 16;
constexpr Index kMostWaysRound = 64;
/// Within this many cells of each other two points have no rivals between them.
constexpr double kNoRivals = 4;

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

/// A converged path before any other, then the shorter one; of those not converged the one that came nearer.
bool is_better(const PathResult& a, const PathResult& b) {
  if (a.status != b.status)
    return a.status == Status::ok || (b.status != Status::ok && a.length_error < b.length_error);
  return a.status == Status::ok ? a.length < b.length : a.length_error < b.length_error;
}

}  // namespace

struct PathSolver::Impl {
  Surface surface;
  PathOptions options;
  Context context;
  detail::CellLevels levels;

  std::vector<StartPath> starts(PathResult& result, int level);
  std::vector<StartPath> ways_round(PathResult& result, SurfaceCells& cells, const DistanceField& from_p);
  void correct(PathResult& result) const;
  bool correct_all(PathResult& result, const std::vector<StartPath>& starts) const;
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

/// Ways from result.from to result.to to start from, by the cells of one level; none when no way was found.
std::vector<StartPath> PathSolver::Impl::starts(PathResult& result, int level) {
  if (!levels.exist()) {
    const Stopwatch watch;
    Points walk = detail::walk_towards(surface, result.from, result.to);
    result.seconds.march += watch.seconds();
    if (walk.cols() < 2) return {};
    const double length = polyline_length(walk);
    return {{length, std::move(walk)}};
  }
  const Stopwatch cells_watch;
  SurfaceCells& cells = levels.cells(level, chord(result.from, result.to));
  result.seconds.cells += cells_watch.seconds();
  const Stopwatch watch;
  MarchOptions march_options{.method = options.march};
  if (!options.all) march_options.target = result.to;
  const DistanceField from_p = march(surface, cells, result.from, march_options, context);
  result.seconds.march += watch.seconds();
  return ways_round(result, cells, from_p);
}

/// The same where the distances from result.from are there already, up to those at result.to.
std::vector<StartPath> PathSolver::Impl::ways_round(PathResult& result, SurfaceCells& cells,
                                                    const DistanceField& from_p) {
  const Stopwatch watch;
  result.cell = cells.grid().size();
  std::vector<StartPath> paths;
  const double distance = distance_at(surface, cells, from_p, result.to)(0);
  if (std::isfinite(distance)) {
    const bool rivals = options.march == MarchMethod::convergent && options.method != CorrectionMethod::grid;
    if (rivals && (options.all || distance > kNoRivals * result.cell)) {
      MarchOptions march_options{.method = options.march};
      if (!options.all) march_options.target = result.from;
      const DistanceField from_q = march(surface, cells, result.to, march_options, context);
      paths = start_paths(surface, cells, from_p, from_q,
                          {.excess = options.all ? std::numeric_limits<double>::infinity() : kExcess,
                           .max_paths = options.all ? kMostWaysRound : kMostRivals});
    }
    if (paths.empty()) {
      Points descent = descend(surface, cells, from_p, result.to);
      if (descent.cols() >= 2) paths.push_back({distance, std::move(descent)});
    }
  }
  result.num_cells = cells.num_cells();
  result.seconds.march += watch.seconds();
  return paths;
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

/// Corrects every start that may lead to the shortest path; the best becomes `result`, with the others as candidates.
/// False when a start that promised a clearly shorter path has not led to one.
bool PathSolver::Impl::correct_all(PathResult& result, const std::vector<StartPath>& starts) const {
  std::optional<PathResult> best;
  std::vector<PathCandidate> candidates;
  double march_error = kMarchError;
  for (const StartPath& start : starts) {
    const bool hopeless = best && best->status == Status::ok && start.length > best->length * (1 + march_error);
    if (hopeless && !options.all) break;
    result.grid_path = start.points;
    correct(result);
    if (result.status == Status::ok) {
      march_error = std::max(march_error, kMarchErrorFactor * (start.length / result.length - 1));
      detail::add_candidate(candidates, {result.length, result.length_error, result.locally_shortest, result.points});
      if (best && best->status == Status::ok && result.length >= best->length) continue;
    } else if (best && (best->status == Status::ok || best->length_error <= result.length_error)) {
      continue;
    }
    best = result;
  }
  const PathSeconds seconds = result.seconds;
  result = *std::move(best);
  result.seconds = seconds;
  result.candidates = std::move(candidates);
  result.unique = detail::first_is_unique(result.candidates, options.tolerance);
  return result.status == Status::ok && result.length <= (1 + kDoubt) * starts.front().length;
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
  // Cells that cannot tell sheets apart lead nowhere, or to a start from which the correction fails, or past the
  // shortest way: try finer ones. The first path above doubt is returned; failing that, the better of the first two.
  std::optional<PathResult> best;
  for (int level = 0; level < levels.num_levels(); ++level) {
    std::vector<StartPath> found;
    try {
      found = starts(result, level);
    } catch (const OutOfMemory&) {
      if (level == 0) throw;
      break;
    }
    if (found.empty() && !levels.exist()) {
      result.message = fmt::format(
          "no start path: in {} dimensions there are no cells to search, and a walk straight "
          "towards the end gets stuck",
          surface.dim());
      return result;
    }
    if (found.empty()) {
      if (apart(level, p, q)) {
        result.status = Status::disconnected;
        result.message = "the two points lie on different components of the surface";
        return result;
      }
      context.tell(fmt::format("cells of {:.3g} cannot tell the sheets of the surface apart; trying finer ones",
                               levels.size(level)));
      continue;
    }
    const bool sure = correct_all(result, found);
    const bool second_try = best.has_value();
    if (!best || is_better(result, *best)) best = result;
    best->seconds = result.seconds;
    // Within a cell the start is as good as it gets.
    if (sure || second_try || (p - q).norm() < result.cell) break;
  }
  if (!best) {
    result.status = Status::disconnected;
    result.message = fmt::format("no path was found on cells down to {:.3g}", result.cell);
    return result;
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
      const std::vector<StartPath> starts = impl.ways_round(result, cells, field);
      const bool sure = !starts.empty() && result.to != from && impl.correct_all(result, starts);
      // What the shared field cannot answer gets the whole treatment: finer cells, and the reason.
      if (!sure) result = impl.between(from, result.to);
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
