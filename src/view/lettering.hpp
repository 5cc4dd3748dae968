#pragma once

#include <optional>
#include <string>
#include <vector>

#include "view/camera.hpp"
#include "view/legend.hpp"
#include "view/stage.hpp"

namespace taut::detail {

enum class Anchor { start, end };

/// A line of text; x, y: where its base line begins (or ends).
struct Label {
  double x = 0;
  double y = 0;
  std::string words;
  double size = 14;  ///< pixels
  Colour colour;
  bool bold = false;
  bool halo = false;  ///< a white rim, over the scene
  Anchor anchor = Anchor::start;
};

/// A mark of the legend: kMarkWidth wide, from (x, y) to the right.
struct Mark {
  double x = 0;
  double y = 0;
  LegendMark kind = LegendMark::line;
  Colour colour;
};
inline constexpr double kMarkWidth = 22;

/// The colours of a scalar, upright.
struct ColourBar {
  double x = 0;
  double y = 0;
  double width = 16;
  double height = 0;
  std::vector<double> ticks;  ///< y of each
};

/// What stands around the scene, pixels; PNG and SVG show the same.
struct Lettering {
  std::vector<Label> labels;
  std::vector<Mark> marks;
  std::optional<ColourBar> bar;
  // Room for the scene.
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};
Lettering letter(const Stage& stage, int width, int height);

/// The names of the points, beside them, left of `width`. Names of points that are seen in one place are joined.
std::vector<Label> point_labels(const Stage& stage, const Camera& camera, double point_radius, double width);

}  // namespace taut::detail
