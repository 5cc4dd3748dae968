#include "surface/volume/value_pyramid.hpp"

#include <algorithm>
#include <limits>

namespace taut::detail {
namespace {

/// Cells along an edge of the smallest blocks.
constexpr Index kBlock = 4;
/// Coefficients along an axis that matter in so many cells.
constexpr Index kBlockSupport = kBlock + 3;
/// Blocks along an axis that a range may be put together from: more are looked up one level higher.
constexpr Index kMostBlocks = 5;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

Index blocks_along(Index num_cells) { return (num_cells + kBlock - 1) / kBlock; }

Lattice make_lattice(const std::array<Index, 3>& size, float value) {
  return {size, std::vector<float>(static_cast<std::size_t>(size[0] * size[1] * size[2]), value)};
}

void include(float value, float& least, float& largest) {
  least = std::min(least, value);
  largest = std::max(largest, value);
}

}  // namespace

ValuePyramid::ValuePyramid(const Lattice& coefficients, const Context& context) {
  std::array<Index, 3> size;
  for (std::size_t a = 0; a < 3; ++a) {
    num_cells_[a] = coefficients.size[a] - 3;
    size[a] = blocks_along(num_cells_[a]);
  }
  Level base{make_lattice(size, kInfinity), make_lattice(size, -kInfinity)};
  parallel_for(context, 0, size[2], 1, [&](Index k_block, Index) {
    // First the rows of coefficients, over the layers of this block; then the rows together.
    const Index num_rows = coefficients.size[1];
    Lattice least = make_lattice({size[0], num_rows, 1}, kInfinity);
    Lattice largest = make_lattice({size[0], num_rows, 1}, -kInfinity);
    const Index k_end = std::min(k_block * kBlock + kBlockSupport, coefficients.size[2]);
    for (Index k = k_block * kBlock; k < k_end; ++k) {
      for (Index j = 0; j < num_rows; ++j) {
        const float* row = coefficients.values.data() + coefficients.at(0, j, k);
        for (Index b = 0; b < size[0]; ++b) {
          const Index end = std::min(b * kBlock + kBlockSupport, coefficients.size[0]);
          const std::size_t slot = least.at(b, j, 0);
          for (Index i = b * kBlock; i < end; ++i) include(row[i], least.values[slot], largest.values[slot]);
        }
      }
    }
    for (Index j_block = 0; j_block < size[1]; ++j_block) {
      const Index j_end = std::min(j_block * kBlock + kBlockSupport, num_rows);
      for (Index j = j_block * kBlock; j < j_end; ++j) {
        for (Index b = 0; b < size[0]; ++b) {
          const std::size_t from = least.at(b, j, 0);
          const std::size_t to = base.least.at(b, j_block, k_block);
          base.least.values[to] = std::min(base.least.values[to], least.values[from]);
          base.largest.values[to] = std::max(base.largest.values[to], largest.values[from]);
        }
      }
    }
  });
  levels_.push_back(std::move(base));

  while (*std::ranges::max_element(levels_.back().least.size) > 1) {
    const Level& below = levels_.back();
    std::array<Index, 3> halved;
    for (std::size_t a = 0; a < 3; ++a) halved[a] = (below.least.size[a] + 1) / 2;
    Level level{make_lattice(halved, kInfinity), make_lattice(halved, -kInfinity)};
    for (Index k = 0; k < below.least.size[2]; ++k) {
      for (Index j = 0; j < below.least.size[1]; ++j) {
        for (Index i = 0; i < below.least.size[0]; ++i) {
          const std::size_t from = below.least.at(i, j, k);
          const std::size_t to = level.least.at(i / 2, j / 2, k / 2);
          level.least.values[to] = std::min(level.least.values[to], below.least.values[from]);
          level.largest.values[to] = std::max(level.largest.values[to], below.largest.values[from]);
        }
      }
    }
    levels_.push_back(std::move(level));
  }
}

std::array<float, 2> ValuePyramid::range(const std::array<Index, 3>& first, const std::array<Index, 3>& last) const {
  std::size_t chosen = 0;
  Index width = kBlock;
  const auto too_many = [&](std::size_t a) { return last[a] / width - first[a] / width >= kMostBlocks; };
  while (chosen + 1 < levels_.size() && (too_many(0) || too_many(1) || too_many(2))) {
    ++chosen;
    width *= 2;
  }
  const Level& level = levels_[chosen];
  float least = kInfinity;
  float largest = -kInfinity;
  for (Index k = first[2] / width; k <= last[2] / width; ++k) {
    for (Index j = first[1] / width; j <= last[1] / width; ++j) {
      for (Index i = first[0] / width; i <= last[0] / width; ++i) {
        const std::size_t block = level.least.at(i, j, k);
        least = std::min(least, level.least.values[block]);
        largest = std::max(largest, level.largest.values[block]);
      }
    }
  }
  return {least, largest};
}

bool ValuePyramid::zero_box(Eigen::Array3d& lower, Eigen::Array3d& upper) const {
  lower.setConstant(std::numeric_limits<double>::infinity());
  upper.setConstant(-std::numeric_limits<double>::infinity());
  const Level& base = levels_.front();
  const Eigen::Array3d end(static_cast<double>(num_cells_[0]), static_cast<double>(num_cells_[1]),
                           static_cast<double>(num_cells_[2]));
  for (Index k = 0; k < base.least.size[2]; ++k) {
    for (Index j = 0; j < base.least.size[1]; ++j) {
      for (Index i = 0; i < base.least.size[0]; ++i) {
        const std::size_t block = base.least.at(i, j, k);
        if (base.least.values[block] > 0 || base.largest.values[block] < 0) continue;
        const Eigen::Array3d corner =
            static_cast<double>(kBlock) *
            Eigen::Array3d(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        lower = lower.min(corner);
        upper = upper.max((corner + static_cast<double>(kBlock)).min(end));
      }
    }
  }
  return (lower <= upper).all();
}

}  // namespace taut::detail
