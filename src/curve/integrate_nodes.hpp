#pragma once

#include "curve/gauss_collocation.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// How velocities and positions at kStages places of a step follow from the accelerations at its nodes.
struct NodeWeights {
  GaussCollocation::Square once, twice;                    ///< row i: weights of int a, of int int a, up to place i
  Eigen::Matrix<double, GaussCollocation::kStages, 1> at;  ///< place i, in (0, 1]
};

/// v + h int a and x + h at v + h^2 int int a for each of `dim` coordinates. `a`, `velocity` and `position` hold a
/// place a row, a coordinate contiguous: kStages x dim. The same bits on every instruction set.
void integrate_nodes(const NodeWeights& weights, Index dim, double h, const double* x, const double* v, const double* a,
                     double* velocity, double* position);

}  // namespace taut::detail
