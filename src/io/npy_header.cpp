// NumPy's .npy (NEP 1): magic, version, a Python dictionary as text, then the raw array.

#include "io/npy_header.hpp"

#include <charconv>
#include <string_view>

namespace taut::detail {
namespace {

/// The text between a dictionary key's colon and where its value must begin; empty if the key is missing.
std::string_view value_of(std::string_view dictionary, std::string_view key) {
  for (const char mark : {'\'', '"'}) {
    const std::string wanted = mark + std::string(key) + mark;
    const auto at = dictionary.find(wanted);
    if (at == std::string_view::npos) continue;
    std::string_view rest = dictionary.substr(at + wanted.size());
    const auto begin = rest.find_first_not_of(" :");
    return begin == std::string_view::npos ? std::string_view{} : rest.substr(begin);
  }
  return {};
}

std::vector<std::uint64_t> parse_shape(const InputFile& file, std::string_view text) {
  std::vector<std::uint64_t> shape;
  const auto close = text.find(')');
  if (!text.starts_with('(') || close == std::string_view::npos) {
    file.fail_at_byte(10, "the header has no readable 'shape'; the file is damaged");
  }
  const char* p = text.data() + 1;
  const char* end = text.data() + close;
  while (true) {
    while (p != end && (*p == ' ' || *p == ',')) ++p;
    if (p == end) return shape;
    std::uint64_t extent = 0;
    const auto [stop, error] = std::from_chars(p, end, extent);
    if (error != std::errc{}) file.fail_at_byte(10, "the header has no readable 'shape'; the file is damaged");
    p = stop == end || *stop != 'L' ? stop : stop + 1;  // Python 2 wrote long integers as 3L
    shape.push_back(extent);
  }
}

}  // namespace

NpyHeader parse_npy_header(const InputFile& file) {
  const std::string_view bytes = file.bytes;
  constexpr std::string_view kMagic = "\x93NUMPY";
  if (!bytes.starts_with(kMagic) || bytes.size() < 10) {
    file.fail_at_byte(0, "does not start like a NumPy array; write it with numpy.save");
  }
  const auto byte = [&](std::size_t i) { return static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])); };
  const std::uint64_t version = byte(6);
  if (version < 1 || version > 3) {
    file.fail_at_byte(6, "unknown .npy version " + std::to_string(version) + "; write it with numpy.save");
  }
  const std::size_t start = version == 1 ? 10 : 12;
  std::uint64_t length = byte(8) | byte(9) << 8;
  if (version > 1 && bytes.size() >= start) length |= byte(10) << 16 | byte(11) << 24;
  if (bytes.size() < start || length > bytes.size() - start) {
    file.fail_at_byte(8, "the file ends inside its header; it is cut short");
  }
  const std::string_view dictionary = bytes.substr(start, length);

  NpyHeader header;
  header.data_offset = start + length;
  const std::string_view descr = value_of(dictionary, "descr");
  if (descr.starts_with('[')) file.fail_at_byte(start, "a structured array; save a plain array of numbers");
  const auto mark = descr.empty() ? std::string_view::npos : descr.find(descr.front(), 1);
  if (mark == std::string_view::npos)
    file.fail_at_byte(start, "the header has no readable 'descr'; the file is damaged");
  header.descr = descr.substr(1, mark - 1);
  header.fortran_order = value_of(dictionary, "fortran_order").starts_with("True");
  header.shape = parse_shape(file, value_of(dictionary, "shape"));
  return header;
}

}  // namespace taut::detail
