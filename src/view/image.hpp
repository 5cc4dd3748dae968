#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace taut::detail {

/// Pixels, row by row from the top: red, green, blue (sRGB, not multiplied by alpha) and alpha, 0..255.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;

  [[nodiscard]] std::uint8_t* pixel(int x, int y) {
    return rgba.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

}  // namespace taut::detail
