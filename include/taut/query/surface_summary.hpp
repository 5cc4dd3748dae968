#pragma once

#include <string>
#include <vector>

#include "taut/core/box.hpp"
#include "taut/core/context.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// What a surface is, before asking it anything.
struct SurfaceSummary {
  std::string kind;  ///< "formula", "rbf", "callback"
  Index dim = 0;
  Index codim = 0;
  // In more than 6 dimensions there are no cells: then these stay empty.
  Box box;          ///< the cells' box: where the surface was found
  double cell = 0;  ///< h, model units
  Index num_cells = 0;
  std::vector<Index> components;  ///< cells of each connected component, largest first
  Index num_samples = 0;
  double sample_rms = 0;  ///< of |F| / |grad F| over the samples, model units
  double sample_max = 0;
};

/// Looks at the surface on cells of size `cell` (0 = chosen). Throws EmptySurface, OutOfMemory,
/// Cancelled; SingularPoint, naming the equations, where they depend on each other all over the surface.
[[nodiscard]] SurfaceSummary summarise(const Surface& surface, double cell = 0, const Context& context = {});

}  // namespace taut
