#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "taut/core/types.hpp"

namespace taut {

/// The Cartesian cells around a surface: integer cells c in Z^d, cell c covering origin + size * [c, c + 1]. A value; the
/// cells stand in the order they were found, and a flat hash finds one by its coordinates. At most 4 d + 12 bytes a cell.
class CellGrid {
 public:
  static constexpr Index kNone = -1;

  CellGrid(Vector origin, double size);

  [[nodiscard]] Index dim() const { return origin_.size(); }
  [[nodiscard]] Index num_cells() const;
  [[nodiscard]] double size() const { return size_; }           ///< h, model units
  [[nodiscard]] const Vector& origin() const { return origin_; }

  /// The integer coordinates of cell i (d of them).
  [[nodiscard]] std::span<const std::int32_t> cell(Index i) const;
  [[nodiscard]] Vector centre(Index i) const;
  /// The cell that holds x, present or not.
  void cell_of(const VectorIn& x, std::span<std::int32_t> cell) const;

  /// Index of a cell, or kNone.
  [[nodiscard]] Index find(std::span<const std::int32_t> cell) const;
  /// Adds a cell if it is not there. Returns its index.
  Index insert(std::span<const std::int32_t> cell);

  [[nodiscard]] std::size_t bytes() const;

 private:
  Vector origin_;
  double size_;
  std::vector<std::int32_t> coordinates_;  // d per cell
  std::vector<std::uint32_t> slots_;       // open addressing: index + 1, 0 = free
};

}  // namespace taut
