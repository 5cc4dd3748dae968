// NRRD (teem's "nearly raw raster data", versions 1 to 5): lines "field: value" up to a blank one, then the data, or
// data in a file of their own (.nhdr).

#include <algorithm>

#include "io/header_fields.hpp"
#include "io/volume_readers.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

struct NrrdHeader {
  HeaderFields fields;
  std::size_t data_offset = 0;
};

NrrdHeader parse_header(const InputFile& file) {
  if (!file.bytes.starts_with("NRRD000")) file.fail("does not start with NRRD000; the file is damaged or no NRRD file");
  NrrdHeader header{HeaderFields(file), file.bytes.size()};
  std::size_t begin = file.bytes.find('\n');
  for (std::size_t line = 2; begin < file.bytes.size(); ++line) {
    ++begin;
    const std::size_t end = std::min(file.bytes.find('\n', begin), file.bytes.size());
    std::string_view text = std::string_view(file.bytes).substr(begin, end - begin);
    if (text.ends_with('\r')) text.remove_suffix(1);
    begin = end;
    if (text.empty()) {
      header.data_offset = std::min(end + 1, file.bytes.size());
      break;
    }
    if (!text.starts_with('#') && text.find(":=") == std::string_view::npos) header.fields.add(text, ":", line);
  }
  return header;
}

VoxelType voxel_type(const HeaderFields& fields) {
  struct Names {
    VoxelType type;
    std::string_view names;  // without blanks, between blanks
  };
  constexpr std::array kNames = {
      Names{VoxelType::int8, " signedchar int8 int8_t "},
      Names{VoxelType::uint8, " uchar unsignedchar uint8 uint8_t "},
      Names{VoxelType::int16, " short shortint signedshort signedshortint int16 int16_t "},
      Names{VoxelType::uint16, " ushort unsignedshort unsignedshortint uint16 uint16_t "},
      Names{VoxelType::int32, " int signedint int32 int32_t "},
      Names{VoxelType::uint32, " uint unsignedint uint32 uint32_t "},
      Names{VoxelType::int64, " longlong longlongint signedlonglong signedlonglongint int64 int64_t "},
      Names{VoxelType::uint64, " ulonglong unsignedlonglong unsignedlonglongint uint64 uint64_t "},
      Names{VoxelType::float32, " float "},
      Names{VoxelType::float64, " double "},
  };
  const std::string& given = fields.at("type");
  std::string wanted = lower(given);
  std::erase(wanted, ' ');
  wanted.insert(0, 1, ' ');
  wanted.push_back(' ');
  for (const auto& [type, names] : kNames) {
    if (names.find(wanted) != std::string_view::npos) return type;
  }
  fields.fail("type", quote(given) + " is not read; save numbers of up to 64 bits");
}

/// The skips that come before the data.
std::string_view after_skips(const InputFile& file, std::string_view bytes, const HeaderFields& fields,
                             const VoxelEncoding& encoding) {
  if (fields.find("line skip", "lineskip") != nullptr) {
    for (std::int64_t n = fields.integer("line skip"); n > 0; --n) {
      const std::size_t end = bytes.find('\n');
      if (end == std::string_view::npos) fields.fail("line skip", "skips more lines than there are");
      bytes.remove_prefix(end + 1);
    }
  }
  if (fields.find("byte skip", "byteskip") != nullptr) {
    const std::int64_t skip = fields.integer("byte skip");
    const std::uint64_t needed = encoding.count * size_of(encoding.type);
    if (skip == -1) {
      require_bytes(file, encoding.count, encoding.type, bytes.size());
      bytes.remove_prefix(bytes.size() - needed);
    } else {
      if (skip < 0 || static_cast<std::uint64_t>(skip) > bytes.size()) {
        fields.fail("byte skip", "skips more than there is");
      }
      bytes.remove_prefix(static_cast<std::size_t>(skip));
    }
  }
  return bytes;
}

/// Spacing, direction and origin of the voxels.
void place(const HeaderFields& fields, VoxelVolume& volume) {
  if (fields.find("space directions") != nullptr) {
    const auto directions = fields.numbers("space directions", 9);
    volume.axes = Eigen::Matrix3d::Map(directions.data());
    const auto origin = fields.numbers("space origin", 3);
    if (!origin.empty()) volume.origin = Eigen::Vector3d::Map(origin.data());
    return;
  }
  const auto spacings = fields.numbers("spacings", 3);
  const auto lower_ends = fields.numbers("axis mins", 3, "axismins");
  const std::string* centers = fields.find("centers", "centerings");
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Index>(a);
    if (!spacings.empty()) volume.axes(axis, axis) = spacings[a];
    if (lower_ends.empty()) continue;
    const bool cells = centers != nullptr && centers->find("cell") != std::string::npos;
    volume.origin(axis) = lower_ends[a] + (cells ? 0.5 * volume.axes(axis, axis) : 0);
  }
}

}  // namespace

VoxelVolume read_nrrd(const InputFile& file) {
  const NrrdHeader header = parse_header(file);
  const HeaderFields& fields = header.fields;
  if (fields.integer("dimension") != 3) {
    fields.fail("dimension", "a volume has 3 dimensions, one number a voxel; save it so");
  }
  const auto extents = fields.integers("sizes", 3);
  const std::array<std::int64_t, 3> size = {extents[0], extents[1], extents[2]};
  VoxelEncoding encoding{.count = count_voxels(file, size, "sizes"), .type = voxel_type(fields)};
  if (const std::string* endian = fields.find("endian"); endian != nullptr && lower(*endian) == "big") {
    encoding.order = std::endian::big;
  }
  VoxelVolume volume;
  volume.size = to_index(size);
  place(fields, volume);

  const std::string* data_file = fields.find("data file", "datafile");
  if (data_file != nullptr && (data_file->starts_with("LIST") || data_file->find('%') != std::string::npos)) {
    fields.fail("data file", "data in several files are not read; save the volume in one");
  }
  const InputFile detached = data_file != nullptr ? read_detached(file, *data_file) : InputFile{};
  const InputFile& source = data_file != nullptr ? detached : file;
  const std::size_t offset = data_file != nullptr ? 0 : header.data_offset;
  const std::string_view bytes = after_skips(source, std::string_view(source.bytes).substr(offset), fields, encoding);

  const std::string kind = lower(fields.at("encoding"));
  if (kind == "ascii" || kind == "text" || kind == "txt") {
    volume.values = read_text_voxels(source, source.bytes.size() - bytes.size(), encoding.count);
  } else if (kind == "raw" || kind == "gzip" || kind == "gz") {
    encoding.compressed = kind != "raw";
    volume.values = read_voxels(source, bytes, encoding);
  } else {
    fields.fail("encoding", quote(kind) + " is not read; save it as raw, gzip or ascii");
  }
  return volume;
}

}  // namespace taut::detail
