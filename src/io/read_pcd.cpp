// PCD (Point Cloud Library), version 0.7: text header, then rows as text, as bytes, or as LZF-packed columns.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <string_view>

#include "io/lzf.hpp"
#include "io/readers.hpp"
#include "io/text_reader.hpp"

namespace taut::detail {
namespace {

struct Field {
  std::string name;
  std::uint64_t size = 4;    // bytes an entry
  char type = 'F';           // F, I, U
  std::uint64_t count = 1;   // entries
  std::uint64_t offset = 0;  // bytes (binary) before it in a row
  std::uint64_t first = 0;   // entries (text) before it in a row
};

struct PcdHeader {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  std::uint64_t row_size = 0;
  std::uint64_t row_entries = 0;
  std::string data;  // "ascii", "binary", "binary_compressed"
  std::size_t data_offset = 0;
  std::size_t data_line = 0;
};

constexpr std::uint64_t kLargestEntryCount = 1 << 20;

std::vector<std::uint64_t> read_counts(TextReader& reader, std::string_view what, std::size_t wanted) {
  std::vector<std::uint64_t> values;
  while (!reader.line_is_done()) {
    const std::int64_t value = reader.integer(what);
    if (value < 0) reader.fail(std::string(what) + " is negative; correct the header");
    values.push_back(static_cast<std::uint64_t>(value));
  }
  if (values.size() != wanted) {
    reader.fail(std::string(what) + " has " + counted(values.size(), "entry") + " where " + std::to_string(wanted) +
                " are needed; correct the header");
  }
  return values;
}

/// The header is text even where the data are not, so only its part of the file is handed to TextReader.
PcdHeader parse_header(const InputFile& file) {
  const std::size_t data = file.bytes.find("\nDATA ");
  const std::size_t end = data == std::string::npos ? data : file.bytes.find('\n', data + 1);
  if (data == std::string::npos || end == std::string::npos) {
    file.fail("the header has no DATA line; the file is cut short or no PCD file");
  }
  const InputFile text{file.path, file.bytes.substr(0, end + 1), file.context};
  TextReader reader(text, '#');
  PcdHeader header;
  header.data_offset = end + 1;
  std::uint64_t width = 0;
  std::uint64_t height = 1;
  bool has_points = false;
  while (reader.next_line()) {
    const std::string_view key = reader.word();
    std::vector<Field>& fields = header.fields;
    if (key == "FIELDS" || key == "COLUMNS") {
      while (!reader.line_is_done()) {
        fields.emplace_back();
        fields.back().name = lower(reader.word());
      }
    } else if (key == "SIZE") {
      const auto sizes = read_counts(reader, "SIZE", fields.size());
      for (std::size_t i = 0; i < sizes.size(); ++i) fields[i].size = sizes[i];
    } else if (key == "COUNT") {
      const auto counts = read_counts(reader, "COUNT", fields.size());
      for (std::size_t i = 0; i < counts.size(); ++i) fields[i].count = counts[i];
    } else if (key == "TYPE") {
      for (Field& field : fields) {
        const std::string_view type = reader.word();
        if (type != "F" && type != "I" && type != "U")
          reader.fail("TYPE " + quote(type) + " is none of F, I, U; correct the header");
        field.type = type[0];
      }
    } else if (key == "WIDTH") {
      width = read_counts(reader, "WIDTH", 1)[0];
    } else if (key == "HEIGHT") {
      height = read_counts(reader, "HEIGHT", 1)[0];
    } else if (key == "POINTS") {
      header.points = read_counts(reader, "POINTS", 1)[0];
      has_points = true;
    } else if (key == "DATA") {
      header.data = lower(reader.word());
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      reader.fail("unknown PCD header entry " + quote(key) + "; the file is damaged or no PCD file");
    }
  }
  header.data_line = reader.line_number() + 1;
  if (height != 0 && width > kMostPoints / height)
    file.fail("WIDTH x HEIGHT is more than 2^31 - 1 points; correct the header or thin the cloud");
  if (!has_points) header.points = width * height;
  if (width != 0 && header.points != width * height) {
    file.fail("POINTS says " + std::to_string(header.points) + ", but WIDTH x HEIGHT is " +
              std::to_string(width * height) + "; correct the header");
  }
  if (header.points > kMostPoints) file.fail("POINTS is more than 2^31 - 1; correct the header or thin the cloud");
  for (Field& field : header.fields) {
    const bool readable =
        field.type == 'F' ? field.size == 4 || field.size == 8 : std::has_single_bit(field.size) && field.size <= 8;
    if (!readable)
      file.fail("field " + quote(field.name) + " has an impossible SIZE of " + std::to_string(field.size) +
                "; correct the header");
    if (field.count > kLargestEntryCount)
      file.fail("field " + quote(field.name) + " has an impossible COUNT; correct the header");
    field.offset = header.row_size;
    field.first = header.row_entries;
    header.row_size += field.size * field.count;
    header.row_entries += field.count;
  }
  return header;
}

template <class T>
double load(const char* p) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), p, sizeof(T));
  if constexpr (std::endian::native == std::endian::big) std::reverse(raw.begin(), raw.end());
  return static_cast<double>(std::bit_cast<T>(raw));
}

