#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace taut::detail {

/// Numbers 0 .. n - 1 (below 2^32) in sets that are joined, never parted. A set is known by its least member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::uint32_t{0}); }

  /// The least member of the set that i belongs to.
  std::uint32_t find(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// False when both were in one set before.
  bool unite(std::uint32_t i, std::uint32_t j) {
    i = find(i);
    j = find(j);
    if (i < j) parent_[j] = i;
    if (j < i) parent_[i] = j;
    return i != j;
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace taut::detail
