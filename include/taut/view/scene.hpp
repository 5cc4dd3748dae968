#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/mesh.hpp"
#include "taut/core/types.hpp"

namespace taut {

/// sRGB, each channel 0..1.
struct Colour {
  float red = 0;
  float green = 0;
  float blue = 0;

  /// 0xRRGGBB
  [[nodiscard]] static constexpr Colour hex(std::uint32_t rgb) {
    return {static_cast<float>(rgb >> 16 & 255) / 255, static_cast<float>(rgb >> 8 & 255) / 255,
            static_cast<float>(rgb & 255) / 255};
  }
  friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// The colours that paths take in turn, six of them: for those that share one on purpose.
[[nodiscard]] Colour path_colour(std::size_t index);

/// A surface to look at (scenes in space only).
struct SceneMesh {
  TriangleMesh mesh;  ///< without normals they are made from the faces
  std::string name = "surface";
  std::optional<Colour> colour = std::nullopt;  ///< unset = chosen
  /// Name of one of `mesh.scalars` that colours the surface; empty = the plain colour. NaN values stay plain.
  std::string coloured_by = {};
  Points colours = Points(3, 0);  ///< 3 x n sRGB, one a vertex, or 3 x 0
};

/// Thin lines: the curve F = 0 in the plane, a grid, a frame.
struct SceneLines {
  Points vertices = {};       ///< d x n
  Eigen::Matrix2Xi segments;  ///< 2 x m, indices into `vertices`
  std::string name = {};
  std::optional<Colour> colour = std::nullopt;
};

/// A curve drawn thick: a geodesic. Paths of the same label and colour share a line of the legend.
struct ScenePath {
  Points points = {};      ///< d x n, n >= 2, in order
  std::string label = {};  ///< for the legend; may be empty
  /// Unset = chosen: another for each path, amber for one that failed.
  std::optional<Colour> colour = std::nullopt;
  /// Model units, for the legend; NaN = the length of the polyline.
  double length = std::numeric_limits<double>::quiet_NaN();
  double width = 1;     ///< in usual widths; many paths are drawn thinner by themselves
  bool failed = false;  ///< not the path that was asked for: dashed
};

struct ScenePoint {
  Vector position;         ///< d
  std::string label = {};  ///< drawn beside it; may be empty
  std::optional<Colour> colour = std::nullopt;
  double size = 1;  ///< in usual sizes
};

/// Equal cubes on one lattice (squares for d = 2): the cells around a surface, drawn as a translucent skin.
struct SceneCells {
  Points centres;                               ///< d x n
  double size = 0;                              ///< edge length, model units
  std::string label = "cells";                  ///< for the legend
  std::optional<Colour> colour = std::nullopt;  ///< unset = green
  /// False: pictures leave them out, and the page shows them when asked.
  bool shown = true;
};

/// One line of the panel of facts: "length", "1.570796327".
struct SceneFact {
  std::string name = {};
  std::string value = {};
};

/// Everything a picture or page shows. All parts have the same d >= 2. d = 2 is drawn flat; of d > 3 there are only
/// paths, points and cells' centres, seen in the space of the first three principal components of the paths, which the
/// caption says.
struct Scene {
  std::string title = {};
  std::vector<SceneMesh> meshes;
  std::vector<SceneLines> lines;
  std::vector<ScenePath> paths;
  std::vector<ScenePoint> points;
  std::optional<SceneCells> cells;
  std::vector<SceneFact> facts;
  std::vector<std::string> caption;
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< which way is up in the picture (d = 3)
  /// From where to look, as a direction from the scene to the viewer (`view_direction` makes one of angles); zero =
  /// chosen so that the paths are seen best, from the side that the surface's normals face.
  Eigen::Vector3d towards_viewer = Eigen::Vector3d::Zero();
};

/// The direction to look from at an azimuth and an elevation, degrees. The azimuth is counted from the x axis (from the
/// y axis where x points up), counter-clockwise seen from above; the elevation from the horizon upwards, -90..90. So
/// with z up (0, 0) looks from +x, (90, 0) from +y, (0, 90) from above. Throws InvalidArgument for angles out of range
/// or not finite, and for `up` = 0.
[[nodiscard]] Eigen::Vector3d view_direction(double azimuth, double elevation,
                                             const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

}  // namespace taut
