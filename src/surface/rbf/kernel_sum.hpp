#pragma once

#include <vector>

#include "taut/core/types.hpp"
#include "taut/surface/fit.hpp"

namespace taut::detail {

/// Sums over the centres at one point x, with u = x - centre and r = |u|:
///   value    = sum w phi(r)                        phi = r^3        or r^5
///   gradient = sum w a(r) u         (d)            a   = 3 r        or 5 r^3
///   hessian  = sum w (a(r) I + b(r) u u^T) (d x d) b   = 3 / r      or 15 r
/// Null outputs are not computed. The sums run in eight interleaved partial sums with separate multiplication and
/// addition, whatever the width of the machine's vectors, so every processor gives the same bits, and asking for more
/// outputs changes none of them.
class KernelSum {
 public:
  KernelSum() = default;
  /// `centres`: d x n; `weights`: n.
  KernelSum(RbfKernel kernel, const Points& centres, const Vector& weights);

  void operator()(const double* x, double* value, double* gradient, double* hessian) const;

 private:
  RbfKernel kernel_ = RbfKernel::cubic;
  Index dim_ = 0;
  Index num_blocks_ = 0;
  /// Blocks of eight centres: d rows of eight coordinates, then eight weights (0 in the last block's unused lanes).
  std::vector<double> blocks_;
};

}  // namespace taut::detail
