#pragma once

#include <string>

#include "taut/view/scene.hpp"

namespace taut {

/// One self-contained page, in WebGL2, that opens from a file without a network: the surface to turn, zoom and move
/// with mouse, touch or keys, with the paths drawn over it. Numbers are embedded as float32 and uint32. Where there is
/// no WebGL2 or no JavaScript it shows a still picture instead. Deterministic: equal scenes give equal bytes. Throws
/// InvalidArgument for a scene that cannot be drawn (nothing in it, unequal dimensions, indices out of range,
/// coordinates that are not finite).
[[nodiscard]] std::string to_html(const Scene& scene);

/// Writes that page. The file appears whole or not at all. Throws IoError too.
void write_html(const std::string& path, const Scene& scene);

struct PictureOptions {
  int width = 1200;  ///< pixels, 16..16384
  int height = 800;  ///< pixels, 16..16384
  /// From where to look, as in Scene::towards_viewer, which it overrides; zero = as the scene says.
  Eigen::Vector3d towards_viewer = Eigen::Vector3d::Zero();
  bool text = true;      ///< title, legend, colour bar, labels and caption; false: the scene alone fills the picture
  bool isolines = true;  ///< lines of equal value on a surface coloured by a scalar
  int threads = 0;       ///< 0 = all cores; changes nothing but the time
};

/// The scene as a PNG file's bytes: shaded surface, cells, paths with their hidden parts showing through faintly, end
/// points, and the text around them. White background. Deterministic for one version of libpng and zlib. Throws
/// InvalidArgument as `to_html` does.
[[nodiscard]] std::string to_png(const Scene& scene, const PictureOptions& options = {});

/// The scene as an SVG document: the shaded surface and the cells as an embedded image, and over it as vectors the
/// paths (dashed where they are hidden), end points, labels, legend, colour bar, title and caption.
[[nodiscard]] std::string to_svg(const Scene& scene, const PictureOptions& options = {});

/// Write those files. They appear whole or not at all. Throw IoError too.
void write_png(const std::string& path, const Scene& scene, const PictureOptions& options = {});
void write_svg(const std::string& path, const Scene& scene, const PictureOptions& options = {});

}  // namespace taut
