#include "view/encode.hpp"

#include <algorithm>
#include <cstdint>

namespace taut::detail {

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
