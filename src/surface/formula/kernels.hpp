#pragma once

#include <cstddef>

#include "surface/formula/tape.hpp"

namespace taut::detail {

// Running a tape over many points or boxes. Points are taken in blocks; each instruction runs over a whole block, in
// SIMD lanes, before the next one, so decoding costs little and the slots of a block stay in the first-level cache.
// The best instruction set of the machine is chosen at run time; all of them give the same bits.

/// Where inputs come from and outputs go: entry e of array i at point j is array[i][j * stride[i] + e]. Null outputs
/// are skipped.
struct PointArrays {
  static constexpr int kMaxArrays = 3;
  const double* input[kMaxArrays] = {};
  std::size_t input_stride[kMaxArrays] = {};
  double* output[kMaxArrays] = {};
  std::size_t output_stride[kMaxArrays] = {};
};

/// Lanes of one SIMD vector of doubles: a block is a multiple of it.
[[nodiscard]] std::size_t num_lanes();

/// True when any of the n numbers is NaN.
[[nodiscard]] bool any_nan(const double* x, std::size_t n);

/// Runs `tape` on n points, `block` of them at a time. `slots` holds tape.num_slots * block doubles, aligned to
/// 64 bytes.
void run_points(const Tape& tape, const PointArrays& arrays, std::size_t n, std::size_t block, double* slots);

/// Boxes: n of them with `dim` coordinates. The bounds of entry e of output array i at box j are
/// array[i][j * stride[i] + e]. A value that is undefined (NaN) all over a box has NaN bounds.
struct BoxArrays {
  static constexpr int kMaxArrays = 2;
  const double* lower = nullptr;
  const double* upper = nullptr;
  std::size_t dim = 0;
  double* output_lower[kMaxArrays] = {};
  double* output_upper[kMaxArrays] = {};
  std::size_t output_stride[kMaxArrays] = {};
};

/// Largest error, in units in the last place, of an elementary function on lanes or in the C library that interval
/// bounds allow for. The functions of the GNU C library are documented to err by at most 4 ulp (cbrt), the others by 2.
inline constexpr double kMaxUlp = 8;

/// Interval arithmetic over a tape that computes values or first derivatives. `slots` holds 3 * tape.num_slots * block
/// doubles.
void run_boxes(const Tape& tape, const BoxArrays& arrays, std::size_t n, std::size_t block, double* slots);

}  // namespace taut::detail