double load_entry(const Field& field, const char* p) {
  if (field.type == 'F') return field.size == 4 ? load<float>(p) : load<double>(p);
  const bool is_signed = field.type == 'I';
  switch (field.size) {
    case 1: return is_signed ? load<std::int8_t>(p) : load<std::uint8_t>(p);
    case 2: return is_signed ? load<std::int16_t>(p) : load<std::uint16_t>(p);
    case 4: return is_signed ? load<std::int32_t>(p) : load<std::uint32_t>(p);
    default: return is_signed ? load<std::int64_t>(p) : load<std::uint64_t>(p);
  }
}

/// The fields of x y z normal_x normal_y normal_z; null where the file has none.
std::array<const Field*, 6> find_fields(const InputFile& file, const PcdHeader& header) {
  constexpr std::array<std::string_view, 6> kNames = {"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  std::array<const Field*, 6> found = {};
  for (std::size_t i = 0; i < 6; ++i) {
    const auto field = std::find_if(header.fields.begin(), header.fields.end(),
                                    [&](const Field& f) { return f.name == kNames[i] && f.count > 0; });
    if (field != header.fields.end()) found[i] = &*field;
    if (i < 3 && found[i] == nullptr) file.fail("has no field " + quote(kNames[i]) + "; points need x, y and z");
  }
  return found;
}

/// 6 x n: x y z and the normal (0 where there is none), as the file has them.
using Rows = Eigen::Matrix<double, 6, Eigen::Dynamic>;

Rows read_ascii(const InputFile& file, const PcdHeader& header, const std::array<const Field*, 6>& wanted) {
  TextReader reader(file, '#', header.data_offset, header.data_line);
  check_declared(file, header.points, 2 * header.row_entries, reader.remaining() + 1, "POINTS");
  Rows rows = Rows::Zero(6, static_cast<Index>(header.points));
  std::vector<double> entries(header.row_entries);
  for (Index j = 0; j < rows.cols(); ++j) {
    if (!reader.next_line()) {
      file.fail("the file ends after " + std::to_string(j) + " of " + std::to_string(header.points) +
                " points; it is cut short or POINTS is wrong");
    }
    for (double& entry : entries) entry = reader.number("an entry");
    if (!reader.line_is_done())
      reader.fail("more numbers than FIELDS and COUNT announce; correct the header or the line");
    for (Index i = 0; i < 6; ++i) {
      const Field* field = wanted[static_cast<std::size_t>(i)];
      if (field != nullptr) rows(i, j) = entries[field->first];
    }
  }
  if (reader.next_line()) reader.fail("more points than POINTS announces; correct the header");
  return rows;
}

Rows read_packed(const InputFile& file, const PcdHeader& header, const std::array<const Field*, 6>& wanted) {
  const std::uint64_t available = file.bytes.size() - header.data_offset;
  const std::uint64_t n = header.points;
  std::vector<char> unpacked;
  const char* data = file.bytes.data() + header.data_offset;
  const bool compressed = header.data == "binary_compressed";
  if (compressed) {
    if (available < 8) file.fail_at_byte(header.data_offset, "the file ends before its data; it is cut short");
    const auto packed_size = static_cast<std::uint64_t>(load<std::uint32_t>(data));
    const auto full_size = static_cast<std::uint64_t>(load<std::uint32_t>(data + 4));
    if (packed_size > available - 8) {
      file.fail_at_byte(header.data_offset, "announces " + counted(packed_size, "packed byte") + ", but " +
                                                std::to_string(available - 8) + " follow; the file is cut short");
    }
    if (header.row_size != 0 && (n > full_size / header.row_size || n * header.row_size != full_size)) {
      file.fail_at_byte(header.data_offset + 4,
                        "unpacks to " + counted(full_size, "byte") +
                            ", which does not fit POINTS and the fields' sizes; the header is wrong");
    }
    if (full_size > packed_size * kLzfRatio) {
      file.fail_at_byte(header.data_offset + 4,
                        "announces more unpacked bytes than its data can hold; the file is damaged");
    }
    unpacked = unpack_lzf(std::string_view(data + 8, packed_size), full_size);
    if (unpacked.size() != full_size)
      file.fail_at_byte(header.data_offset + 8, "the compressed data are damaged; write the file again");
    data = unpacked.data();
  } else {
    check_declared(file, n, header.row_size, available, "POINTS");
    const std::uint64_t left = available - n * header.row_size;
    if (left >= header.row_size) {
      file.fail_at_byte(file.bytes.size() - left,
                        counted(left, "byte") + " left after the last point; POINTS or the fields' sizes are wrong");
    }
  }
  Rows rows = Rows::Zero(6, static_cast<Index>(n));
  for (Index i = 0; i < 6; ++i) {
    const Field* field = wanted[static_cast<std::size_t>(i)];
    if (field == nullptr) continue;
    // Packed data stand field by field, plain ones point by point.
    const char* first = data + field->offset * (compressed ? n : 1);
    const std::uint64_t stride = compressed ? field->size * field->count : header.row_size;
    for (Index j = 0; j < rows.cols(); ++j)
      rows(i, j) = load_entry(*field, first + static_cast<std::uint64_t>(j) * stride);
  }
  return rows;
}

}  // namespace

