#pragma once

#include <limits>

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct ProjectionOptions {
  /// Stop when |J^+ F| (for k = 1: |F| / |grad F|) is at most this, model units. 0 = as far as rounding allows.
  double tolerance = 0;
  /// Visits of the evaluator after the first, halved steps included.
  int max_steps = 50;
  /// Largest distance a point may move, model units; farther counts as not converged.
  double max_distance = std::numeric_limits<double>::infinity();
};

struct ProjectionResult {
  Vector point;         ///< d; the best iterate when not converged
  double distance = 0;  ///< |point - x|, model units
  double residual = 0;  ///< |J^+ F| at `point`, model units
  int num_steps = 0;    ///< visits of the evaluator after the first
  bool converged = false;
};

/// A nearby surface point, by the paper's Newton-Raphson iteration dp/dt = -F grad F / |grad F|^2 (sec. 4; for k > 1
/// p <- p - J^+ F), safeguarded by step halving on the affine-invariant test |J^+ F(p_new)| < |J^+ F(p)|. Nearby, not
/// always the nearest. Converges quadratically at regular points. Properties the tests check: F -> A F (A invertible)
/// changes only rounding; a surface point stays where it is to rounding.
/// Throws SingularPoint, naming the point, when J loses rank where it is needed: at the start, on the way, or because
/// the iteration runs into a singular point of the surface (the apex of a cone, a squared equation, a constraint
/// written as sqrt of a sum of squares). Throws InvalidArgument for a wrong dimension or a non-finite point.
[[nodiscard]] ProjectionResult project_to_surface(const Surface& surface, const VectorIn& x,
                                                  const ProjectionOptions& options = {});

/// The same for a batch, in place (d x n), one visit of the evaluator a step for all points of a block still moving.
/// Never throws for the mathematics: `converged(j)` is false where a point ran into a singularity, was not finite or
/// went too far; such a point is left where it was. `normals`, when not null, is resized to d k x n and receives
/// orthonormal bases of the normal space (for k = 1: grad F / |grad F|), zero where not converged. A point's result
/// does not depend on the others.
Eigen::Array<bool, Eigen::Dynamic, 1> project_to_surface(Evaluator& evaluator, Index dim, Index codim,
                                                         Eigen::Ref<Eigen::MatrixXd> points,
                                                         const ProjectionOptions& options = {},
                                                         Eigen::MatrixXd* normals = nullptr);

}  // namespace taut
