#pragma once

#include <string>
#include <vector>

#include "taut/view/scene.hpp"

namespace taut::detail {

/// A scene made ready to draw: checked, in three dimensions, colours and normals filled in.
struct StageMesh {
  Eigen::Matrix3Xf positions;
  Eigen::Matrix3Xf normals;
  Eigen::Matrix3Xi faces;
  Eigen::VectorXf scalar;    ///< one a vertex, or none
  Eigen::Matrix3Xf colours;  ///< one a vertex, or none
  Colour colour;
  std::string name;
};

struct StageLines {
  Eigen::Matrix3Xf positions;
  Eigen::Matrix2Xi segments;
  Colour colour;
  std::string name;
};

struct StagePath {
  Eigen::Matrix3Xf positions;
  Colour colour;
  std::string label;
  double length = 0;
  double width = 1;  ///< in usual widths
  bool failed = false;
};

struct StagePoint {
  Eigen::Vector3f position;
  Colour colour;
  std::string label;
  double size = 1;  ///< in usual sizes
};

struct Stage {
  bool flat = false;  ///< d = 2: looked at from +z, without perspective
  std::vector<StageMesh> meshes;
  std::vector<StageLines> lines;
  std::vector<StagePath> paths;
  std::vector<StagePoint> points;
  Eigen::Matrix3Xf cell_centres;
  float cell_size = 0;  ///< 0 = draw the centres as points
  Colour cell_colour;
  std::string cell_label;
  bool cells_shown = false;  ///< in pictures, and in the page from the start
  std::string scalar_name;   ///< empty = no mesh is coloured by a scalar
  double scalar_min = 0;
  double scalar_max = 1;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< positions are relative to it: the middle of everything
  double radius = 1;                                 ///< of a ball about the origin round everything
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d towards_viewer = Eigen::Vector3d::Zero();  ///< zero = to be chosen
  std::string title;
  std::vector<std::string> caption;
};

/// A path in pieces with gaps between them, as a failed one is drawn; lengths in model units.
std::vector<Eigen::Matrix3Xf> dashes_of(const Eigen::Matrix3Xf& polyline, double dash, double gap);

/// Are lines of equal value drawn on a mesh coloured by a scalar? Not where the scene brings its own, by that name.
bool draws_isolines(const Stage& stage);

/// Throws InvalidArgument for a scene that cannot be drawn.
Stage make_stage(const Scene& scene);

/// A step of 1, 2 or 5 times a power of ten that divides `range` into about `count` parts.
double nice_step(double range, int count);

/// "1.5708": `digits` significant digits, no trailing zeros.
std::string format_number(double value, int digits);

}  // namespace taut::detail
