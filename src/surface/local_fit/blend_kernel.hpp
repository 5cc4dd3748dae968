#pragma once

#include <array>
#include <cstddef>

#include "surface/local_fit/cubic.hpp"

namespace taut::detail {

/// Patches that are evaluated side by side in SIMD lanes: the balls that hold a point are five or six as a rule.
inline constexpr std::size_t kBlendLanes = 8;

/// Up to kBlendLanes patches, the same entry of each in a row: centre, radius, coefficients.
template <int D>
struct PatchLanes {
  static constexpr std::size_t kRows = D + 1 + Cubic<D>::kSize;

  alignas(64) std::array<std::array<double, kBlendLanes>, kRows> row;

  void put(std::size_t lane, const Patch<D>& patch) {
    std::size_t r = 0;
    for (const double c : patch.centre) row[r++][lane] = c;
    row[r++][lane] = patch.radius;
    for (const double c : patch.cubic.coefficient) row[r++][lane] = c;
  }
};

/// A number, or the sum of some over patches, with its derivatives.
template <int D>
struct BlendJet {
  double value = 0;
  std::array<double, D> gradient{};
  std::array<double, Cubic<D>::kPairs> hessian{};  // packed
};

/// sum_i w_i and sum_i w_i f_i over patches, w_i = (1 - |x - c_i|^2 / R_i^2)^4 within the balls and 0 beyond.
template <int D>
struct BlendSums {
  BlendJet<D> weight;
  BlendJet<D> product;
};

/// Adds the first `count` lanes at x (D numbers), and their derivatives where those are asked for. The order of all
/// sums depends on the lanes' order alone, not on the instruction set.
template <int D>
void add_patches(const PatchLanes<D>& lanes, std::size_t count, const double* x, bool derivatives, BlendSums<D>& sums);

}  // namespace taut::detail
