#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <string_view>

#include "taut/core/types.hpp"

namespace taut {

/// Why the path found may not be the shortest, or not the only shortest one.
enum class Doubt : std::uint8_t {
  beyond_window,       ///< the surface goes on beyond the box that was looked through, and shorter ways may, too
  start_failed,        ///< a way promised a shorter path, and no geodesic was found along it
  sheets_not_told,     ///< cells cannot tell the sheets of the surface apart: found by walks from both ends
  cells_spent,         ///< as many cells as may grow did not lead from one end to the other: found by walks
  coarse_cells,        ///< the cells are coarser than the surface bends, and miss ways
  sharp_bends,         ///< next to the path the surface bends within a cell
  edges_not_searched,  ///< over edges none was looked for: they are too many, or not by this method or march
  edges_failed,        ///< over the edges of the surface no way was found, only one on smooth faces
  budget_spent,        ///< the work allowed was used up before every way was looked at
  random_search,       ///< too many dimensions for cells: other ways were looked for at random
  rivals_not_sought,   ///< no other ways round were looked for
};

inline constexpr int kNumDoubts = 11;

/// The name used in JSON and messages: "coarse_cells", ...
[[nodiscard]] constexpr std::string_view to_string(Doubt doubt) {
  switch (doubt) {
    case Doubt::beyond_window: return "beyond_window";
    case Doubt::start_failed: return "start_failed";
    case Doubt::sheets_not_told: return "sheets_not_told";
    case Doubt::cells_spent: return "cells_spent";
    case Doubt::coarse_cells: return "coarse_cells";
    case Doubt::sharp_bends: return "sharp_bends";
    case Doubt::edges_not_searched: return "edges_not_searched";
    case Doubt::edges_failed: return "edges_failed";
    case Doubt::budget_spent: return "budget_spent";
    case Doubt::random_search: return "random_search";
    case Doubt::rivals_not_sought: return "rivals_not_sought";
  }
  return "unknown";
}

/// A set of doubts.
class Doubts {
 public:
  constexpr Doubts() = default;
  constexpr Doubts(std::initializer_list<Doubt> doubts) {
    for (const Doubt doubt : doubts) add(doubt);
  }

  [[nodiscard]] constexpr bool any() const { return bits_ != 0; }
  [[nodiscard]] constexpr bool has(Doubt doubt) const { return (bits_ & bit(doubt)) != 0; }
  /// Is one of those in both.
  [[nodiscard]] constexpr bool has_any(Doubts others) const { return (bits_ & others.bits_) != 0; }
  constexpr void add(Doubt doubt) { bits_ |= bit(doubt); }
  constexpr void add(Doubts others) { bits_ |= others.bits_; }
  constexpr void remove(Doubt doubt) { bits_ &= ~bit(doubt); }
  /// visit(doubt) for each, in the order of the enumeration.
  template <class Visit>
  constexpr void for_each(const Visit& visit) const {
    for (int i = 0; i < kNumDoubts; ++i) {
      if (has(static_cast<Doubt>(i))) visit(static_cast<Doubt>(i));
    }
  }

  friend constexpr bool operator==(Doubts, Doubts) = default;

 private:
  static constexpr std::uint32_t bit(Doubt doubt) { return std::uint32_t{1} << static_cast<std::uint32_t>(doubt); }
  std::uint32_t bits_ = 0;
};

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