PointCloud read_pcd(const InputFile& file) {
  const PcdHeader header = parse_header(file);
  const std::array<const Field*, 6> wanted = find_fields(file, header);
  Rows rows;
  if (header.data == "ascii") {
    rows = read_ascii(file, header, wanted);
  } else if (header.data == "binary" || header.data == "binary_compressed") {
    rows = read_packed(file, header, wanted);
  } else {
    file.fail("DATA " + quote(header.data) + " is none of ascii, binary, binary_compressed; correct the header");
  }
  // An organised cloud marks a pixel without a return by NaN: no damage, but no point either.
  Index kept = 0;
  for (Index j = 0; j < rows.cols(); ++j) {
    if (rows.col(j).head<3>().allFinite()) rows.col(kept++) = rows.col(j);
  }
  const auto dropped = static_cast<std::size_t>(rows.cols() - kept);
  if (dropped > 0) file.note(counted(dropped, "point") + " without finite coordinates left out");
  PointCloud cloud;
  if (kept == 0) return cloud;
  cloud.points = rows.topRows<3>().leftCols(kept);
  if (wanted[3] != nullptr && wanted[4] != nullptr && wanted[5] != nullptr)
    cloud.normals = rows.bottomRows<3>().leftCols(kept);
  return cloud;
}

}  // namespace taut::detail
