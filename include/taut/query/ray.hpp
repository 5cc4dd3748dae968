#pragma once

#include <memory>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// A geodesic given by its start, as asked for by a user.
struct RayResult : ExponentialResult {
  Vector from;          ///< d: the start, on the surface
  std::string message;  ///< why `status` is not ok, in one sentence; empty otherwise
  /// In order from the start, on a surface in R^3 whose formula has kinks: arcs on faces and the edges that the ray
  /// crosses between them. There the part of its direction along the edge is kept, as if the faces were unfolded.
  std::vector<PathPiece> pieces;
};

/// Geodesics from given points in given directions on one surface. Not for sharing between threads.
class RaySolver {
 public:
  /// Throws InvalidArgument for options out of range. Does no work yet. `options.tolerance` 0 stands for 1e-9 on a
  /// dense fit (`fit_rbf`), whose third derivatives jump at its samples.
  explicit RaySolver(Surface surface, ExponentialOptions options = {}, Context context = {});
  ~RaySolver();
  RaySolver(RaySolver&&) noexcept;
  RaySolver& operator=(RaySolver&&) noexcept;

  /// ExponentialMap::trace after the checks of PathSolver::solve: a start off the surface by more than a cell, and a
  /// direction that points off the surface by more than a degree, are told through Context::note; a start off by more
  /// than ten cells, or outside the domain, throws InvalidArgument. On a surface with edges the ray crosses them; it
  /// ends at a border (left_domain), in a corner or along an edge (not_converged). Conjugate points are looked for as
  /// long as it stays on one face.
  [[nodiscard]] RayResult solve(const VectorIn& from, const VectorIn& direction, double length);

  /// Column j of `from` and `directions` (d x n) with `lengths`(j), on all threads; answer j does not depend on the
  /// others. A ray that cannot be answered carries its status and message; throws Cancelled only.
  [[nodiscard]] std::vector<RayResult> solve_many(const PointsIn& from, const PointsIn& directions,
                                                  const VectorIn& lengths);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace taut
