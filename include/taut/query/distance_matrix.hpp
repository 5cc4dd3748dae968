#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/query/distance.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// What `DistanceMatrix` is asked for.
struct MatrixOptions {
  DistanceOptions distance = {};
  /// > 0: only the so many nearest targets of each point (itself left out), those at equal distance by number.
  Index k_nearest = 0;
};

/// Distances of one point from others.
struct MatrixRow {
  Index row = 0;
  /// Numbers of the targets. All pairs: row + 1 .. n - 1. With targets of their own: all of them. With
  /// `distance.max_distance`: of those only the ones that near, ascending. With `k_nearest`: the nearest of all others,
  /// nearest first. What might be among them but was not found out follows, as NaN.
  std::vector<Index> column;
  std::vector<double> distance;  ///< model units; infinity on another component, NaN where it was not found out
  std::vector<double> error;     ///< estimated, model units
};

/// Distances between many points, row by row, so that rows can be written as they come: on surfaces in R^3 one fan of
/// geodesics a row (docs/field.md), elsewhere and where rays cannot be followed one corrected path a pair. Between
/// points of one set each pair is computed once, so the matrix is symmetric by construction, with zeros on the
/// diagonal. Not safe to share between threads; works on all cores, and the number of threads changes no result.
class DistanceMatrix {
 public:
  /// All pairs of `points` (d x n, projected onto the surface). Throws InvalidArgument for a wrong shape, options out
  /// of range, points off the surface (naming the first); SingularPoint, EmptySurface, OutOfMemory, Cancelled.
  DistanceMatrix(Surface surface, const PointsIn& points, const MatrixOptions& options = {}, Context context = {});
  /// From each of `points` (d x n) to each of `targets` (d x m).
  DistanceMatrix(Surface surface, const PointsIn& points, const PointsIn& targets, const MatrixOptions& options = {},
                 Context context = {});
  ~DistanceMatrix();
  DistanceMatrix(DistanceMatrix&&) noexcept;
  DistanceMatrix& operator=(DistanceMatrix&&) noexcept;

  [[nodiscard]] Index num_rows() const;
  [[nodiscard]] Index num_columns() const;
  [[nodiscard]] bool symmetric() const;  ///< all pairs of one set

  /// Rows first .. first + count - 1. The same rows come out whichever were asked for before. Throws Cancelled.
  [[nodiscard]] std::vector<MatrixRow> rows(Index first, Index count);

  /// Why distances were not found out or are infinite, the first few of them, in one sentence each.
  [[nodiscard]] const std::vector<std::string>& messages() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The whole matrix at once, n x n and symmetric.
[[nodiscard]] Eigen::MatrixXd distance_matrix(const Surface& surface, const PointsIn& points,
                                              const MatrixOptions& options = {}, const Context& context = {});

}  // namespace taut
