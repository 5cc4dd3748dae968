#pragma once

#include <cstdint>
#include <initializer_list>
#include <string_view>

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

}  // namespace taut
