// Shortest paths asked for singly, in pairs and from one point to many. A solver keeps what can be used again: box,
// cells, tables. Each block of pairs has a corrector of its own; the search is shared, its const members being safe to
// call. A pair that fails says so in its own result: only Cancelled ends a batch.
//
// From one point, the distance field is marched once over all cells, and every target continues from there.
#include "taut/query/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "core/parallel.hpp"
#include "core/stopwatch.hpp"
#include "curve/polyline.hpp"
#include "search/check_options.hpp"
#include "search/corrector.hpp"
#include "search/path_search.hpp"
#include "surface/point_text.hpp"
#include "taut/surface/fit.hpp"

namespace taut {
namespace {

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

/// What is known against a fitted surface puts every path on it in doubt.
PathResult with_doubt(PathResult result, const std::string& doubt) {
  if (doubt.empty() || result.status != Status::ok || result.from == result.to) return result;
  result.doubts.add(Doubt::sheets_not_told);
  result.unique = false;
  result.message = result.message.empty() ? doubt : result.message + "; " + doubt;
  return result;
}

}  // namespace

struct PathSolver::Impl {
  Impl(Surface surface_of, const PathOptions& options_of, const Context& user_of)
      : surface(std::move(surface_of)),
        options(options_of),
        user(user_of),
        context(in_turn(user, turn, batch)),
        search(surface, options, context),
        doubt(fit_doubt(surface)) {}

  using Corrector = detail::Corrector;

  Surface surface;
  PathOptions options;
  Context user;
  std::shared_ptr<std::mutex> turn = std::make_shared<std::mutex>();
  std::shared_ptr<std::atomic<bool>> batch = std::make_shared<std::atomic<bool>>(false);
  Context context;  // the user's, fit for several threads
  detail::PathSearch search;
  std::string doubt;  // about the surface itself

  [[nodiscard]] const detail::CellLevels& levels() const { return search.levels(); }
  /// body(j, corrector) for j = 0 .. n - 1 on all cores; what it throws becomes the message of result j.
  [[nodiscard]] std::vector<PathResult> for_all(Index n, bool parallel,
                                                const std::function<PathResult(Index, Corrector&)>& body);
};

PathSolver::PathSolver(Surface surface, PathOptions options, Context context) {
  detail::check_options(options);
  detail::check_cells(surface, options);
  impl_ = std::make_unique<Impl>(std::move(surface), options, context);
}
PathSolver::~PathSolver() = default;
PathSolver::PathSolver(PathSolver&&) noexcept = default;
PathSolver& PathSolver::operator=(PathSolver&&) noexcept = default;

const Surface& PathSolver::surface() const { return impl_->surface; }

std::vector<PathResult> PathSolver::Impl::for_all(Index n, bool parallel,
                                                  const std::function<PathResult(Index, Corrector&)>& body) {
  constexpr Index kBlock = 8;
  std::vector<PathResult> results(static_cast<std::size_t>(n));
  // Parallel over pairs; within a pair on one thread only.
  Context threads = user;
  if (!parallel) threads.threads = 1;
  Context serial = context;  // of a single pair among many
  serial.threads = 1;
  std::atomic<Index> done = 0;
  // Progress of single marches would mean nothing in a batch.
  *batch = true;
  try {
    detail::parallel_for(threads, 0, n, kBlock, [&](Index first, Index last) {
      Corrector corrector(surface, options, serial);
      for (Index j = first; j < last; ++j) {
        PathResult& result = results[static_cast<std::size_t>(j)];
        try {
          result = with_doubt(body(j, corrector), doubt);
        } catch (const Cancelled&) {
          throw;
        } catch (const Error& error) {
          result = PathResult{};
          result.message = error.what();
          result.obstacle = {Obstacle::Kind::refused};
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
  impl.search.prepare(detail::chord(p, q));
  const double box_seconds = watch.seconds();
  Impl::Corrector corrector(impl.surface, impl.options, impl.context);
  PathResult result =
      with_doubt(impl.search.find(impl.levels().on_surface(p, "start"), impl.levels().on_surface(q, "end"), corrector),
                 impl.doubt);
  // Finding the box was part of the cells' work.
  result.seconds.cells += box_seconds;
  return result;
}

void PathSolver::expect(const PointsIn& near, Index num_pairs) {
  Impl& impl = *impl_;
  impl.search.prepare(finite_columns(near, impl.surface.dim()));
  impl.search.tabulate(num_pairs);
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
    return impl.search.find(impl.levels().on_surface(from.col(j), "start"), impl.levels().on_surface(to.col(j), "end"),
                            corrector);
  });
}

std::vector<PathResult> PathSolver::solve_from(const VectorIn& p, const PointsIn& targets) {
  Impl& impl = *impl_;
  detail::check_point(impl.surface, p, "start");
  Points all(p.size(), 1 + (targets.rows() == p.size() ? targets.cols() : 0));
  all << p, targets.leftCols(all.cols() - 1);
  impl.search.prepare(finite_columns(all, impl.surface.dim()));
  const Vector from = impl.levels().on_surface(p, "start");
  const auto target = [&](Index j) {
    detail::check_point(impl.surface, targets.col(j), "end");
    return impl.levels().on_surface(targets.col(j), "end");
  };
  // No field to share: no cells, cells that grow for each pair, or paths over edges.
  if (!impl.levels().exist() || impl.levels().lazy() || impl.search.has_kinks()) {
    return impl.for_all(targets.cols(), true, [&](Index j, Impl::Corrector& corrector) {
      return impl.search.find(from, target(j), corrector);
    });
  }
  PathSeconds shared;
  detail::Stopwatch watch;
  const detail::Ground ground = impl.search.finder().ground(0, from);
  shared.cells = watch.restart();
  const DistanceField field = impl.search.finder().march_all(ground, from);
  shared.march = watch.seconds();
  // What was walked is the shared march's, which has come to all that hangs together: it is kept once.
  std::mutex keeping;
  Points walked;
  const auto starts_to = [&](const Vector& to) {
    detail::Starts starts = impl.search.finder().continue_to(ground, field, to);
    const std::lock_guard lock(keeping);
    if (walked.cols() == 0) walked = starts.walked;
    starts.walked.resize(0, 0);
    return starts;
  };
  // Lazy cells grow while they are marched on: one at a time.
  std::vector<PathResult> results =
      impl.for_all(targets.cols(), !ground.cells->is_lazy(), [&](Index j, Impl::Corrector& corrector) {
        const Vector to = target(j);
        return impl.search.find(from, to, corrector, starts_to(to));
      });
  const auto on_shared_cells = std::ranges::find_if(results, [&](const PathResult& result) {
    return result.grid_path.cols() > 0 && result.cell == ground.cells->grid().size();
  });
  if (on_shared_cells != results.end()) on_shared_cells->walked_cells = std::move(walked);
  if (!results.empty()) {
    // The shared work counts once.
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
