#pragma once

#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/status.hpp"
#include "taut/query/distance.hpp"

namespace taut {

struct KarcherMeanOptions {
  DistanceOptions distance = {};
  int max_iterations = 200;  ///< from each start, >= 1
};

/// The point of a surface with the least weighted mean of squared distances from given ones (Karcher 1977).
struct KarcherMean {
  Status status = Status::not_converged;
  std::string message;  ///< why it is not ok, or why it is not unique, in one sentence
  Vector point;         ///< d, on the surface
  double variance = 0;  ///< weighted mean of squared distances, model units squared
  double gradient = 0;  ///< length of the weighted mean of log_point(points), model units: 0 at the mean
  Vector distance;      ///< n: from `point` to each of the points
  /// False where another point was found that is as good, or where a point lies on the cut locus of the mean so that it
  /// could be drawn another way. True is no proof: the mean was looked for from several starts.
  bool unique = true;
  std::vector<Vector> others;  ///< other minima that were found, d each
  int num_iterations = 0;      ///< from all starts together
};

/// Of `points` (d x n) with `weights` (n, not negative, empty = equal), from the heaviest point and from those farthest
/// from what was found: on 2-surfaces by Newton's method (three to six steps), elsewhere by x <- exp_x(mean of
/// log_x(points)); with a shorter step where that does not lower the variance. Points within a small ball have one mean
/// (Afsari 2011); on a sphere, points all round it have many. Throws InvalidArgument for wrong shapes and weights, and
/// what DistanceSolver throws. Cost: a fan of geodesics an iteration on surfaces in R^3, a path a point elsewhere.
[[nodiscard]] KarcherMean karcher_mean(const Surface& surface, const PointsIn& points, const Vector& weights = {},
                                       const KarcherMeanOptions& options = {}, const Context& context = {});

}  // namespace taut
