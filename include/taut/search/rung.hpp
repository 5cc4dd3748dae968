#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "taut/core/types.hpp"
#include "taut/search/doubt.hpp"

namespace taut {

/// One way to look for the shortest path. The search goes from cheap ones to dear ones until no doubt is left.
enum class Rung : std::uint8_t {
  faces,   ///< over a graph of all faces, edges and borders of a surface that is not smooth
  table,   ///< starts from a table of distances between landmarks
  fields,  ///< distances marched from both ends over cells of one size
  walks,   ///< without cells, step by step from both ends
  closer,  ///< finer cells in the part of the box that shorter paths can visit
  wider,   ///< a wider window on a surface without end
  fan,     ///< all geodesics from the start, as far as the path is long
  border,  ///< along the border of a domain
};

/// The name used in JSON: "fields", ...
[[nodiscard]] constexpr std::string_view to_string(Rung rung) {
  switch (rung) {
    case Rung::faces: return "faces";
    case Rung::table: return "table";
    case Rung::fields: return "fields";
    case Rung::walks: return "walks";
    case Rung::closer: return "closer";
    case Rung::wider: return "wider";
    case Rung::fan: return "fan";
    case Rung::border: return "border";
  }
  return "unknown";
}

/// What one rung came to.
struct RungReport {
  Rung rung = Rung::fields;
  double cell = 0;      ///< h of the cells it looked at, model units; 0 = none
  Index num_cells = 0;  ///< of those
  /// Of the best path known after it, model units; NaN = none.
  double length = std::numeric_limits<double>::quiet_NaN();
  Doubts doubts = {};  ///< that it left
};

}  // namespace taut
