#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// The cells that a march has seen, ordered by their tentative distance up to the width of a bucket: O(1) where a heap
/// takes O(log n). Within a bucket the cell that came last leaves first. (Yatziv, Bartesaghi and Sapiro 2006, *O(N)
/// implementation of the fast marching algorithm*.)
class BucketFront {
 public:
  /// No key may be more than kReach widths above the least one.
  static constexpr std::uint32_t kReach = 127;

  BucketFront(Index num_cells, float width)
      : places_(static_cast<std::size_t>(num_cells) + kBuckets), per_width_(1 / width) {
    clear();
  }

  void clear() {
    std::fill(places_.begin(), places_.end(), Place{kNone, kNone, kNone});
    for (std::uint32_t b = 0; b < kBuckets; ++b) places_[b].next = places_[b].previous = b;
    occupied_ = {};
    current_ = 0;
  }

  [[nodiscard]] bool empty() const { return (occupied_[0] | occupied_[1]) == 0; }

  /// Adds the cell, or gives it a new key.
  void set(Index cell, float key) {
    const auto at = static_cast<std::uint32_t>(cell) + kBuckets;
    // A key below the current bucket goes into it, one beyond the reach into the last: only the order suffers. The
    // order within kReach is what keeps a ring of kBuckets unambiguous.
    const std::uint32_t bucket =
        std::clamp(static_cast<std::uint32_t>(key * per_width_), current_, current_ + kReach) % kBuckets;
    if (places_[at].bucket == bucket) return;
    if (places_[at].bucket != kNone) unlink(at);
    link(at, bucket);
  }

  /// Takes out a cell of the first bucket.
  Index pop() {
    // The next occupied bucket of the ring: in the rest of the current word, in the other word, or, once round, in the
    // part of the current word before the start.
    const std::uint32_t start = current_ % kBuckets;
    const std::uint32_t word = start / 64;
    const std::uint64_t ahead = occupied_[word] >> (start % 64);
    const std::uint64_t other = occupied_[1 - word];
    const std::uint64_t behind = occupied_[word];
    if (ahead != 0) {
      current_ += static_cast<std::uint32_t>(std::countr_zero(ahead));
    } else if (other != 0) {
      current_ += 64 - start % 64 + static_cast<std::uint32_t>(std::countr_zero(other));
    } else {
      current_ += 128 - start % 64 + static_cast<std::uint32_t>(std::countr_zero(behind));
    }
    const std::uint32_t at = places_[current_ % kBuckets].next;
    unlink(at);
    places_[at].bucket = kNone;
    return static_cast<Index>(at - kBuckets);
  }

 private:
  static constexpr std::uint32_t kBuckets = 128;
  static constexpr std::uint32_t kNone = 0xffffffff;

  /// A ring through a bucket's cells and the bucket itself.
  struct Place {
    std::uint32_t next;
    std::uint32_t previous;
    std::uint32_t bucket;
  };

  void link(std::uint32_t at, std::uint32_t bucket) {
    Place& head = places_[bucket];
    places_[at] = {head.next, bucket, bucket};
    places_[head.next].previous = at;
    head.next = at;
    occupied_[bucket / 64] |= std::uint64_t{1} << (bucket % 64);
  }
  void unlink(std::uint32_t at) {
    const Place place = places_[at];
    places_[place.next].previous = place.previous;
    places_[place.previous].next = place.next;
    // Only the bucket's own entry is left of its ring.
    if (place.next == place.previous && place.next == place.bucket) {
      occupied_[place.bucket / 64] &= ~(std::uint64_t{1} << (place.bucket % 64));
    }
  }

  std::vector<Place> places_;  // of the buckets, then of the cells
  std::array<std::uint64_t, 2> occupied_{};
  std::uint32_t current_ = 0;
  float per_width_;
};

}  // namespace taut::detail
