#pragma once

#include <string>
#include <vector>

#include "view/stage.hpp"

namespace taut::detail {

enum class LegendMark { line, dashes, square };

struct LegendLine {
  LegendMark mark = LegendMark::line;
  Colour colour;
  std::string text;   ///< "geodesic"
  std::string value;  ///< "length 1.5708", "20 paths, lengths 1 to 2"
};

/// A line for each group of paths of one label and colour, and one for the cells; beyond eight lines the rest is summed
/// up in the last.
std::vector<LegendLine> make_legend(const Stage& stage);

}  // namespace taut::detail
