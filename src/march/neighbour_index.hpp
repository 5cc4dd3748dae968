#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "march/tangent_coordinates.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// A neighbour index of some dimension.
struct AnyNeighbourIndex {
  AnyNeighbourIndex() = default;
  AnyNeighbourIndex(const AnyNeighbourIndex&) = delete;
  AnyNeighbourIndex& operator=(const AnyNeighbourIndex&) = delete;
  virtual ~AnyNeighbourIndex() = default;
};

/// Finds the valid neighbours of cells faster than the grid's own hash: cells are filed in blocks of 2^b cells a side,
/// and the 3^d cells around one lie in a few blocks, so there are few look-ups: 2 to 4 on average for d = 3 instead
/// of 26. About 13 bytes a cell for d = 3.
template <int D>
class NeighbourIndex final : public AnyNeighbourIndex {
 public:
  explicit NeighbourIndex(const SurfaceCells& cells) : cells_(cells), d_(cells.grid().dim()) {
    slots_.assign(kMinSlots, kNoBlock);
    for (Index axis = 0; axis < dim(); ++axis) {
      shift_[axis] = block_size_;
      block_size_ += side_bits(axis);
    }
    for (Index axis = 0; axis < dim(); ++axis) {
      for (std::int32_t c = 0; c < side(axis); ++c) {
        for (std::int32_t near = c - 1; near <= c + 1; ++near) {
          // Relative to the block of c - 1, the first of the three coordinates. Shifts round down, below zero as well.
          const std::int32_t block = (near >> side_bits(axis)) - ((c - 1) >> side_bits(axis));
          rows_[axis][c].places[block] |= places_at(near, axis);
        }
      }
    }
    update();
  }

  /// Files the cells that came since.
  void update() {
    const Index n = cells_.num_cells();
    for (; num_filed_ < n; ++num_filed_) {
      if (!cells_.valid(num_filed_)) continue;
      const std::int32_t* cell = cells_.grid().cell(num_filed_).data();
      std::int32_t block[kMaxDim];
      std::size_t place = 0;
      for (Index axis = 0; axis < dim(); ++axis) {
        block[axis] = cell[axis] >> side_bits(axis);
        place |= local(cell[axis], axis);
      }
      const std::size_t b = file_block(block);
      entries_[(b << block_size_) | place] = static_cast<std::uint32_t>(num_filed_);
      blocks_[b].present |= std::uint64_t{1} << place;
    }
  }

  /// The valid cells around cell i in a fixed order, cell i among them: in `found`.
  void around(Index i, std::vector<Index>& found) const { around(cells_.grid().cell(i).data(), found); }
  /// The same around integer coordinates, where there may be no cell.
  void around(const std::int32_t* cell, std::vector<Index>& found) const {
    Search search;
    for (Index axis = 0; axis < dim(); ++axis) {
      search.block[axis] = (cell[axis] - 1) >> side_bits(axis);
      search.rows[axis] = &rows_[axis][cell[axis] & (side(axis) - 1)];
    }
    found.clear();
    collect<kMaxDim - 1>(search, ~std::uint64_t{0}, hash_of(search.block), found);
  }

 private:
  static constexpr int kMaxDim = D == Eigen::Dynamic ? kMaxMarchDim : D;
  static constexpr int kMaxSide = 8;
  static constexpr std::size_t kMinSlots = 64;
  static constexpr std::uint32_t kNoBlock = 0xffffffff;

  struct Block {
    std::int32_t coordinates[kMaxDim];
    std::uint64_t present = 0;  // which of its cells there are
  };
  /// The three coordinates around one lie in up to three blocks of an axis: which places of each, a bit each.
  struct Row {
    std::uint64_t places[3] = {0, 0, 0};
  };
  struct Search {
    std::int32_t block[kMaxDim];  // the first one on each axis, then the one looked at
    const Row* rows[kMaxDim];
  };

  [[nodiscard]] Index dim() const { return D == Eigen::Dynamic ? d_ : D; }
  // Blocks of 64 cells for d = 2 and 3, of 16 to 64 above.
  [[nodiscard]] int side_bits(Index axis) const {
    if (dim() <= 2) return 3;
    if (dim() == 3) return 2;
    return axis < 6 ? 1 : 0;
  }
  [[nodiscard]] std::int32_t side(Index axis) const { return 1 << side_bits(axis); }
  [[nodiscard]] std::size_t local(std::int32_t c, Index axis) const {
    return static_cast<std::size_t>(c & (side(axis) - 1)) << shift_[axis];
  }

