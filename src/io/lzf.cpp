#include "io/lzf.hpp"

#include <cstring>

namespace taut::detail {

std::vector<char> unpack_lzf(std::string_view packed, std::size_t size) {
  std::vector<char> out(size);
  std::size_t filled = 0;
  std::size_t i = 0;
  const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(packed[at])); };
  while (i < packed.size()) {
    const std::size_t control = byte(i++);
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() - i || length > size - filled) return {};
      std::memcpy(out.data() + filled, packed.data() + i, length);
      i += length;
      filled += length;
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    if (control >= 0xE0) {
      if (i == packed.size()) return {};
      length += byte(i++);
    }
    if (i == packed.size()) return {};
    const std::size_t distance = ((control & 31) << 8 | byte(i++)) + 1;
    if (distance > filled || length > size - filled) return {};
    for (std::size_t k = 0; k < length; ++k, ++filled) out[filled] = out[filled - distance];  // may overlap itself
  }
  if (filled != size) return {};
  return out;
}

}  // namespace taut::detail
