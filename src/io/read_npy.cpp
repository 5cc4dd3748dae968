// NumPy's .npy (NEP 1): magic, version, a Python dictionary as text, then the raw array.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <functional>
#include <string_view>

#include "io/readers.hpp"

namespace taut::detail {
namespace {

struct NpyHeader {
  std::string descr;  // "<f8"
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
  std::size_t data_offset = 0;
};

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

NpyHeader parse_header(const InputFile& file) {
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
  if (descr.starts_with('[')) file.fail_at_byte(start, "a structured array; save a plain (n, d) array of numbers");
  const auto mark = descr.empty() ? std::string_view::npos : descr.find(descr.front(), 1);
  if (mark == std::string_view::npos)
    file.fail_at_byte(start, "the header has no readable 'descr'; the file is damaged");
  header.descr = descr.substr(1, mark - 1);
  header.fortran_order = value_of(dictionary, "fortran_order").starts_with("True");
  header.shape = parse_shape(file, value_of(dictionary, "shape"));
  return header;
}

template <class T>
double load(const char* p, bool swaps) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), p, sizeof(T));
  if (swaps) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<T>(raw));
}

struct NumberKind {
  std::string_view code;
  std::size_t size;
  double (*load)(const char*, bool);
};

constexpr std::array kKinds = {
    NumberKind{"f4", 4, load<float>},        NumberKind{"f8", 8, load<double>},
    NumberKind{"i1", 1, load<std::int8_t>},  NumberKind{"u1", 1, load<std::uint8_t>},
    NumberKind{"i2", 2, load<std::int16_t>}, NumberKind{"u2", 2, load<std::uint16_t>},
    NumberKind{"i4", 4, load<std::int32_t>}, NumberKind{"u4", 4, load<std::uint32_t>},
    NumberKind{"i8", 8, load<std::int64_t>}, NumberKind{"u8", 8, load<std::uint64_t>},
};

}  // namespace

PointCloud read_npy(const InputFile& file) {
  const NpyHeader header = parse_header(file);
  const std::string_view code = std::string_view(header.descr).substr(std::min<std::size_t>(1, header.descr.size()));
  const auto* kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const NumberKind& k) { return k.code == code; });
  const char order = header.descr.empty() ? ' ' : header.descr.front();
  if (kind == kKinds.end() || (order != '<' && order != '>' && order != '|' && order != '=')) {
    file.fail_at_byte(10, "numbers of type " + quote(header.descr) +
                              " are not supported; save float32, float64 or integers (array.astype('f8'))");
  }
  if (header.shape.size() != 2) {
    file.fail_at_byte(
        10, "the array has " + counted(header.shape.size(), "dimension") + "; save one of shape (n, d), a point a row");
  }
  const std::uint64_t n = header.shape[0];
  const std::uint64_t d = header.shape[1];
  if (n == 0 || d < 2) {
    file.fail_at_byte(10, "the array's shape is (" + std::to_string(n) + ", " + std::to_string(d) +
                              "); points need shape (n, d) with n at least 1 and d at least 2");
  }
  const std::uint64_t available = file.bytes.size() - header.data_offset;
  if (d > available / kind->size || n != available / (d * kind->size) || n * d * kind->size != available) {
    file.fail_at_byte(header.data_offset, "shape (" + std::to_string(n) + ", " + std::to_string(d) + ") of " +
                                              header.descr + " does not fit the " + counted(available, "byte") +
                                              " that follow; the file is cut short or its header is wrong");
  }

  const bool swaps = kind->size > 1 && (order == '>') != (std::endian::native == std::endian::big) && order != '=';
  const char* p = file.bytes.data() + header.data_offset;
  PointCloud cloud;
  cloud.points.resize(static_cast<Index>(d), static_cast<Index>(n));
  const auto fill = [&](auto&& entries) {
    for (Index j = 0; j < entries.cols(); ++j) {
      for (Index i = 0; i < entries.rows(); ++i, p += kind->size) entries(i, j) = kind->load(p, swaps);
    }
  };
  if (header.fortran_order) {
    fill(cloud.points.transpose());
  } else {
    fill(cloud.points);
  }
  return cloud;
}

}  // namespace taut::detail
