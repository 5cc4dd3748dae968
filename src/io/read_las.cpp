// LAS 1.0 to 1.4 (ASPRS, "LAS Specification 1.4 - R15"): a header of fixed fields, variable length records that do not
// matter here, and point records of one size, little-endian. A coordinate is a 32-bit integer times a scale plus an
// offset. Compressed files (LAZ) say so in the point format's highest bits.

#include <array>
#include <string_view>

#include "io/readers.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

struct LasHeader {
  std::uint64_t first_point = 0;  // byte
  std::uint64_t record_size = 0;
  std::uint64_t num_points = 0;
  unsigned format = 0;
  std::array<double, 3> scale{};
  std::array<double, 3> offset{};
};

/// Least bytes of a record, by point format.
constexpr std::array<std::uint64_t, 11> kRecordSizes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::size_t kShortHeader = 227;  // before 1.3
constexpr std::size_t kLongHeader = 375;   // 1.4
/// From this format on, flags and class stand in bytes of their own.
constexpr unsigned kFirstLongFormat = 6;

template <class T>
T load(const InputFile& file, std::size_t at) {
  return load_number<T>(file.bytes.data() + at, std::endian::little);
}

LasHeader parse_header(const InputFile& file) {
  if (!file.bytes.starts_with("LASF")) file.fail("does not start with 'LASF'; the file is damaged or no LAS file");
  if (file.bytes.size() < kShortHeader) file.fail("the file ends inside its header; it is cut short");
  const auto major = load<std::uint8_t>(file, 24);
  const auto minor = load<std::uint8_t>(file, 25);
  if (major != 1 || minor > 4) {
    file.fail_at_byte(
        24, "LAS version " + std::to_string(major) + "." + std::to_string(minor) + " is not read; 1.0 to 1.4 are");
  }
  LasHeader header;
  const auto header_size = load<std::uint16_t>(file, 94);
  header.first_point = load<std::uint32_t>(file, 96);
  const auto format = load<std::uint8_t>(file, 104);
  header.record_size = load<std::uint16_t>(file, 105);
  header.num_points = load<std::uint32_t>(file, 107);
  if ((format & 0xC0U) != 0) {
    file.fail("its points are compressed (LAZ); unpack them first: las2las -i in.laz -o out.las, or pdal translate");
  }
  header.format = format;
  if (format >= kRecordSizes.size()) {
    file.fail_at_byte(104, "point format " + std::to_string(format) + " is not read; 0 to 10 are");
  }
  if (header.record_size < kRecordSizes[format]) {
    file.fail_at_byte(105, "records of " + counted(header.record_size, "byte") + " are too short for point format " +
                               std::to_string(format) + "; the header is wrong");
  }
  const std::size_t least_header = minor >= 4 ? kLongHeader : kShortHeader;
  if (header_size < least_header || header.first_point < header_size) {
    file.fail_at_byte(94, "the header's size and the points' place do not fit LAS 1." + std::to_string(minor) +
                              "; the header is wrong");
  }
  if (minor >= 4) {
    if (file.bytes.size() < kLongHeader) file.fail("the file ends inside its header; it is cut short");
    header.num_points = load<std::uint64_t>(file, 247);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    header.scale[i] = load<double>(file, 131 + 8 * i);
    header.offset[i] = load<double>(file, 155 + 8 * i);
    if (!std::isfinite(header.scale[i]) || header.scale[i] == 0 || !std::isfinite(header.offset[i])) {
      file.fail_at_byte(131 + 8 * i, "the scale or offset of " + coordinate_name(static_cast<Index>(i)) +
                                         " is zero or not finite; the header is wrong");
    }
  }
  if (header.first_point > file.bytes.size()) {
    file.fail_at_byte(96, "its points start behind the end of the file; it is cut short");
  }
  return header;
}

/// What the file itself says is not to be used: withheld points, and those of the classes "low noise" and "high noise".
bool is_unwanted(const LasHeader& header, const char* record) {
  constexpr unsigned kLowNoise = 7;
  constexpr unsigned kHighNoise = 18;
  const auto flags = static_cast<unsigned char>(record[15]);
  if (header.format < kFirstLongFormat) return (flags & 0x80U) != 0 || (flags & 0x1FU) == kLowNoise;
  const auto kind = static_cast<unsigned char>(record[16]);
  return (flags & 0x04U) != 0 || kind == kLowNoise || kind == kHighNoise;
}

}  // namespace

PointCloud read_las(const InputFile& file) {
  const LasHeader header = parse_header(file);
  const std::uint64_t available = file.bytes.size() - header.first_point;
  check_declared(file, header.num_points, header.record_size, available, "the number of points");
  if (header.num_points > kMostPoints) file.fail("holds more than 2^31 - 1 points; thin it");
  PointCloud cloud;
  cloud.points.resize(3, static_cast<Index>(header.num_points));
  Index kept = 0;
  for (std::uint64_t j = 0; j < header.num_points; ++j) {
    const char* const record = file.bytes.data() + header.first_point + j * header.record_size;
    if (is_unwanted(header, record)) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto steps = static_cast<double>(load_number<std::int32_t>(record + 4 * i, std::endian::little));
      cloud.points(static_cast<Index>(i), kept) = steps * header.scale[i] + header.offset[i];
    }
    ++kept;
  }
  const auto left_out = static_cast<std::size_t>(cloud.points.cols() - kept);
  if (left_out > 0) {
    file.note(counted(left_out, "point") + " that the file marks as withheld or noise left out");
    cloud.points.conservativeResize(3, kept);
  }
  return cloud;
}

}  // namespace taut::detail
