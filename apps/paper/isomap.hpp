#pragma once

#include "taut/core/types.hpp"

namespace taut::paper {

/// Distances of Isomap (Tenenbaum et al. 2000): shortest walks over the graph that joins every point with its nearest
/// `neighbours`. From column `sources(i)` of `points` (d x n) to all: n x sources.size(); infinity where no walk leads.
[[nodiscard]] Eigen::MatrixXd isomap_distances(const PointsIn& points, Index neighbours,
                                               const Eigen::VectorX<Index>& sources);

}  // namespace taut::paper
