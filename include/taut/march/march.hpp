#pragma once

#include <optional>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

enum class MarchMethod {
  convergent,  ///< default
  axis,        ///< the paper's: fast marching with axis neighbours on exactly the surface's cells; biased (docs/march.md)
  dijkstra,
};

struct MarchOptions {
  MarchMethod method = MarchMethod::convergent;
  /// Stop as soon as the distance at this point is final.
  std::optional<Vector> target;
};

/// Distances from sources on the cells.
struct DistanceField {
  Vector distance;  ///< n, model units; infinity where not reached (or not needed for `target`)
  // ... what descent needs
};
[[nodiscard]] DistanceField march(const Surface& surface, SurfaceCells& cells, const PointsIn& sources, const MarchOptions& options = {}, const Context& context = {});

/// The polyline (d x m) from `target` down the field to the nearest source, returned from source to target, ends exact.
/// Empty (d x 0) when the target was not reached.
[[nodiscard]] Points descend(const SurfaceCells& cells, const DistanceField& field, const VectorIn& target);

}  // namespace taut
