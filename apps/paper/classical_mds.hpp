#pragma once

#include "taut/core/types.hpp"

namespace taut::paper {

/// Points whose mutual distances are as given, as far as that is possible (Torgerson 1952): what Elad and Kimmel's
/// bending invariant and Isomap end with.
struct Embedding {
  Points points;       ///< dim x n, centred at 0, the coordinate of most spread first
  Vector eigenvalues;  ///< n, largest first, of the doubly centred matrix -1/2 J D^2 J
  /// sqrt(sum (d_ij - |x_i - x_j|)^2 / sum d_ij^2)
  double stress = 0;
};

/// `distances`: n x n, symmetric, zero on the diagonal; n > dim >= 1.
[[nodiscard]] Embedding classical_mds(const Eigen::MatrixXd& distances, Index dim);

/// `points` turned, mirrored and moved so that they lie as near to `target` as can be (both dim x n); the root mean
/// square distance that is left (Kabsch 1976).
struct Alignment {
  Points points;
  double rms = 0;
};
[[nodiscard]] Alignment align(const PointsIn& points, const PointsIn& target);

}  // namespace taut::paper
