// MetaImage (.mha with the data inside, .mhd with the data in a file of their own): lines "Key = Value" up to
// ElementDataFile, as ITK writes them.

#include "io/header_fields.hpp"
#include "io/volume_readers.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

struct MetaHeader {
  HeaderFields fields;
  std::size_t data_offset = 0;  // of LOCAL data
};

MetaHeader parse_header(const InputFile& file) {
  MetaHeader header{HeaderFields(file), 0};
  std::size_t begin = 0;
  for (std::size_t line = 1; begin < file.bytes.size(); ++line) {
    const std::size_t end = std::min(file.bytes.find('\n', begin), file.bytes.size());
    const std::string_view text = std::string_view(file.bytes).substr(begin, end - begin);
    if (text.find('\0') != std::string_view::npos) break;
    header.fields.add(text, "=", line);
    begin = std::min(end + 1, file.bytes.size());
    if (header.fields.find("ElementDataFile") != nullptr) {
      header.data_offset = begin;
      return header;
    }
  }
  file.fail("the header has no ElementDataFile; the file is cut short or no MetaImage");
}

bool is_true(const std::string* value) {
  return value != nullptr && (*value == "True" || *value == "true" || *value == "1");
}

VoxelType voxel_type(const HeaderFields& fields) {
  struct Name {
    std::string_view name;
    VoxelType type;
  };
  constexpr std::array kNames = {
      Name{"MET_CHAR", VoxelType::int8},       Name{"MET_UCHAR", VoxelType::uint8},
      Name{"MET_SHORT", VoxelType::int16},     Name{"MET_USHORT", VoxelType::uint16},
      Name{"MET_INT", VoxelType::int32},       Name{"MET_UINT", VoxelType::uint32},
      Name{"MET_LONG", VoxelType::int32},      Name{"MET_ULONG", VoxelType::uint32},
      Name{"MET_LONG_LONG", VoxelType::int64}, Name{"MET_ULONG_LONG", VoxelType::uint64},
      Name{"MET_FLOAT", VoxelType::float32},   Name{"MET_DOUBLE", VoxelType::float64},
  };
  const std::string& given = fields.at("ElementType");
  for (const auto& [name, type] : kNames) {
    if (name == given) return type;
  }
  fields.fail("ElementType", quote(given) + " is not read; save numbers of one channel (MET_SHORT, MET_FLOAT, ...)");
}

}  // namespace

VoxelVolume read_metaimage(const InputFile& file) {
  const MetaHeader header = parse_header(file);
  const HeaderFields& fields = header.fields;
  if (fields.integer("NDims") != 3) fields.fail("NDims", "a volume has 3 dimensions; save it as one");
  if (fields.find("ElementNumberOfChannels") != nullptr && fields.integer("ElementNumberOfChannels") != 1) {
    fields.fail("ElementNumberOfChannels", "several numbers a voxel; save one channel");
  }
  const auto extents = fields.integers("DimSize", 3);
  const std::array<std::int64_t, 3> size = {extents[0], extents[1], extents[2]};
  VoxelEncoding encoding{.count = count_voxels(file, size, "DimSize"), .type = voxel_type(fields)};
  const bool msb = is_true(fields.find("BinaryDataByteOrderMSB", "ElementByteOrderMSB"));
  encoding.order = msb ? std::endian::big : std::endian::little;
  encoding.compressed = is_true(fields.find("CompressedData"));

  VoxelVolume volume;
  volume.size = to_index(size);
  const std::string& data_file = fields.at("ElementDataFile");
  if (data_file == "LIST" || data_file.find('%') != std::string::npos) {
    fields.fail("ElementDataFile", "data in several files are not read; save the volume in one");
  }
  const bool local = data_file == "LOCAL" || data_file == "Local" || data_file == "local";
  const InputFile detached = local ? InputFile{} : read_detached(file, data_file);
  const InputFile& source = local ? file : detached;
  std::size_t offset = local ? header.data_offset : 0;
  if (const auto* binary = fields.find("BinaryData"); binary != nullptr && !is_true(binary)) {
    volume.values = read_text_voxels(source, offset, encoding.count);
  } else {
    const std::int64_t skipped = fields.find("HeaderSize") != nullptr ? fields.integer("HeaderSize") : 0;
    const std::uint64_t needed = encoding.count * size_of(encoding.type);
    if (skipped == -1 && source.bytes.size() >= needed) {
      offset = source.bytes.size() - needed;
    } else if (skipped > 0) {
      offset += static_cast<std::size_t>(skipped);
    }
    if (offset > source.bytes.size()) fields.fail("HeaderSize", "is more than the file has; correct the header");
    volume.values = read_voxels(source, std::string_view(source.bytes).substr(offset), encoding);
  }

  auto spacing = fields.numbers("ElementSpacing", 3, "ElementSize");
  if (spacing.empty()) spacing = {1, 1, 1};
  for (const char* name : {"TransformMatrix", "Rotation", "Orientation"}) {
    // Row a is the direction of axis a.
    const auto matrix = fields.numbers(name, 9);
    if (matrix.empty()) continue;
    volume.axes = Eigen::Matrix3d::Map(matrix.data());
    break;
  }
  for (Index a = 0; a < 3; ++a) volume.axes.col(a) *= spacing[static_cast<std::size_t>(a)];
  for (const char* name : {"Offset", "Position", "Origin"}) {
    const auto origin = fields.numbers(name, 3);
    if (origin.empty()) continue;
    volume.origin = Eigen::Vector3d::Map(origin.data());
    break;
  }
  return volume;
}

}  // namespace taut::detail
