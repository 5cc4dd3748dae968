// NumPy's .npy (npy_header.hpp) as points.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <functional>
#include <string_view>

#include "io/npy_header.hpp"
#include "io/readers.hpp"

namespace taut::detail {
namespace {

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
  const NpyHeader header = parse_npy_header(file);
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
