#pragma once

#include <cstddef>
#include <cstring>
#include <limits>
#include <vector>

namespace taut::detail {

/// A few numbers at a time, in the vector extension of GCC and Clang: what every processor has.
inline constexpr std::size_t kLanes = 4;
using Floats [[gnu::vector_size(kLanes * sizeof(float))]] = float;

inline Floats all_lanes(float value) { return Floats{value, value, value, value}; }
inline Floats load(const std::vector<float>& from, std::size_t at) {
  Floats values;
  std::memcpy(&values, from.data() + at, sizeof values);
  return values;
}
inline void store(Floats values, std::vector<float>& to, std::size_t at) {
  std::memcpy(to.data() + at, &values, sizeof values);
}

/// The least of many values, kLanes of them taken at a time, and which it was (up to 2^24). Infinite ones do not count.
class Least {
 public:
  void take(Floats values, std::size_t at) {
    at_ = values < values_ ? all_lanes(static_cast<float>(at)) : at_;
    values_ = values < values_ ? values : values_;
  }
  [[nodiscard]] float value() const { return values_[lane()]; }
  [[nodiscard]] std::size_t index() const { return static_cast<std::size_t>(at_[lane()]) + lane(); }

 private:
  [[nodiscard]] std::size_t lane() const {
    std::size_t least = 0;
    for (std::size_t other = 1; other < kLanes; ++other) least = values_[other] < values_[least] ? other : least;
    return least;
  }

  Floats values_ = all_lanes(std::numeric_limits<float>::infinity());
  Floats at_ = all_lanes(0);
};

}  // namespace taut::detail
