#pragma once

#include <vector>

#include "taut/core/context.hpp"
#include "view/camera.hpp"
#include "view/image.hpp"
#include "view/stage.hpp"

namespace taut::detail {

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
  bool isolines = true;   ///< of the scalar that colours a mesh
  double path_width = 6;  ///< pixels
};

/// Draws a stage with a depth buffer, 3 x 3 samples a pixel, over a transparent background. A path is a tube, in front
/// of a surface it lies on; where something else hides it, it shows through faintly. Cells are a translucent skin
/// between the surface and the paths, which no cell hides.
Image render(const Stage& stage, const Camera& camera, const RenderOptions& options, const Context& context);

DepthImage render_depth(const Stage& stage, const Camera& camera, int width, int height);

/// How far towards the viewer a path is lifted off the mesh before asking what hides it, in radii of the scene.
inline constexpr double kPathLift = 0.012;

/// The dashes of a failed path and the gaps between them, in radii of the scene.
inline constexpr double kDash = 0.035;
inline constexpr double kDashGap = 0.035;

}  // namespace taut::detail
