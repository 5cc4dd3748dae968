#pragma once

#include <memory>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Shortest paths on one surface: keeps the cells, so that asking again is cheap. Not safe to share between threads.
class PathSolver {
 public:
  /// Throws InvalidArgument for options out of range. Does no work yet.
  explicit PathSolver(Surface surface, PathOptions options = {}, Context context = {});
  ~PathSolver();
  PathSolver(PathSolver&&) noexcept;
  PathSolver& operator=(PathSolver&&) noexcept;

  /// The path from p to q (d each), both projected onto the surface first; moving one by more than a cell is told
  /// through Context::note, by more than ten cells it throws InvalidArgument. Also throws SingularPoint when a point
  /// is singular, EmptySurface, OutOfMemory and Cancelled. Everything else is in `status`.
  /// Properties: starts exactly at `from` and ends at `to`; length >= |p - q|; p = q gives length 0.
  [[nodiscard]] PathResult solve(const VectorIn& p, const VectorIn& q);

  /// Between column j of `from` and column j of `to` (d x n each), on all cores; the number of threads changes no
  /// result. A pair that cannot be answered carries its status and message. Throws InvalidArgument when the shapes
  /// differ, EmptySurface, OutOfMemory for cells that all need, and Cancelled.
  [[nodiscard]] std::vector<PathResult> solve_pairs(const PointsIn& from, const PointsIn& to);

  /// From p to every column of `targets` (d x n) over one marched field, on all cores. A target that cannot be answered
  /// carries its status and message; only a bad p throws.
  [[nodiscard]] std::vector<PathResult> solve_from(const VectorIn& p, const PointsIn& targets);

  /// Says that about `num_pairs` pairs of points near these (d x n) will be asked for: cells are made, and where that
  /// pays, a table of distances between a few hundred places, after which starts take microseconds instead of
  /// milliseconds. solve_pairs does it for its own pairs; call it when they come in several parts.
  void expect(const PointsIn& near, Index num_pairs);

  [[nodiscard]] const Surface& surface() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// One path on one surface.
[[nodiscard]] PathResult shortest_path(const Surface& surface, const VectorIn& p, const VectorIn& q,
                                       const PathOptions& options = {}, const Context& context = {});

/// A path through several points in order. The PathResult part is the whole: lengths, errors and seconds are sums,
/// residuals and cells the largest, `unique` and `locally_shortest` hold when they hold for every leg, `tied` and
/// `doubts` when they do for one, `points` run
/// through all legs without repeating the joints. It has the status and message of its worst leg, and no length and
/// points when a leg has none. `grid_path`, `candidates` and the directions at the ends are left to the legs.
struct ViaResult : PathResult {
  std::vector<PathResult> legs;  ///< n - 1, each a shortest path
};

/// The shortest path through column 0, 1, ..., n - 1 of `points` (d x n, n >= 2), each projected onto the surface as by
/// PathSolver::solve. Where every leg is globally shortest, so is the whole among the paths through these points.
/// Throws InvalidArgument for a wrong shape, and what PathSolver::solve throws, its message led by the leg's number.
[[nodiscard]] ViaResult path_through(PathSolver& solver, const PointsIn& points);

/// The geodesic in the homotopy class of `polyline` (d x m, m >= 2, a point a column, in order): what a string laid
/// along it becomes when it is pulled taut over the surface with its ends held. Not the shortest path: a polyline that
/// winds twice round a handle stays wound twice. See docs/loops.md.
///
/// The points are projected onto the surface first. The class is kept by moving in steps shorter than a grid cell
/// (`PathOptions::cell`, half of it), and the corrected curve must follow the shortened polyline as closely; when it
/// does not, the status is not_converged. `PathOptions::method` newton or flow; `march`, `grid` and `all` play no part.
///
/// In the result `grid_path` is the polyline as it was before the correction, `candidates` has the path alone, and
/// neither `unique` nor `tied` holds: other ways are not looked for. A polyline that returns to its start and comes
/// undone is a path of length 0; `message` says so.
///
/// Throws InvalidArgument for a wrong shape, an option out of range, and, naming the points by their number from 1, for
/// a point without a surface within ten cells, or neighbours too far apart to tell their class; also EmptySurface,
/// OutOfMemory, Cancelled.
[[nodiscard]] PathResult path_in_class(const Surface& surface, const PointsIn& polyline,
                                       const PathOptions& options = {}, const Context& context = {});

}  // namespace taut
