#pragma once

#include <limits>
#include <optional>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/march/distance_field.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

struct MarchOptions {
  MarchMethod method = MarchMethod::convergent;
  /// Stop as soon as the distance at this point (d, on the surface) is final.
  std::optional<Vector> target = std::nullopt;
  /// Leave out what lies farther away than this, model units, >= 0.
  double radius = std::numeric_limits<double>::infinity();
  /// Leave out cells that no path to the target, if there is one, of at most this length leads through, model units.
  /// Convergent marches only.
  double longest = std::numeric_limits<double>::infinity();
};

/// Marches distances from `sources` (d x m surface points, anywhere in the cells) over the cells; lazy cells are grown
/// only where the front passes. Cells that cannot be reached without stepping from one sheet of the surface to another
/// keep the distance infinity: refine the cells then.
///
/// Properties: 0 at a source; distance >= |p - q|; with several sources the minimum of the single fields; the same
/// bits for the same input. Accuracy: docs/measured/march.md. Cost: O(N 3^d + N log N); (d + 3) doubles a cell.
/// Throws InvalidArgument when a source or target has the wrong dimension, is not finite, no cell lies around a
/// source, or the radius is negative; SingularPoint when the surface is singular there; OutOfMemory, Cancelled.
[[nodiscard]] DistanceField march(const Surface& surface, SurfaceCells& cells, const PointsIn& sources,
                                  const MarchOptions& options = {}, const Context& context = {});

}  // namespace taut
