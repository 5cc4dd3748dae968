#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// The cells a march has seen, ordered by their tentative distance: a 4-ary heap with each cell's place in it, so that
/// a key may go down and up. Equal keys leave in the order of their indices, which makes the march deterministic.
class Front {
 public:
  void resize(Index num_cells) { place_.resize(static_cast<std::size_t>(num_cells), kOutside); }

  [[nodiscard]] bool empty() const { return heap_.empty(); }
  [[nodiscard]] double min_key() const {
    return heap_.empty() ? std::numeric_limits<double>::infinity() : heap_.front().key;
  }
  [[nodiscard]] bool contains(Index cell) const { return place_[static_cast<std::size_t>(cell)] != kOutside; }

  /// Of a cell it contains.
  [[nodiscard]] double key(Index cell) const { return heap_[place_[static_cast<std::size_t>(cell)]].key; }

  /// Adds the cell, or gives it a new key.
  void set(Index cell, double key) {
    const Entry entry{key, static_cast<std::uint32_t>(cell)};
    std::uint32_t hole = place_[entry.cell];
    if (hole == kOutside) {
      hole = static_cast<std::uint32_t>(heap_.size());
      heap_.push_back(entry);
    }
    rise(sink(hole, entry), entry);
  }

  /// Takes out the cell with the least key.
  Index pop() {
    const Entry first = heap_.front();
    const Entry last = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) rise(sink(0, last), last);
    place_[first.cell] = kOutside;
    return first.cell;
  }

 private:
  struct Entry {
    double key;
    std::uint32_t cell;
    [[nodiscard]] bool before(const Entry& other) const {
      return key < other.key || (key == other.key && cell < other.cell);
    }
  };
  static constexpr std::uint32_t kOutside = 0xffffffff;

  void put(std::uint32_t hole, const Entry& entry) {
    heap_[hole] = entry;
    place_[entry.cell] = hole;
  }
  // Moves the hole down past children that come before `entry`; returns where it ends.
  std::uint32_t sink(std::uint32_t hole, const Entry& entry) {
    const std::size_t size = heap_.size();
    for (std::size_t child = 4 * static_cast<std::size_t>(hole) + 1; child < size;
         child = 4 * static_cast<std::size_t>(hole) + 1) {
      std::size_t least = child;
      const std::size_t end = child + 4 < size ? child + 4 : size;
      for (std::size_t c = child + 1; c < end; ++c) {
        if (heap_[c].before(heap_[least])) least = c;
      }
      if (!heap_[least].before(entry)) break;
      put(hole, heap_[least]);
      hole = static_cast<std::uint32_t>(least);
    }
    return hole;
  }
  // Moves `entry` up from the hole to its place.
  void rise(std::uint32_t hole, const Entry& entry) {
    while (hole > 0) {
      const std::uint32_t parent = (hole - 1) / 4;
      if (!entry.before(heap_[parent])) break;
      put(hole, heap_[parent]);
      hole = parent;
    }
    put(hole, entry);
  }

  std::vector<Entry> heap_;
  std::vector<std::uint32_t> place_;  // position in heap_, or kOutside
};

}  // namespace taut::detail
