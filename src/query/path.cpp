#include "taut/query/path.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <numbers>
#include <optional>
#include <utility>

#include "core/parallel.hpp"
#include "query/cell_levels.hpp"
#include "query/check_options.hpp"
#include "query/corrector.hpp"
#include "query/no_way.hpp"
#include "query/shorter_paths.hpp"
#include "query/start_finder.hpp"
#include "query/stopwatch.hpp"

namespace taut {
namespace {

Points chord(const VectorIn& p, const VectorIn& q) {
  Points x(p.size(), 2);
  x << p, q;
  return x;
}

/// The columns of x (d each) without a NaN or infinity.
Points finite_columns(const PointsIn& x, Index dim) {
  Points finite(dim, x.rows() == dim ? x.cols() : 0);
  Index count = 0;
  for (Index j = 0; j < finite.cols(); ++j) {
    if (x.col(j).allFinite()) finite.col(count++) = x.col(j);
  }
  return finite.leftCols(count);
}

/// The user's context for work on several threads: one call at a time, and while `batch` is raised no progress of the
/// parts, only of the whole.
Context in_turn(const Context& context, const std::shared_ptr<std::mutex>& turn,
                const std::shared_ptr<std::atomic<bool>>& batch) {
  Context shared = context;
  if (context.note) {
    shared.note = [note = context.note, turn](std::string_view message) {
      const std::lock_guard lock(*turn);
      note(message);
    };
  }
  if (context.progress) {
    shared.progress = [progress = context.progress, turn, batch](std::string_view stage, double done) {
      if (*batch) return;
      const std::lock_guard lock(*turn);
      progress(stage, done);
    };
  }
  return shared;
}

/// Before cells get finer than so many, ways are sought without them; beyond so many, no longer with them.
constexpr Index kMostCellsBeforeWalks = 2'000'000;
constexpr Index kMostCellsForSheets = 6'000'000;
/// A part of the box is looked at again where it is smaller by this.
constexpr double kCloser = 0.7;
/// Where the surface bends sharply along a path, that is done if it is smaller by this, or the marched way is wrong by
/// more than that.
constexpr double kLocal = 0.5;
constexpr double kMismarched = 0.02;
/// Of the window that a surface without end is looked at through.
constexpr int kMostDoublings = 6;
constexpr Index kMostCellsFarther = 500'000;

constexpr std::string_view kApart = "the two points lie on different components of the surface";

bool proved_apart(const PathResult& result) {
  return result.status == Status::disconnected && result.message == kApart;
}

/// The time spent on `earlier` counts for `later`.
void add_seconds(const PathResult& earlier, PathResult& later) {
  later.seconds.cells += earlier.seconds.cells;
  later.seconds.march += earlier.seconds.march;
  later.seconds.correct += earlier.seconds.correct;
}

}  // namespace

struct PathSolver::Impl {
  Impl(Surface surface_of, const PathOptions& options_of, const Context& user_of)
      : surface(std::move(surface_of)),
        options(options_of),
        user(user_of),
        context(in_turn(user, turn, batch)),
        finder(surface, options, context) {}

  using Corrector = detail::Corrector;
  using Starts = detail::Starts;

  Surface surface;
  PathOptions options;
  Context user;
  std::shared_ptr<std::mutex> turn = std::make_shared<std::mutex>();
  std::shared_ptr<std::atomic<bool>> batch = std::make_shared<std::atomic<bool>>(false);
  Context context;  // the user's, fit for several threads
  detail::StartFinder finder;
  bool close_up = false;  // of a surface that another solver knows as a whole
  bool farther = false;   // through a wider window, where another solver has found no way
  mutable std::mutex widening;
  mutable std::vector<std::unique_ptr<Impl>> wider;  // through windows 2, 4, 8, ... times as wide

