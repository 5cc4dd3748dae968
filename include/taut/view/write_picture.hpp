#pragma once

#include <string>

#include "taut/view/scene.hpp"

namespace taut {

struct PictureOptions {
  int width = 1200;  ///< pixels, 16..16384
  int height = 800;  ///< pixels, 16..16384
  /// From where to look, as a direction from the scene to the viewer; zero = chosen so that the paths are seen best.
  Eigen::Vector3d towards_viewer = Eigen::Vector3d::Zero();
  int threads = 0;  ///< 0 = all cores; changes nothing but the time
};

/// The scene as a PNG file's bytes: shaded surface, paths with their hidden parts showing through faintly, end points;
/// no text. White background. Deterministic. Throws InvalidArgument as `to_html` does.
[[nodiscard]] std::string to_png(const Scene& scene, const PictureOptions& options = {});

/// The scene as an SVG document: the shaded surface as an embedded image, and over it as vectors the paths (dashed
/// where they are hidden), end points, labels, legend, colour bar, title and caption.
[[nodiscard]] std::string to_svg(const Scene& scene, const PictureOptions& options = {});

/// Write those files. They appear whole or not at all. Throw IoError too.
void write_png(const std::string& path, const Scene& scene, const PictureOptions& options = {});
void write_svg(const std::string& path, const Scene& scene, const PictureOptions& options = {});

}  // namespace taut
