#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "core/parallel.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Floats on a block of Z^3, the first index running fastest.
struct Lattice {
  std::array<Index, 3> size = {0, 0, 0};
  std::vector<float> values;

  [[nodiscard]] Index stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? size[0] : size[0] * size[1]; }
  [[nodiscard]] std::size_t at(Index i, Index j, Index k) const {
    return static_cast<std::size_t>(i + size[0] * (j + size[1] * k));
  }
};

/// Side by side in a bundle of lines, so that a filter runs over whole vectors.
inline constexpr Index kBundle = 16;

/// Filters every line of `lattice` along `axis`, in parallel: `filter(line, n)` gets the n entries of kBundle lines as
/// doubles, entry i of line w at line[i * kBundle + w], and changes them in place. Lines beyond the last are zero.
template <class Filter>
void filter_lines(Lattice& lattice, int axis, const Context& context, const Filter& filter) {
  const int inner = axis == 0 ? 1 : 0;
  const int outer = axis == 2 ? 1 : 2;
  const Index n = lattice.size[static_cast<std::size_t>(axis)];
  const Index num_inner = lattice.size[static_cast<std::size_t>(inner)];
  const Index step = lattice.stride(axis);
  const Index across = lattice.stride(inner);
  parallel_for(context, 0, lattice.size[static_cast<std::size_t>(outer)], 1, [&](Index first, Index last) {
    std::vector<double> lines(static_cast<std::size_t>(n * kBundle));
    for (Index o = first; o < last; ++o) {
      for (Index begin = 0; begin < num_inner; begin += kBundle) {
        float* const corner = lattice.values.data() + o * lattice.stride(outer) + begin * across;
        const Index width = std::min(kBundle, num_inner - begin);
        if (width < kBundle) std::fill(lines.begin(), lines.end(), 0.0);
        for (Index i = 0; i < n; ++i) {
          for (Index w = 0; w < width; ++w) {
            lines[static_cast<std::size_t>(i * kBundle + w)] = corner[i * step + w * across];
          }
        }
        filter(lines.data(), n);
        for (Index i = 0; i < n; ++i) {
          for (Index w = 0; w < width; ++w) {
            corner[i * step + w * across] = static_cast<float>(lines[static_cast<std::size_t>(i * kBundle + w)]);
          }
        }
      }
    }
  });
}

}  // namespace taut::detail