  void prepare(const PointsIn& near) {
    if (finder.prepare(near)) wider.clear();
  }
  [[nodiscard]] const detail::CellLevels& levels() const { return finder.levels(); }
  /// The shortest path. `first`: starts of level 0, when they are there already.
  [[nodiscard]] PathResult find(const Vector& p, const Vector& q, Corrector& corrector,
                                std::optional<Starts> first = std::nullopt) const;
  /// The shortest one in the box.
  [[nodiscard]] PathResult between(const Vector& p, const Vector& q, Corrector& corrector,
                                   std::optional<Starts> first) const;
  [[nodiscard]] bool doubted(const PathResult& found, const Starts& starts, int level) const;
  [[nodiscard]] PathResult walk(const PathResult& so_far, const Vector& p, const Vector& q, Corrector& corrector) const;
  [[nodiscard]] PathResult look_closer(PathResult found, Corrector& corrector) const;
  [[nodiscard]] Box window(int doublings) const;
  [[nodiscard]] bool have_room(const PathResult& found, int doublings) const;
  [[nodiscard]] bool is_affordable(const PathResult& found, int doublings) const;
  [[nodiscard]] const Impl& through(int doublings) const;
  /// body(j, corrector) for j = 0 .. n - 1 on all cores; what it throws becomes the message of result j.
  [[nodiscard]] std::vector<PathResult> for_all(Index n, bool parallel,
                                                const std::function<PathResult(Index, Corrector&)>& body);
};

PathSolver::PathSolver(Surface surface, PathOptions options, Context context) {
  detail::check_options(options);
  impl_ = std::make_unique<Impl>(std::move(surface), options, context);
}
PathSolver::~PathSolver() = default;
PathSolver::PathSolver(PathSolver&&) noexcept = default;
PathSolver& PathSolver::operator=(PathSolver&&) noexcept = default;

const Surface& PathSolver::surface() const { return impl_->surface; }

PathResult PathSolver::Impl::between(const Vector& p, const Vector& q, Corrector& corrector,
                                     std::optional<Starts> first) const {
  PathResult result;
  result.from = p;
  result.to = q;
  if (p == q) {
    result.status = Status::ok;
    result.locally_shortest = true;
    result.index = 0;
    result.points = chord(p, q);
    result.grid_path = result.points;
    result.cell = levels().size(0);
    return result;
  }
  const auto take = [&](const Starts& starts) {
    result.cell = starts.cell;
    result.rivals_sought = starts.rivals_sought;
    if (starts.cells) result.num_cells = starts.cells->num_cells();
    result.seconds.cells += starts.seconds.cells;
    result.seconds.march += starts.seconds.march;
  };
  std::optional<PathResult> by_table;
  if (!first) {
    const Starts starts = finder.find_by_table(p, q);
    take(starts);
    if (!starts.paths.empty()) {
      if (corrector.correct(result, starts, false)) {
        if (!levels().resolved()) return look_closer(std::move(result), corrector);
        // On which side of a spike a way begins no landmark tells.
        if (!finder.bends_sharply(0, result.points)) return result;
      }
      if (result.status == Status::ok) by_table = result;
    }
  }
  // Cells that cannot tell sheets apart lead nowhere, or to a start from which the correction fails, or past the
  // shortest way: try finer ones. The first path above doubt is returned; failing that, the better of the first two.
  std::optional<PathResult> best;
  std::optional<Barrier> barrier;
  bool sure = true;
  bool doubts = false;
  std::optional<PathResult> walked;
  double marched = 0;
  const auto disconnected = [&] {
    result.status = Status::disconnected;
    result.message = kApart;
    return result;
  };
  for (int level = 0; level < levels().num_levels(); ++level) {
    if (finder.known_to_be_apart(level, p, q)) return disconnected();
    Starts starts;
    try {
      starts = level == 0 && first ? *std::move(first) : finder.find(p, q, level);
    } catch (const OutOfMemory&) {
      if (level == 0) throw;
      break;
    }
    take(starts);
    barrier = starts.barrier;
    if (starts.paths.empty() && !levels().exist()) {
      result.status = Status::disconnected;
      result.message = fmt::format(
          "no path was found: the two points seem to lie on different components (random searches from both ends do "
          "not meet; in {} dimensions there are no cells to prove it; --samples may help)",
          surface.dim());
      return result;
    }
    if (starts.paths.empty()) {
      if (finder.apart(*starts.cells, level, p, q)) return disconnected();
      const Index finer = starts.cells->num_cells() << (surface.dim() - 1);
      if (farther && finer > kMostCellsFarther) break;
      if (!walked && finer > kMostCellsBeforeWalks) {
        walked = walk(result, p, q, corrector);
        if (walked->status == Status::ok) return *std::move(walked);
      }
      if (finer > kMostCellsForSheets) break;
      context.tell(fmt::format("cells of {:.3g} cannot tell the sheets of the surface apart; trying finer ones",
                               levels().size(level)));
      continue;
    }
    // Within a cell the start is as good as it gets; without cells there is no other.
    const bool only = !levels().exist() || (p - q).norm() < result.cell;
    const bool second_try = best.has_value();
    const bool last = only || second_try || level + 1 == levels().num_levels();
    sure = corrector.correct(result, starts, last) || only;
    marched = starts.paths.front().length;
    if (!best || detail::is_better(result, *best)) {
      best = result;
      doubts = doubted(result, starts, level);
    }
    best->seconds = result.seconds;
    if (sure || second_try) break;
  }
  if (!best) {
    if (!walked && levels().exist() && !farther) walked = walk(result, p, q, corrector);
    if (walked && walked->points.cols() > 0) return *std::move(walked);
    const bool walks = options.method != CorrectionMethod::grid;
    detail::explain_no_way(result, surface, {barrier, levels().resolved(), walks});
    return result;
  }
  if (by_table && detail::is_better(*by_table, *best)) {
    by_table->seconds = best->seconds;
    best = std::move(by_table);
  }
  if (!sure && best->status == Status::ok && options.method != CorrectionMethod::grid) {
    best->message = fmt::format(
        "a shorter path may exist: the cells know a way of length {:.6g}, but no geodesic was found along it", marched);
  }
  return doubts ? look_closer(*std::move(best), corrector) : *std::move(best);
}

/// Are the cells too coarse, as a whole or along this path, for a way found on them to be surely the shortest. Sharp
/// bends alone are no reason where finer cells for the part of the box that matters would be hardly finer.
bool PathSolver::Impl::doubted(const PathResult& found, const Starts& starts, int level) const {
  if (!levels().resolved()) return true;
  if (found.status != Status::ok) return false;
  const bool local = detail::box_of_shorter_paths(found.from, found.to, found.length).extent().maxCoeff() <
                     kLocal * levels().box().extent().maxCoeff();
  const double marched = starts.paths.front().length;
  const bool mismarched = std::abs(marched - found.length) > kMismarched * found.length;
  return (local || mismarched) && finder.bends_sharply(level, found.points);
}

/// Cells too coarse for the whole box may be fine enough for the part of it that shorter paths can visit: the ellipsoid
/// about the ends whose points are no farther from both than the path is long.
PathResult PathSolver::Impl::look_closer(PathResult found, Corrector& corrector) const {
  found.rivals_sought = false;
  if (found.status != Status::ok) return found;
  if (found.message.empty()) {
    found.message = fmt::format(
        "a shorter path may exist: cells of {:.3g} are coarser than the surface bends, and miss ways", found.cell);
  }
  const Box& whole = levels().box();
  Box near = detail::box_of_shorter_paths(found.from, found.to, found.length);
  near = intersection(near, whole);
  if (close_up || near.extent().maxCoeff() > kCloser * whole.extent().maxCoeff()) return found;
  Impl closer(surface.with_box(near), options, context);
  closer.close_up = true;
  closer.prepare(chord(found.from, found.to));
  PathResult again = closer.between(found.from, found.to, corrector, std::nullopt);
  if (again.status != Status::ok || again.length > (1 + options.tolerance) * found.length) return found;
  add_seconds(found, again);
  return again;
}

/// The first one, made wider where the surface has no end.
Box PathSolver::Impl::window(int doublings) const {
  const Box& first = levels().extent().window;
  const Vector middle = (first.lower + first.upper) / 2;
  const Vector half = levels().extent().endless.select((std::ldexp(0.5, doublings) * first.extent()).array(),
                                                       0.5 * first.extent().array());
  return {middle - half, middle + half};
}

/// Does that window hold all paths that are shorter.
bool PathSolver::Impl::have_room(const PathResult& found, int doublings) const {
  const Box seen = window(doublings);
  const Box shorter = detail::box_of_shorter_paths(found.from, found.to, found.length);
  return (!levels().extent().endless ||
          (shorter.lower.array() >= seen.lower.array() && shorter.upper.array() <= seen.upper.array()))
      .all();
}

/// A solver that looks through that window.
const PathSolver::Impl& PathSolver::Impl::through(int doublings) const {
  const std::lock_guard lock(widening);
  const auto at = static_cast<std::size_t>(doublings) - 1;
  if (wider.size() <= at) wider.resize(at + 1);
  if (!wider[at]) {
    const SurfaceExtent seen = through_window(surface, levels().extent(), window(doublings), context);
    wider[at] = std::make_unique<Impl>(surface.with_box(seen.box), options, context);
    wider[at]->farther = true;
    wider[at]->prepare(Points(surface.dim(), 0));
  }
  return *wider[at];
}

/// Where the surface goes on beyond the box, shorter ways may, too, or the only one: those are sought through windows
/// wide enough.
PathResult PathSolver::Impl::find(const Vector& p, const Vector& q, Corrector& corrector,
                                  std::optional<Starts> first) const {
  PathResult found = between(p, q, corrector, std::move(first));
  Box seen = levels().box();
  for (int doublings = 0; levels().endless();) {
    const bool way = found.status == Status::ok;
    if (way ? have_room(found, doublings) : !proved_apart(found)) break;
    const int before = doublings++;
    while (way && doublings < kMostDoublings && !have_room(found, doublings)) ++doublings;
    if (doublings <= kMostDoublings && is_affordable(found, doublings - before)) {
      try {
        const Impl& farther_out = through(doublings);
        PathResult again = farther_out.between(p, q, corrector, std::nullopt);
        const bool ahead = way ? again.status == Status::ok && again.length <= (1 + options.tolerance) * found.length
                               : again.status == Status::ok || proved_apart(again);
        add_seconds(found, again);
        if (ahead) {
          found = std::move(again);
          seen = farther_out.levels().box();
          continue;
        }
        found.seconds = again.seconds;
      } catch (const OutOfMemory&) {  // what was found is not lost
      }
    }
    found.rivals_sought = false;
    found.message = way ? fmt::format("a shorter path may exist: the surface goes on beyond {}", detail::text_of(seen))
                        : fmt::format("{} within {}, beyond which it goes on", kApart, detail::text_of(seen));
    break;
  }
  return found;
}

/// Cells of a given size get ever more.
bool PathSolver::Impl::is_affordable(const PathResult& found, int doublings) const {
  if (options.cell == 0) return true;
  const Index most = found.status == Status::ok ? kMostCellsForSheets : kMostCellsFarther;
  return found.num_cells <= most >> (doublings * (surface.dim() - surface.codim()));
}

/// For ends that no cells have joined: thin shells, of which a cell holds both sides. Without a curve where walks find
/// no way either.
PathResult PathSolver::Impl::walk(const PathResult& so_far, const Vector& p, const Vector& q,
                                  Corrector& corrector) const {
  const Starts starts = finder.walk(p, q);
  PathResult found = so_far;
  found.seconds.march += starts.seconds.march;
  if (starts.paths.empty() || options.method == CorrectionMethod::grid) return found;
  (void)corrector.correct(found, starts, true);
  // Walks on thin shells may step from sheet to sheet: where no geodesic comes of it, there was no way.
  const bool surely_a_way = surface.dim() - surface.codim() == 1;
  if (found.status != Status::ok && !surely_a_way) return so_far;
  found.rivals_sought = false;
  if (found.status == Status::ok) {
    found.message = fmt::format(
        "a shorter path may exist: cells of {:.3g} cannot tell the sheets of the surface apart, this one was found by "
        "walks from both ends",
        so_far.cell);
  }
  return found;
}

std::vector<PathResult> PathSolver::Impl::for_all(Index n, bool parallel,
                                                  const std::function<PathResult(Index, Corrector&)>& body) {
  constexpr Index kBlock = 8;
  std::vector<PathResult> results(static_cast<std::size_t>(n));
  Context threads = user;
  if (!parallel) threads.threads = 1;
  Context serial = context;  // of a single pair among many
  serial.threads = 1;
  std::atomic<Index> done = 0;
  *batch = true;
  try {
    detail::parallel_for(threads, 0, n, kBlock, [&](Index first, Index last) {
      Corrector corrector(surface, options, serial);
      for (Index j = first; j < last; ++j) {
        PathResult& result = results[static_cast<std::size_t>(j)];
        try {
          result = body(j, corrector);
        } catch (const Cancelled&) {
          throw;
        } catch (const Error& error) {
          result = PathResult{};
          result.message = error.what();
          if (dynamic_cast<const SingularPoint*>(&error) != nullptr) result.status = Status::rank_deficient;
        }
      }
      const Index so_far = done += last - first;
      const std::lock_guard lock(*turn);
      user.report("paths", static_cast<double>(so_far) / static_cast<double>(n));
    });
  } catch (...) {
    *batch = false;
    throw;
  }
  *batch = false;
  return results;
}

PathResult PathSolver::solve(const VectorIn& p, const VectorIn& q) {
  Impl& impl = *impl_;
  detail::check_point(impl.surface, p, "start");
  detail::check_point(impl.surface, q, "end");
  const detail::Stopwatch watch;
  impl.prepare(chord(p, q));
  const double box_seconds = watch.seconds();
  Impl::Corrector corrector(impl.surface, impl.options, impl.context);
  PathResult result = impl.find(impl.levels().on_surface(p, "start"), impl.levels().on_surface(q, "end"), corrector);
  result.seconds.cells += box_seconds;
  return result;
}

void PathSolver::expect(const PointsIn& near, Index num_pairs) {
  Impl& impl = *impl_;
  impl.prepare(finite_columns(near, impl.surface.dim()));
  impl.finder.tabulate(num_pairs);
}

std::vector<PathResult> PathSolver::solve_pairs(const PointsIn& from, const PointsIn& to) {
  Impl& impl = *impl_;
  if (from.cols() != to.cols() || from.rows() != to.rows()) {
    throw InvalidArgument(fmt::format("starts ({} x {}) and ends ({} x {}) do not make pairs", from.rows(), from.cols(),
                                      to.rows(), to.cols()));
  }
  Points both(from.rows(), 2 * from.cols());
  both << from, to;
  expect(both, from.cols());
  return impl.for_all(from.cols(), true, [&](Index j, Impl::Corrector& corrector) {
    detail::check_point(impl.surface, from.col(j), "start");
    detail::check_point(impl.surface, to.col(j), "end");
    return impl.find(impl.levels().on_surface(from.col(j), "start"), impl.levels().on_surface(to.col(j), "end"),
                     corrector);
  });
}

std::vector<PathResult> PathSolver::solve_from(const VectorIn& p, const PointsIn& targets) {
  Impl& impl = *impl_;
  detail::check_point(impl.surface, p, "start");
  Points all(p.size(), 1 + (targets.rows() == p.size() ? targets.cols() : 0));
  all << p, targets.leftCols(all.cols() - 1);
  impl.prepare(finite_columns(all, impl.surface.dim()));
  const Vector from = impl.levels().on_surface(p, "start");
  const auto target = [&](Index j) {
    detail::check_point(impl.surface, targets.col(j), "end");
    return impl.levels().on_surface(targets.col(j), "end");
  };
  if (!impl.levels().exist()) {
    return impl.for_all(targets.cols(), true,
                        [&](Index j, Impl::Corrector& corrector) { return impl.find(from, target(j), corrector); });
  }
  PathSeconds shared;
  detail::Stopwatch watch;
  const std::shared_ptr<SurfaceCells> cells = impl.finder.cells(0, from);
  shared.cells = watch.restart();
  const DistanceField field = impl.finder.march_all(*cells, from);
  shared.march = watch.seconds();
  // Lazy cells grow while they are marched on: one at a time.
  std::vector<PathResult> results =
      impl.for_all(targets.cols(), !cells->is_lazy(), [&](Index j, Impl::Corrector& corrector) {
        const Vector to = target(j);
        return impl.find(from, to, corrector, impl.finder.continue_to(cells, field, to));
      });
  if (!results.empty()) {
    results.front().seconds.cells += shared.cells;
    results.front().seconds.march += shared.march;
  }
  return results;
}

PathResult shortest_path(const Surface& surface, const VectorIn& p, const VectorIn& q, const PathOptions& options,
                         const Context& context) {
  return PathSolver(surface, options, context).solve(p, q);
}

}  // namespace taut
