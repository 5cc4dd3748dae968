#pragma once

#include <cstddef>
#include <cstdint>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Bits of a coordinate that choose the place inside a block of cells. 2^4 cells share a block, whose slots share a
/// cache line, so that looking up the neighbours of a cell touches few lines; larger blocks fill the table too
/// unevenly.
constexpr int block_bits(Index dim, Index axis) {
  if (dim == 1) return axis == 0 ? 4 : 0;
  if (dim == 2) return 2;
  if (dim == 3) return axis == 0 ? 2 : 1;
  return axis < 4 ? 1 : 0;
}

constexpr int block_bits(Index dim) {
  int bits = 0;
  for (Index axis = 0; axis < dim; ++axis) bits += block_bits(dim, axis);
  return bits;
}

/// A hash of a cell: its low bits say where in the block, the rest is the mixed block. D is d, or Eigen::Dynamic.
template <int D>
inline std::uint64_t hash_cell(Index dim, const std::int32_t* cell) {
  const Index d = D > 0 ? D : dim;
  std::uint64_t block = 0;
  std::uint64_t local = 0;
  for (Index axis = 0; axis < d; ++axis) {
    const int bits = block_bits(d, axis);
    const auto c = static_cast<std::uint32_t>(cell[axis]);
    local = (local << bits) | (c & ((1U << bits) - 1));
    block = block * 0x9E3779B97F4A7C15U + (c >> bits);
  }
  // The finaliser of MurmurHash3 (public domain), so that every bit of the block reaches the low bits.
  block ^= block >> 33;
  block *= 0xFF51AFD7ED558CCDU;
  block ^= block >> 29;
  return (block << block_bits(d)) | local;
}

}  // namespace taut::detail
