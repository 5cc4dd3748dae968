#include "view/encode.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#ifdef TAUT_ZLIB
#include <zlib.h>
#endif

#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

std::uint32_t crc32_of(std::string_view bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> t{};
    for (std::uint32_t n = 0; n < 256; ++n) {
      std::uint32_t c = n;
      for (int k = 0; k < 8; ++k) c = (c & 1) != 0 ? 0xEDB88320U ^ (c >> 1) : c >> 1;
      t[n] = c;
    }
    return t;
  }();
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const char byte : bytes) crc = table[(crc ^ static_cast<std::uint8_t>(byte)) & 255] ^ (crc >> 8);
  return ~crc;
}

void append_big_endian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<char>(value >> shift & 255));
}

void append_chunk(std::string& png, std::string_view type, std::string_view data) {
  append_big_endian(png, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = png.size();
  png += type;
  png += data;
  append_big_endian(png, crc32_of(std::string_view(png).substr(start)));
}

/// A zlib stream of `data`.
std::string deflate(const std::string& data) {
#ifdef TAUT_ZLIB
  uLongf size = compressBound(data.size());
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(data.data()), data.size(),
                6) != Z_OK) {
    throw OutOfMemory("a picture of " + std::to_string(data.size()) + " bytes cannot be compressed: no memory");
  }
  out.resize(size);
  return out;
#else
  // Without zlib: stored blocks, which every reader understands.
  std::string out = "\x78\x01";
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char byte : data) {
    a = (a + static_cast<std::uint8_t>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  for (std::size_t at = 0; at < data.size() || at == 0; at += 65535) {
    const auto length = static_cast<std::uint32_t>(std::min<std::size_t>(65535, data.size() - at));
    out.push_back(at + length >= data.size() ? '\1' : '\0');
    for (const std::uint32_t n : {length, ~length}) {
      out.push_back(static_cast<char>(n & 255));
      out.push_back(static_cast<char>(n >> 8 & 255));
    }
    out.append(data, at, length);
  }
  append_big_endian(out, b << 16 | a);
  return out;
#endif
}

}  // namespace

std::string encode_png(const Image& image, bool keep_alpha) {
  const std::size_t channels = keep_alpha ? 4 : 3;
  const std::size_t row_size = 1 + channels * static_cast<std::size_t>(image.width);
  std::string rows(row_size * static_cast<std::size_t>(image.height), '\0');
  std::string raw(row_size - 1, '\0');
  std::string above(row_size - 1, '\0');
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* pixel =
        image.rgba.data() + 4 * static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width);
    for (std::size_t x = 0; x < static_cast<std::size_t>(image.width); ++x, pixel += 4) {
      for (std::size_t c = 0; c < channels; ++c) {
        const int value = keep_alpha ? pixel[c] : 255 + (pixel[c] - 255) * pixel[3] / 255;
        raw[channels * x + c] = static_cast<char>(value);
      }
    }
    // Filter 2: the difference to the row above, which suits smooth shading.
    char* row = rows.data() + row_size * static_cast<std::size_t>(y);
    row[0] = 2;
    for (std::size_t i = 0; i + 1 < row_size; ++i) row[i + 1] = static_cast<char>(raw[i] - above[i]);
    std::swap(raw, above);
  }
  std::string header;
  append_big_endian(header, static_cast<std::uint32_t>(image.width));
  append_big_endian(header, static_cast<std::uint32_t>(image.height));
  header += {8, static_cast<char>(keep_alpha ? 6 : 2), 0, 0, 0};
  std::string png("\x89PNG\r\n\x1a\n", 8);
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", deflate(rows));
  append_chunk(png, "IEND", "");
  return png;
}

std::string base64(std::string_view bytes) {
  static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < n ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out.push_back(k <= n ? kDigits[group >> (18 - 6 * k) & 63] : '=');
  }
  return out;
}

std::string clean_utf8(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i]);
    const std::size_t length = first < 0x80   ? 1
                               : first < 0xC2 ? 0
                               : first < 0xE0 ? 2
                               : first < 0xF0 ? 3
                               : first < 0xF5 ? 4
                                              : 0;
    bool good = length > 0 && i + length <= text.size();
    std::uint32_t code = length <= 1 ? first : first & (0x7FU >> length);
    for (std::size_t k = 1; good && k < length; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      good = (next & 0xC0) == 0x80;
      code = code << 6 | (next & 0x3FU);
    }
    good = good && !(code >= 0xD800 && code < 0xE000) && code < 0x110000;
    good = good && !(length == 3 && code < 0x800) && !(length == 4 && code < 0x10000);
    good = good && (code >= 32 || code == '\t' || code == '\n') && code != 0xFFFE && code != 0xFFFF;
    out += good ? text.substr(i, length) : std::string_view("\xEF\xBF\xBD");
    i += good ? length : 1;
  }
  return out;
}

std::string escape_xml(std::string_view text) {
  std::string out;
  for (const char c : clean_utf8(text)) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out.push_back(c);
    }
  }
  return out;
}

std::string css_colour(const Colour& colour) {
  static constexpr std::string_view kHex = "0123456789abcdef";
  std::string out = "#";
  for (const float channel : {colour.red, colour.green, colour.blue}) {
    const auto value = static_cast<unsigned>(std::clamp(channel, 0.0F, 1.0F) * 255 + 0.5F);
    out.push_back(kHex[value / 16]);
    out.push_back(kHex[value % 16]);
  }
  return out;
}

}  // namespace taut::detail
