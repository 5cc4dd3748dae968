#pragma once

#include <optional>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut {

/// Heights on a rectangular grid: a terrain, a scanned plate, a grey image. Sample (i, j) stands at
/// (x0 + i pixel_x, y0 + j pixel_y).
struct HeightField {
  Index columns = 0;            ///< samples along x
  Index rows = 0;               ///< samples along y
  std::vector<double> heights;  ///< one a sample, i runs fastest; NaN = nothing was measured there
  double x0 = 0;
  double y0 = 0;
  double pixel_x = 1;  ///< model units
  double pixel_y = 1;
};

struct HeightOptions {
  /// z = height * z_scale.
  double z_scale = 1;
  /// Samples of exactly this height were not measured. NaN never was.
  std::optional<double> no_data = std::nullopt;
};

/// The graph z = s(x, y) of the C^2 bicubic spline s that passes through the heights, with not-a-knot ends: its error
/// is of fourth order in the pixels up to the border. F = z - s(x, y), negative below. The surface ends with the grid,
/// and before samples that were not measured, along a smooth curve; `context.note` tells how many those are.
/// Value, derivatives and bounds take O(1) a point or box; 16 bytes a sample, 32 with samples missing.
///
/// Throws InvalidArgument for fewer than 4 samples along an axis, a number of heights that does not fit, pixels or a
/// scale that are 0 or not finite, infinite heights, and where fewer than half of the samples were measured.
[[nodiscard]] Surface height_surface(const HeightField& field, const HeightOptions& options = {},
                                     const Context& context = {});

/// z of a surface that `height_surface` made above (x, y); none for other surfaces, and outside of the grid.
[[nodiscard]] std::optional<double> height_at(const Surface& surface, double x, double y);

}  // namespace taut
