#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace taut::detail {

/// Most bytes one byte of LZF data can stand for: a 3-byte back reference yields at most 264.
inline constexpr std::size_t kLzfRatio = 88;

/// Unpacks LZF data (the layout of M. Lehmann's liblzf) into exactly `size` bytes; empty if the data are damaged.
///
/// Each group starts with a control byte c. c < 32: c + 1 bytes follow as they are. Otherwise a back reference: length
/// (c >> 5) + 2, or with all three bits set plus the next byte; distance ((c & 31) << 8 | next byte) + 1.
[[nodiscard]] std::vector<char> unpack_lzf(std::string_view packed, std::size_t size);

}  // namespace taut::detail
