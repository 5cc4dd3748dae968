#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "taut/core/types.hpp"

namespace taut {

/// What stands between the two points where no path was found, or the one found is no geodesic.
struct Obstacle {
  enum class Kind : std::uint8_t {
    none,
    apart,             ///< the points lie on different components: bounds of the cells prove it for the box that was
                       ///< looked through (on a fitted surface they are a careful estimate)
    apart_by_fan,      ///< they do: all geodesics from the start, followed to their end, meet the end nowhere
    apart_by_walks,    ///< they seem to: without cells, random searches from both ends do not meet
    no_way,            ///< no way was found, for none of the reasons below; that there is none is not proved
    sheets_not_told,   ///< cells cannot tell the sheets of the surface apart, or the points lie on different components
    coarse_cells,      ///< the cells are coarser than the surface bends
    narrow_gap,        ///< near `place` parts of the surface come within `size` (model units) of each other
    singular_between,  ///< near `place` the gradient falls to nothing
    singular_end,      ///< one of the points, `place`, is a singular one: the equations depend on each other there
    corner,            ///< the normal jumps at one of the points, `place`
    crease,            ///< near `place` the normal turns by `size` (radians) within a cell
    cells_spent,       ///< as many cells as may grow did not lead from one end to the other
    no_geodesic,       ///< ways were found, but no geodesic: Geodesic::reason says why; `place`, if any, says where
    jumped,            ///< the correction has left the way it started from, which is `size` (model units) long
    loose_ends,        ///< the curve found does not join the points: an error in this library
    faces,             ///< ways over edges were found, but none was made a geodesic
    contracts,         ///< a loop contracts to where the surface is singular, or thinner than cells can tell
    refused,           ///< the points cannot be asked for, in a batch: where one alone would throw
  };
  Kind kind = Kind::none;
  Vector place = {};  ///< d, or empty
  double size = std::numeric_limits<double>::quiet_NaN();
};

/// The name used in JSON and messages: "singular_between", ...
[[nodiscard]] constexpr std::string_view to_string(Obstacle::Kind kind) {
  switch (kind) {
    case Obstacle::Kind::none: return "none";
    case Obstacle::Kind::apart: return "apart";
    case Obstacle::Kind::apart_by_fan: return "apart_by_fan";
    case Obstacle::Kind::apart_by_walks: return "apart_by_walks";
    case Obstacle::Kind::no_way: return "no_way";
    case Obstacle::Kind::sheets_not_told: return "sheets_not_told";
    case Obstacle::Kind::coarse_cells: return "coarse_cells";
    case Obstacle::Kind::narrow_gap: return "narrow_gap";
    case Obstacle::Kind::singular_between: return "singular_between";
    case Obstacle::Kind::singular_end: return "singular_end";
    case Obstacle::Kind::corner: return "corner";
    case Obstacle::Kind::crease: return "crease";
    case Obstacle::Kind::cells_spent: return "cells_spent";
    case Obstacle::Kind::no_geodesic: return "no_geodesic";
    case Obstacle::Kind::jumped: return "jumped";
    case Obstacle::Kind::loose_ends: return "loose_ends";
    case Obstacle::Kind::faces: return "faces";
    case Obstacle::Kind::contracts: return "contracts";
    case Obstacle::Kind::refused: return "refused";
  }
  return "unknown";
}

}  // namespace taut
