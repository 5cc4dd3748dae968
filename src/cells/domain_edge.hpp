#pragma once

#include <memory>
#include <vector>

#include "taut/core/types.hpp"
#include "taut/surface/projection.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Brings surface points that lie just outside the surface's domain onto its edge: F = 0 together with the inequalities
/// that are broken, as equations. One a thread.
class DomainEdge {
 public:
  /// `surface` must have a domain and outlive this.
  explicit DomainEdge(const Surface& surface);

  /// Moves x (d), a surface point outside the domain, to a point of the surface inside it to within `slack` (model
  /// units). False, x as it was, when Newton's method does not get there or breaks other inequalities on the way.
  bool pull(Eigen::Ref<Eigen::MatrixXd> x, const ProjectionOptions& options, double slack);

 private:
  class Stacked;

  const Surface& surface_;
  std::unique_ptr<Evaluator> function_;
  std::unique_ptr<Evaluator> domain_;
  std::vector<Index> broken_;
};

}  // namespace taut::detail