  /// A bit for each place of a block that has this coordinate.
  [[nodiscard]] std::uint64_t places_at(std::int32_t c, Index axis) const {
    std::uint64_t places = 0;
    const std::size_t mine = local(c, axis);
    const std::size_t mask = static_cast<std::size_t>(side(axis) - 1) << shift_[axis];
    for (std::size_t place = 0; place < std::size_t{1} << block_size_; ++place) {
      if ((place & mask) == mine) places |= std::uint64_t{1} << place;
    }
    return places;
  }

  /// Adds the neighbours in all blocks along the axes up to `Axis`; `wanted`: the places that the axes above leave.
  template <int Axis>
  void collect(Search& search, std::uint64_t wanted, std::uint64_t hash, std::vector<Index>& found) const {
    if constexpr (Axis < 0) {
      // All axes chosen: one look-up, then the places wanted that hold a cell, a bit each.
      const std::size_t b = slots_[slot_of(hash, search.block)];
      if (b == kNoBlock) return;
      const std::uint32_t* entries = entries_.data() + (b << block_size_);
      for (wanted &= blocks_[b].present; wanted != 0; wanted &= wanted - 1) {
        found.push_back(static_cast<Index>(entries[std::countr_zero(wanted)]));
      }
    } else {
      // Dynamic dimensions instantiate all axes up to kMaxDim.
      if (Axis >= dim()) return collect<Axis - 1>(search, wanted, hash, found);
      const std::int32_t first = search.block[Axis];
      for (const std::uint64_t places : search.rows[Axis]->places) {
        if (places != 0) collect<Axis - 1>(search, wanted & places, hash, found);
        ++search.block[Axis];
        hash += factor(Axis);
      }
      search.block[Axis] = first;
    }
  }

  /// Linear in the coordinates: a step along an axis adds that axis' factor.
  [[nodiscard]] std::uint64_t hash_of(const std::int32_t* block) const {
    std::uint64_t hash = 0;
    for (Index axis = 0; axis < dim(); ++axis) hash += factor(axis) * static_cast<std::uint64_t>(block[axis]);
    return hash;
  }
  [[nodiscard]] static std::uint64_t factor(Index axis) {
    constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15U;  // 2^64 over the golden ratio
    return kOdd * (kOdd + 2 * static_cast<std::uint64_t>(axis));
  }
  [[nodiscard]] std::size_t slot_of(std::uint64_t hash, const std::int32_t* block) const {
    const std::size_t mask = slots_.size() - 1;
    // Products have their good bits on top.
    std::size_t slot = (hash ^ (hash >> 32)) & mask;
    while (slots_[slot] != kNoBlock && !std::equal(block, block + dim(), blocks_[slots_[slot]].coordinates)) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  std::uint32_t file_block(const std::int32_t* coordinates) {
    const std::uint64_t hash = hash_of(coordinates);
    std::size_t slot = slot_of(hash, coordinates);
    if (slots_[slot] != kNoBlock) return slots_[slot];
    // At most a quarter full, so that the search for a block that is absent soon meets a free slot.
    if (4 * (blocks_.size() + 1) > slots_.size()) {
      rehash();
      slot = slot_of(hash, coordinates);
    }
    slots_[slot] = static_cast<std::uint32_t>(blocks_.size());
    Block& block = blocks_.emplace_back();
    std::copy_n(coordinates, dim(), block.coordinates);
    entries_.resize(blocks_.size() << block_size_, 0);
    return slots_[slot];
  }

  void rehash() {
    slots_.assign(4 * slots_.size(), kNoBlock);
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      slots_[slot_of(hash_of(blocks_[b].coordinates), blocks_[b].coordinates)] = static_cast<std::uint32_t>(b);
    }
  }

  const SurfaceCells& cells_;
  Index d_;
  Index num_filed_ = 0;
  int block_size_ = 0;  // log2 of the cells of a block
  int shift_[kMaxDim] = {};
  Row rows_[kMaxDim][kMaxSide];
  std::vector<std::uint32_t> slots_;  // open addressing by block coordinates
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> entries_;  // 2^block_size_ a block: its cells
};

}  // namespace taut::detail
