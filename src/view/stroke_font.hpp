#pragma once

#include <string_view>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Text as lines to draw with a round pen, for pictures that bring no fonts of their own.
struct TextStrokes {
  std::vector<std::vector<Eigen::Vector2d>> lines;  ///< pixels, x right and y down; the text begins at the origin
  double width = 0;                                 ///< of the text, pixels
};

/// The strokes of a text of this font size in pixels (capitals are 0.72 of it high), its base line at y = 0. Characters
/// beyond ASCII become a small box.
[[nodiscard]] TextStrokes stroke_text(std::string_view utf8, double size);

}  // namespace taut::detail
