#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "taut/core/types.hpp"

namespace taut {

/// The Cartesian cells around a surface: integer cells c in Z^d, cell c covering the closed box origin + size * [c, c +
/// 1]. A value; the cells stand in the order they were inserted, and a flat hash finds one by its coordinates. At most
/// 40 bytes a cell for d = 3 (12 of coordinates, 4 a hash slot), whatever the growth history; 4 d + 7..14 once trimmed.
class CellGrid {
 public:
  static constexpr Index kNone = -1;
  /// Coordinates are kept within +-kMaxCoordinate, so that neighbours and parents never overflow.
  static constexpr std::int32_t kMaxCoordinate = 1 << 30;
  /// An index takes 32 bits of the hash.
  static constexpr Index kMaxCells = 0xFFFFFFFE;

  /// `origin`: d >= 1 finite numbers, model units; `size` > 0: the edge h. Throws InvalidArgument.
  CellGrid(Vector origin, double size);

  [[nodiscard]] Index dim() const { return origin_.size(); }
  [[nodiscard]] Index num_cells() const { return num_cells_; }
  [[nodiscard]] double size() const { return size_; }  ///< h, model units
  [[nodiscard]] const Vector& origin() const { return origin_; }

  /// The integer coordinates of cell i (d of them). Ends its life at the next insert.
  [[nodiscard]] std::span<const std::int32_t> cell(Index i) const {
    return {coordinates_.data() + i * dim(), static_cast<std::size_t>(dim())};
  }
  /// The coordinates of all cells, d x n, a cell contiguous.
  [[nodiscard]] std::span<const std::int32_t> coordinates() const { return coordinates_; }
  [[nodiscard]] Vector centre(Index i) const;
  [[nodiscard]] Box box(Index i) const;
  /// Where the faces between cells c - 1 and c stand on an axis: the one expression every box is made of, so that
  /// neighbouring boxes share their faces to the last bit.
  [[nodiscard]] double face(Index axis, std::int32_t c) const { return origin_[axis] + size_ * c; }

  /// The cell that holds x, present or not: face(c) <= x < face(c + 1) on every axis, as computed. Throws
  /// InvalidArgument where x is not finite or farther from the origin than the coordinates reach.
  void cell_of(const VectorIn& x, std::span<std::int32_t> cell) const;
  /// Index of the cell that holds x, or kNone (also where cell_of would throw).
  [[nodiscard]] Index find_point(const VectorIn& x) const;

  /// Index of a cell, or kNone.
  [[nodiscard]] Index find(std::span<const std::int32_t> cell) const { return find(cell.data()); }
  [[nodiscard]] Index find(const std::int32_t* cell) const;
  /// Adds a cell if it is not there. Returns its index. Throws InvalidArgument beyond kMaxCoordinate, OutOfMemory
  /// beyond kMaxCells.
  Index insert(std::span<const std::int32_t> cell) { return insert(cell.data()); }
  Index insert(const std::int32_t* cell);
  void reserve(Index num_cells);

  /// 3^d - 1. Throws InvalidArgument for d > 12, where a list of neighbours makes no sense any more.
  [[nodiscard]] Index num_neighbours() const;
  /// Offset m of 3^d - 1, each entry -1, 0 or 1: m counts through the offsets with the first axis fastest, the cell
  /// itself left out. Offset 3^d - 2 - m is the opposite of offset m.
  void neighbour_offset(Index m, std::span<std::int32_t> offset) const;
  /// Indices of the 3^d - 1 neighbours of cell i, kNone where there is none, in the order of neighbour_offset.
  void neighbours(Index i, std::span<Index> out) const;

  /// The same cells in Morton order (z-curve): neighbours stand close in memory. The canonical order of a complete set.
  [[nodiscard]] CellGrid sorted() const;

  /// Bytes held, unused capacity included.
  [[nodiscard]] std::size_t bytes() const;
  /// Gives unused capacity back.
  void trim();

 private:
  [[nodiscard]] std::size_t slot_of(const std::int32_t* cell) const;
  void rehash(std::size_t num_slots);

  Vector origin_;
  double size_;
  Index num_cells_ = 0;
  std::vector<std::int32_t> coordinates_;  // d per cell
  std::vector<std::uint32_t> slots_;       // open addressing, linear probing: index + 1, 0 = free
};

/// True where a comes before b on the z-curve through Z^d; the last axis counts most.
[[nodiscard]] bool morton_less(std::span<const std::int32_t> a, std::span<const std::int32_t> b);

/// Where Taut puts the origin of a grid of the given cell size around x: the same for all x within 10^8 cells, so that
/// the same size gives the same cells; and off round numbers by a different irrational part of a cell on each axis,
/// since formulas love surfaces that touch or halve cells with round faces, which costs a second layer of cells.
[[nodiscard]] Vector lattice_origin(const VectorIn& x, double size);

}  // namespace taut
