#pragma once

#include "taut/core/types.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// h for a surface in `box`: a few thousand cells, which is enough for a start path. Falls with the dimension, since
/// the number of cells grows like h^-(d - 1).
[[nodiscard]] double cell_size_for_box(const Box& box);

/// h for a surface fitted to samples: as `cell_size_for_box`, and no more than twice the sample spacing, so that layers
/// the samples can tell apart are told apart by the cells.
[[nodiscard]] double cell_size_for_samples(const PointCloud& samples);

}  // namespace taut::detail
