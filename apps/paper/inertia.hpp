#pragma once

#include <vector>

#include "taut/core/types.hpp"
#include "taut/query/path.hpp"

namespace taut::paper {

/// Second moments of a set of points as seen from one point of a surface, along geodesics: each destination counts as
/// the tangent vector of its geodesic, direction times length (its logarithm).
struct GeodesicInertia {
  Eigen::MatrixXd matrix;  ///< d x d: mean of u u^T, of rank d - k; model units squared
  Vector eigenvalues;      ///< d, largest first
  Points directions;       ///< d x d: their unit eigenvectors; the first d - k are tangents
  double mean_square = 0;  ///< mean squared geodesic distance: the trace
};

/// Of the paths that have a length and a start direction. Throws InvalidArgument when there is none such.
[[nodiscard]] GeodesicInertia geodesic_inertia(const std::vector<PathResult>& paths);

}  // namespace taut::paper
