#include "fan/patch_index.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace taut::detail {
namespace {

/// The cells of a patch are at least this part of its box's longest side: a box lies in 27 of them at most.
constexpr double kCellSize = 0.7;

std::int32_t cell(double x, int level) {
  constexpr double kMost = 1 << 30;
  return static_cast<std::int32_t>(std::clamp(std::floor(std::ldexp(x, -level)), -kMost, kMost));
}

}  // namespace

PatchIndex::Key PatchIndex::key_of(const Eigen::Vector3d& q, int level) {
  return {{cell(q[0], level), cell(q[1], level), cell(q[2], level)}, level};
}

std::size_t PatchIndex::slot_of(const Key& key) const {
  std::uint64_t hash = static_cast<std::uint64_t>(key.level) * 0x9E3779B97F4A7C15ULL;
  for (const std::int32_t c : key.cell) hash = (hash ^ static_cast<std::uint32_t>(c)) * 0xBF58476D1CE4E5B9ULL;
  hash ^= hash >> 29;
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = static_cast<std::size_t>(hash) & mask;
  while (slots_[slot].first >= 0 && !(slots_[slot].key == key)) slot = (slot + 1) & mask;
  return slot;
}

void PatchIndex::grow() {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  for (const Slot& s : old) {
    if (s.first >= 0) slots_[slot_of(s.key)] = s;
  }
}

void PatchIndex::add(const PatchFrame& frame, std::int32_t patch) {
  const double extent = (frame.upper - frame.lower).maxCoeff();
  const int level = static_cast<int>(std::ceil(std::log2(kCellSize * extent)));
  const auto place = std::ranges::lower_bound(levels_, level, std::greater{});
  if (place == levels_.end() || *place != level) levels_.insert(place, level);
  const Key lower = key_of(frame.lower.matrix(), level);
  const Key upper = key_of(frame.upper.matrix(), level);
  Key key{{}, level};
  for (key.cell[2] = lower.cell[2]; key.cell[2] <= upper.cell[2]; ++key.cell[2]) {
    for (key.cell[1] = lower.cell[1]; key.cell[1] <= upper.cell[1]; ++key.cell[1]) {
      for (key.cell[0] = lower.cell[0]; key.cell[0] <= upper.cell[0]; ++key.cell[0]) {
        std::size_t slot = slot_of(key);
        const auto entry = static_cast<std::int32_t>(entries_.size());
        entries_.push_back({patch, -1});
        if (slots_[slot].first < 0) {
          if (2 * (num_cells_ + 1) > slots_.size()) {
            grow();
            slot = slot_of(key);
          }
          ++num_cells_;
          slots_[slot] = {key, entry, entry};
        } else {
          entries_[static_cast<std::size_t>(slots_[slot].last)].next = entry;
          slots_[slot].last = entry;
        }
      }
    }
  }
}

}  // namespace taut::detail
