#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "march/stencil.hpp"
#include "taut/cells/cell_grid.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// The present cells one step away from a place on the grid, as a path that keeps to the cells may take it.
class CellSteps {
 public:
  enum class Over {
    faces,    ///< to cells that steps across faces lead to, at most one an axis, each onto a present cell: not past a
              ///< corner to another sheet. Above kMostDiagonalDim only across one face.
    corners,  ///< to all cells that touch
  };
  /// Beyond it the 3^d - 1 cells around a cell are too many to go through.
  static constexpr Index kMostDiagonalDim = 6;

  CellSteps(const CellGrid& grid, Over over)
      : grid_(grid), over_(over), d_(static_cast<std::size_t>(grid.dim())), neighbour_(d_) {
    // order_ stays empty: around() then steps across single faces.
    if (grid.dim() > kMostDiagonalDim && over == Over::faces) return;
    // Offsets with fewer steps first, so that what an offset is reached over has been looked at before it.
    const auto size = static_cast<std::size_t>(block_size(grid.dim()));
    std::size_t power = 1;
    for (std::size_t a = 0; a < d_; ++a, power *= 3) powers_.push_back(power);
    for (std::size_t code = 0; code < size; ++code) order_.push_back(code);
    std::ranges::stable_sort(order_, {}, [&](std::size_t code) { return num_steps(code); });
    reached_.resize(size);
  }

  /// Indices of such cells around integer coordinates `centre`, its own cell first where it is present. The span lives
  /// until the next call.
  [[nodiscard]] std::span<const Index> around(std::span<const std::int32_t> centre) {
    found_.clear();
    if (order_.empty()) {
      add_faces(centre);
      return found_;
    }
    for (const std::size_t code : order_) {
      std::uint8_t& reached = reached_[code];
      // Marked before the cell is looked up: where it is absent, nothing is reached over it either.
      reached = over_ == Over::corners || num_steps(code) == 0 || is_reached_over_a_face(code) ? 1 : 0;
      if (reached == 0) continue;
      for (std::size_t a = 0; a < d_; ++a) neighbour_[a] = centre[a] + step(code, a);
      const Index i = grid_.find(neighbour_);
      if (i != CellGrid::kNone) {
        found_.push_back(i);
      } else if (num_steps(code) > 0) {
        reached = 0;
      }
    }
    return found_;
  }

 private:
  /// -1, 0 or 1: the step along an axis of the offset with this code in base 3.
  [[nodiscard]] std::int32_t step(std::size_t code, std::size_t axis) const {
    const auto digit = static_cast<std::int32_t>(code / powers_[axis] % 3);
    return digit == 2 ? -1 : digit;
  }
  [[nodiscard]] int num_steps(std::size_t code) const {
    int count = 0;
    for (std::size_t a = 0; a < d_; ++a) count += step(code, a) != 0 ? 1 : 0;
    return count;
  }
  [[nodiscard]] bool is_reached_over_a_face(std::size_t code) const {
    for (std::size_t a = 0; a < d_; ++a) {
      const std::size_t digit = code / powers_[a] % 3;
      if (digit != 0 && reached_[code - digit * powers_[a]] != 0) return true;
    }
    return false;
  }
  void add(std::span<const std::int32_t> cell) {
    const Index i = grid_.find(cell);
    if (i != CellGrid::kNone) found_.push_back(i);
  }
  void add_faces(std::span<const std::int32_t> centre) {
    std::ranges::copy(centre, neighbour_.begin());
    add(neighbour_);
    for (std::size_t a = 0; a < d_; ++a) {
      for (const std::int32_t side : {-1, 1}) {
        neighbour_[a] = centre[a] + side;
        add(neighbour_);
      }
      neighbour_[a] = centre[a];
    }
  }

  const CellGrid& grid_;
  Over over_;
  std::size_t d_;
  std::vector<std::int32_t> neighbour_;
  std::vector<std::size_t> powers_;    // of 3
  std::vector<std::size_t> order_;     // offsets by their code, 0 = the cell itself; empty = across faces only
  std::vector<std::uint8_t> reached_;  // by code
  std::vector<Index> found_;
};

}  // namespace taut::detail
