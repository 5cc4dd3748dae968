// Depth first in blocks: a block of cells is tested, its survivors are halved a few parents at a time, and each batch
// of halves is finished before the next. Memory is a block a level; a test gets hundreds of cells; order is kept.
#include "cells/refine.hpp"

#include <algorithm>
#include <string>

#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

constexpr Index kBoxesPerTest = 512;

}  // namespace

void check_halving(Index dim) {
  constexpr Index kMostDimensions = 12;
  if (dim <= kMostDimensions) return;
  throw InvalidArgument("cells are halved in up to " + std::to_string(kMostDimensions) + " dimensions, not in " +
                        std::to_string(dim));
}

void append_halves(Index dim, const std::int32_t* cells, Index n, std::vector<std::int32_t>& out) {
  const std::size_t begin = out.size();
  const Index halves = Index{1} << dim;
  out.resize(begin + static_cast<std::size_t>(n * halves * dim));
  std::int32_t* to = out.data() + begin;
  for (Index j = 0; j < n; ++j) {
    for (Index half = 0; half < halves; ++half) {
      for (Index axis = 0; axis < dim; ++axis) {
        *to++ = 2 * cells[j * dim + axis] + static_cast<std::int32_t>((half >> axis) & 1);
      }
    }
  }
}

Refiner::Refiner(CrossingTest& test, Index dim) : test_(test), dim_(dim) {}

void Refiner::refine(const std::vector<std::int32_t>& cells, int level, int last_level, std::vector<std::int32_t>& out,
                     const std::function<void()>& check) {
  last_level_ = last_level;
  check_ = check ? &check : nullptr;
  refine(cells.data(), static_cast<Index>(cells.size()) / dim_, level, out);
}

void Refiner::refine(const std::int32_t* cells, Index n, int level, std::vector<std::int32_t>& out) {
  // 2^d halves a parent.
  const Index parents_per_test = std::max<Index>(1, kBoxesPerTest >> std::min<Index>(dim_, 62));
  std::vector<std::uint8_t> crossed;
  std::vector<std::int32_t> kept;
  std::vector<std::int32_t> halves;
  for (Index begin = 0; begin < n; begin += kBoxesPerTest) {
    const Index count = std::min(kBoxesPerTest, n - begin);
    const std::int32_t* block = cells + begin * dim_;
    crossed.resize(static_cast<std::size_t>(count));
    test_.test({block, static_cast<std::size_t>(count * dim_)}, level, crossed);
    std::vector<std::int32_t>& to = level == last_level_ ? out : kept;
    kept.clear();
    for (Index j = 0; j < count; ++j) {
      if (crossed[static_cast<std::size_t>(j)] != 0) to.insert(to.end(), block + j * dim_, block + (j + 1) * dim_);
    }
    if (level == last_level_) {
      if (check_ != nullptr) (*check_)();
      continue;
    }
    const Index num_kept = static_cast<Index>(kept.size()) / dim_;
    for (Index first = 0; first < num_kept; first += parents_per_test) {
      halves.clear();
      append_halves(dim_, kept.data() + first * dim_, std::min(parents_per_test, num_kept - first), halves);
      refine(halves.data(), static_cast<Index>(halves.size()) / dim_, level - 1, out);
    }
  }
}

}  // namespace taut::detail
