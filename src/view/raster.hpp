#pragma once

#include <cstdint>
#include <vector>

#include "taut/core/context.hpp"
#include "view/camera.hpp"
#include "view/stage.hpp"

namespace taut::detail {

/// Pixels, row by row from the top: red, green, blue (sRGB, not multiplied by alpha) and alpha, 0..255.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;
};

/// How near the meshes come in each pixel, for asking whether a point is hidden; -infinity where there is nothing.
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<float> nearness;

  /// Whether a point seen there lies behind the meshes.
  [[nodiscard]] bool hides(const Seen& point) const;
};

struct RenderOptions {
  int width = 0;
  int height = 0;
  bool paths = true;      ///< draw paths and end points (an SVG draws them as vectors instead)
  double path_width = 6;  ///< pixels
};

/// Draws a stage with a depth buffer, 3 x 3 samples a pixel, over a transparent background. A path is a tube, in front
/// of a surface it lies on; where something else hides it, it shows through faintly.
Image render(const Stage& stage, const Camera& camera, const RenderOptions& options, const Context& context);

DepthImage render_depth(const Stage& stage, const Camera& camera, int width, int height);

/// How far towards the viewer a path is lifted off the mesh before asking what hides it, in radii of the scene.
inline constexpr double kPathLift = 0.012;

}  // namespace taut::detail
