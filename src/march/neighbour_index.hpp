#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "march/tangent_frame.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Finds the valid neighbours of cells faster than the grid's own hash: cells are filed in blocks of 2^b cells a side,
/// and the 3^d cells around one lie in a few blocks, so there are few look-ups: 2 to 4 on average for d = 3 instead
/// of 26. About 13 bytes a cell for d = 3.
template <int D>
class NeighbourIndex {
 public:
  explicit NeighbourIndex(const SurfaceCells& cells) : cells_(cells), d_(cells.grid().dim()) {
    blocks_.assign(kMinSlots, kNoBlock);
    for (Index axis = 0; axis < dim(); ++axis) {
      shift_[axis] = block_size_;
      block_size_ += side_bits(axis);
    }
    update();
  }

  /// Files the cells that came since.
  void update() {
    const Index n = cells_.num_cells();
    for (; num_filed_ < n; ++num_filed_) {
      if (!cells_.valid(num_filed_)) continue;
      const std::int32_t* cell = cells_.grid().cell(num_filed_).data();
      std::int32_t block[kMaxMarchDim];
      std::size_t place = 0;
      for (Index axis = 0; axis < dim(); ++axis) {
        block[axis] = cell[axis] >> side_bits(axis);
        place |= local(cell[axis], axis);
      }
      const std::size_t b = file_block(block);
      entries_[(b << block_size_) | place] = static_cast<std::uint32_t>(num_filed_);
      present_[b] |= std::uint64_t{1} << place;
    }
  }

  /// The valid cells around cell i in a fixed order, cell i among them. Lives until the next call.
  [[nodiscard]] std::span<const Index> around(Index i) {
    const std::int32_t* cell = cells_.grid().cell(i).data();
    // On each axis, the at most two rows of blocks that the three coordinates lie in, and which places of each.
    Row rows[kMaxMarchDim][2];
    std::int32_t first[kMaxMarchDim];
    for (Index axis = 0; axis < dim(); ++axis) {
      first[axis] = (cell[axis] - 1) >> side_bits(axis);
      rows[axis][0] = rows[axis][1] = {};
      for (std::int32_t c = cell[axis] - 1; c <= cell[axis] + 1; ++c) {
        Row& row = rows[axis][(c >> side_bits(axis)) - first[axis]];
        row.shift[row.count++] = static_cast<std::uint8_t>(local(c, axis));
      }
    }
    found_.clear();
    for (std::size_t which = 0; which < std::size_t{1} << dim(); ++which) {
      std::uint64_t wanted = 1;  // places in the block, a bit each
      for (Index axis = 0; axis < dim(); ++axis) {
        const Row& row = rows[axis][(which >> axis) & 1];
        std::uint64_t moved = 0;
        for (int r = 0; r < row.count; ++r) moved |= wanted << row.shift[r];
        wanted = moved;
      }
      if (wanted == 0) continue;
      const std::uint32_t block = find_block(first, which);
      if (block == kNoBlock) continue;
      const std::uint32_t* entries = entries_.data() + (std::size_t{block} << block_size_);
      for (wanted &= present_[block]; wanted != 0; wanted &= wanted - 1) {
        found_.push_back(static_cast<Index>(entries[std::countr_zero(wanted)]));
      }
    }
    return found_;
  }

 private:
  static constexpr std::size_t kMinSlots = 64;
  static constexpr std::uint32_t kNoBlock = 0xffffffff;

  /// Up to three places on one axis of a block, as far as they move a bit in the block's mask.
  struct Row {
    std::uint8_t shift[3];
    std::uint8_t count = 0;
  };

  [[nodiscard]] Index dim() const { return D == Eigen::Dynamic ? d_ : D; }
  // Blocks of 64 cells for d = 2 and 3, of 16 to 64 above.
  [[nodiscard]] int side_bits(Index axis) const {
    if (dim() <= 2) return 3;
    if (dim() == 3) return 2;
    return axis < 6 ? 1 : 0;
  }
  [[nodiscard]] std::size_t local(std::int32_t c, Index axis) const {
    return static_cast<std::size_t>(c & ((1 << side_bits(axis)) - 1)) << shift_[axis];
  }

  [[nodiscard]] std::size_t slot_of(const std::int32_t* block) const {
    std::uint64_t hash = 0;
    for (Index axis = 0; axis < dim(); ++axis) {
      hash = (hash ^ static_cast<std::uint32_t>(block[axis])) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32;
    }
    const std::size_t mask = blocks_.size() - 1;
    std::size_t slot = hash & mask;
    while (blocks_[slot] != kNoBlock &&
           !std::equal(block, block + dim(), coordinates_.data() + blocks_[slot] * static_cast<std::size_t>(dim()))) {
      slot = (slot + 1) & mask;
    }
    return slot;
  }

  [[nodiscard]] std::uint32_t find_block(const std::int32_t* first, std::size_t which) const {
    std::int32_t block[kMaxMarchDim];
    for (Index axis = 0; axis < dim(); ++axis) {
      block[axis] = first[axis] + static_cast<std::int32_t>((which >> axis) & 1);
    }
    return blocks_[slot_of(block)];
  }

  std::size_t file_block(const std::int32_t* block) {
    std::size_t slot = slot_of(block);
    if (blocks_[slot] == kNoBlock) {
      const std::size_t count = coordinates_.size() / static_cast<std::size_t>(dim());
      if (4 * (count + 1) > blocks_.size()) {
        rehash(count);
        slot = slot_of(block);
      }
      blocks_[slot] = static_cast<std::uint32_t>(count);
      coordinates_.insert(coordinates_.end(), block, block + dim());
      entries_.resize((count + 1) << block_size_, 0);
      present_.push_back(0);
    }
    return blocks_[slot];
  }

  void rehash(std::size_t count) {
    blocks_.assign(4 * blocks_.size(), kNoBlock);
    for (std::size_t b = 0; b < count; ++b) {
      blocks_[slot_of(coordinates_.data() + b * static_cast<std::size_t>(dim()))] = static_cast<std::uint32_t>(b);
    }
  }

  const SurfaceCells& cells_;
  Index d_;
  Index num_filed_ = 0;
  int block_size_ = 0;  // log2 of the cells of a block
  int shift_[kMaxMarchDim] = {};
  std::vector<std::uint32_t> blocks_;      // open addressing by block coordinates
  std::vector<std::int32_t> coordinates_;  // d a block
  std::vector<std::uint32_t> entries_;     // 2^block_size_ a block: its cells
  std::vector<std::uint64_t> present_;     // a block: which of them there are
  std::vector<Index> found_;
};

}  // namespace taut::detail
