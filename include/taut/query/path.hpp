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

}  // namespace taut
