#pragma once

#include <vector>

#include "taut/cells/surface_cells.hpp"
#include "taut/core/context.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// How far distances marched on coarser cells are from those marched on finer ones: from a few points to everywhere.
class MarchCheck {
 public:
  /// Marches on the finer cells. Throws as `march` does.
  MarchCheck(const Surface& surface, SurfaceCells& finer, const Context& context);

  /// The given part of the distances on `coarser` cells is wrong by less than this, relative; infinity where ways are
  /// missing, or lead where none is.
  [[nodiscard]] double quantile(SurfaceCells& coarser, double part) const;

 private:
  const Surface& surface_;
  const Context& context_;
  const SurfaceCells& finer_;
  std::vector<DistanceField> fields_;
};

}  // namespace taut::detail
