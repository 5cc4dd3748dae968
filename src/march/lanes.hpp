#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace taut::detail {

/// A few numbers at a time, in the vector extension of GCC and Clang: what every processor has.
inline constexpr std::size_t kLanes = 4;
using Floats [[gnu::vector_size(kLanes * sizeof(float))]] = float;
using Ints [[gnu::vector_size(kLanes * sizeof(std::int32_t))]] = std::int32_t;

inline Floats all_lanes(float value) { return Floats{value, value, value, value}; }
inline Floats load(const float* from) {
  Floats values;
  std::memcpy(&values, from, sizeof values);
  return values;
}
inline void store(Floats values, float* to) { std::memcpy(to, &values, sizeof values); }

inline Floats abs(Floats x) { return x < 0 ? -x : x; }

/// Bit l is set where lane l of a comparison holds.
inline unsigned bits(Ints comparison) {
  comparison &= Ints{1, 2, 4, 8};
  comparison |= __builtin_shufflevector(comparison, comparison, 2, 3, 0, 1);
  return static_cast<unsigned>(comparison[0] | comparison[1]);
}

/// 1 / sqrt(x) for x >= 0, to a few units in the last place; large but finite at 0, and sqrt(x), 0 there. Newton's
/// method from the bits, since the vector extension has no square root.
inline Floats inverse_sqrt(Floats x) {
  Ints guess;
  std::memcpy(&guess, &x, sizeof guess);
  // Halving the bits halves the exponent; the constant makes the mantissa fit to a few per cent (Lomont 2003). Newton's
  // steps square that error.
  guess = 0x5f375a86 - (guess >> 1);
  Floats y;
  std::memcpy(&y, &guess, sizeof y);
  for (int step = 0; step < 3; ++step) y *= 1.5F - 0.5F * x * y * y;
  return y;
}
inline Floats sqrt(Floats x) { return x * inverse_sqrt(x); }

/// Four rows become columns.
inline void transpose(Floats& a, Floats& b, Floats& c, Floats& d) {
  const Floats ab_low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Floats ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Floats cd_low = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Floats cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

/// The least of many values, kLanes of them taken at a time, and which it was (up to 2^24). Infinite ones do not count.
class Least {
 public:
  void take(Floats values, std::size_t at) {
    // Of equal values the first stays, so that the outcome does not depend on what the lanes are filled up with.
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
