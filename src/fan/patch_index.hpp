#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fan/exp_patch.hpp"

namespace taut::detail {

/// Boxes of patches in Cartesian cells, those of each size in cells of their own (powers of two), by a flat hash. What
/// is found comes in the order in which it was added, level by level.
class PatchIndex {
 public:
  void add(const PatchFrame& frame, std::int32_t patch);

  /// Calls visit(patch) for every patch that may reach q (and a few that do not) until it returns false.
  template <class Visit>
  void near(const Eigen::Vector3d& q, const Visit& visit) const {
    for (const int level : levels_) {
      const Key key = key_of(q, level);
      std::size_t slot = slot_of(key);
      if (slots_[slot].first < 0) continue;
      for (std::int32_t i = slots_[slot].first; i >= 0; i = entries_[static_cast<std::size_t>(i)].next) {
        if (!visit(entries_[static_cast<std::size_t>(i)].patch)) return;
      }
    }
  }

 private:
  struct Key {
    std::array<std::int32_t, 3> cell;
    int level;
    bool operator==(const Key&) const = default;
  };
  struct Slot {
    Key key{};
    std::int32_t first = -1;
    std::int32_t last = -1;
  };
  struct Entry {
    std::int32_t patch;
    std::int32_t next;
  };

  [[nodiscard]] static Key key_of(const Eigen::Vector3d& q, int level);
  [[nodiscard]] std::size_t slot_of(const Key& key) const;
  void grow();

  std::vector<int> levels_;  // that hold something, coarse ones first
  std::vector<Slot> slots_ = std::vector<Slot>(64);
  std::vector<Entry> entries_;
  std::size_t num_cells_ = 0;
};

}  // namespace taut::detail
