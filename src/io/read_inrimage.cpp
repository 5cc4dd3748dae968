// Inrimage 4 (.inr): lines KEY=VALUE in a header of a multiple of 256 bytes that ends in "##}" and a newline.

#include "io/header_fields.hpp"
#include "io/inflate.hpp"
#include "io/volume_readers.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

constexpr std::string_view kMark = "#INRIMAGE-4#{";
constexpr std::string_view kEnd = "##}\n";
constexpr std::size_t kMostHeader = 65'536;
constexpr std::uint64_t kMostRatio = 1032;  // of deflate

VoxelType voxel_type(const HeaderFields& fields) {
  const std::string type = lower(fields.at("TYPE"));
  const auto bits = static_cast<int>(std::strtol(fields.at("PIXSIZE").c_str(), nullptr, 10));
  const bool is_signed = type.starts_with("signed");
  if (type == "float" && bits == 32) return VoxelType::float32;
  if ((type == "float" && bits == 64) || type == "double") return VoxelType::float64;
  if (type.ends_with("fixed")) {
    switch (bits) {
      case 8: return is_signed ? VoxelType::int8 : VoxelType::uint8;
      case 16: return is_signed ? VoxelType::int16 : VoxelType::uint16;
      case 32: return is_signed ? VoxelType::int32 : VoxelType::uint32;
      default: break;
    }
  }
  fields.fail("TYPE", quote(type) + " of " + std::to_string(bits) +
                          " bits is not read; save float, unsigned fixed or signed fixed");
}

std::endian byte_order(const HeaderFields& fields) {
  const std::string* cpu = fields.find("CPU");
  if (cpu == nullptr || *cpu == "decm" || *cpu == "pc" || *cpu == "alpha") return std::endian::little;
  if (*cpu == "sun" || *cpu == "sgi") return std::endian::big;
  fields.fail("CPU", quote(*cpu) + " is none of decm, pc, alpha, sun, sgi");
}

}  // namespace

VoxelVolume read_inrimage(const InputFile& file) {
  const bool packed = file.bytes.starts_with("\x1F\x8B");
  const std::string start = packed ? inflate(file, file.bytes, kMostHeader) : file.bytes.substr(0, kMostHeader);
  const std::size_t end = start.find(kEnd);
  if (!start.starts_with(kMark) || end == std::string::npos) {
    file.fail("does not start with a header from #INRIMAGE-4#{ to ##}; the file is damaged or no Inrimage");
  }
  HeaderFields fields(file);
  std::size_t line = 1;
  for (std::size_t begin = 0; begin < end; ++line) {
    const std::size_t stop = start.find('\n', begin);
    fields.add(std::string_view(start).substr(begin, stop - begin), "=", line);
    begin = stop + 1;
  }
  const std::array<std::int64_t, 3> size = {fields.integer("XDIM"), fields.integer("YDIM"), fields.integer("ZDIM")};
  if (fields.find("VDIM") != nullptr && fields.integer("VDIM") != 1) {
    fields.fail("VDIM", "several numbers a voxel; save one");
  }
  const VoxelEncoding encoding{
      .count = count_voxels(file, size, "XDIM, YDIM, ZDIM"), .type = voxel_type(fields), .order = byte_order(fields)};
  VoxelVolume volume;
  volume.size = to_index(size);
  Index axis = 0;
  for (const auto& [spacing, translation] : {std::pair{"VX", "TX"}, std::pair{"VY", "TY"}, std::pair{"VZ", "TZ"}}) {
    if (const auto given = fields.numbers(spacing, 1); !given.empty()) volume.axes(axis, axis) = given[0];
    if (const auto given = fields.numbers(translation, 1); !given.empty()) volume.origin(axis) = given[0];
    ++axis;
  }
  const std::size_t offset = end + kEnd.size();
  if (packed) {
    require_bytes(file, encoding.count, encoding.type, file.bytes.size() * kMostRatio);
    const std::string bytes = inflate(file, file.bytes, offset + encoding.count * size_of(encoding.type));
    volume.values = read_voxels(file, std::string_view(bytes).substr(std::min(offset, bytes.size())), encoding);
  } else {
    volume.values = read_voxels(file, std::string_view(file.bytes).substr(offset), encoding);
  }
  return volume;
}

}  // namespace taut::detail
