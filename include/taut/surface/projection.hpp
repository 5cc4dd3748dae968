#pragma once

#include <limits>

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct ProjectionOptions {
  /// Stop when |J^+ F| (for k = 1: |F| / |grad F|) is at most this, model units. 0 = as far as rounding allows.
  double tolerance = 0;
  int max_steps = 50;
  /// Largest distance a point may move, model units; farther counts as not converged.
  double max_distance = std::numeric_limits<double>::infinity();
};

struct ProjectionResult {
  Vector point;           ///< d
  double distance = 0;    ///< |point - x|, model units
  double residual = 0;    ///< |J^+ F| at `point`, model units
  int num_steps = 0;
  bool converged = false;
};

/// A nearby surface point, by the paper's Newton-Raphson iteration dp/dt = -F grad F / |grad F|^2 (sec. 4; for k > 1
/// with the pseudo-inverse of J), safeguarded by step halving. Nearby, not always the nearest.
/// Throws SingularPoint when J loses rank where it is needed, InvalidArgument for a non-finite point.
[[nodiscard]] ProjectionResult project_to_surface(const Surface& surface, const VectorIn& x,
                                                  const ProjectionOptions& options = {});

/// The same for a batch, in place (d x n), one visit of the evaluator a step for all points still moving. Never throws for
/// the mathematics: `converged(j)` is false where a point ran into a singularity, was not finite or went too far; such
/// a point is left where it was. `normals`, when not null, receives orthonormal bases of the normal space, d k x n.
Eigen::Array<bool, Eigen::Dynamic, 1> project_to_surface(Evaluator& evaluator, Index dim, Index codim,
                                                         Eigen::Ref<Eigen::MatrixXd> points,
                                                         const ProjectionOptions& options = {},
                                                         Eigen::MatrixXd* normals = nullptr);

}  // namespace taut
