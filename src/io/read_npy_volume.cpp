// NumPy's .npy as a volume: entry [i, j, k] of the array is the voxel at (i, j, k).

#include "io/npy_header.hpp"
#include "io/volume_readers.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

constexpr std::size_t kDimensions = 3;

VoxelType voxel_type(const InputFile& file, const std::string& descr) {
  struct Name {
    std::string_view code;
    VoxelType type;
  };
  constexpr std::array kNames = {
      Name{"b1", VoxelType::uint8},   Name{"i1", VoxelType::int8},    Name{"u1", VoxelType::uint8},
      Name{"i2", VoxelType::int16},   Name{"u2", VoxelType::uint16},  Name{"i4", VoxelType::int32},
      Name{"u4", VoxelType::uint32},  Name{"i8", VoxelType::int64},   Name{"u8", VoxelType::uint64},
      Name{"f4", VoxelType::float32}, Name{"f8", VoxelType::float64},
  };
  for (const auto& [code, type] : kNames) {
    if (std::string_view(descr).substr(std::min<std::size_t>(1, descr.size())) == code) return type;
  }
  file.fail("numbers of type " + quote(descr) +
            " are not supported; save float32, float64 or integers (array.astype('f4'))");
}

}  // namespace

bool is_npy_volume(const InputFile& file) { return parse_npy_header(file).shape.size() == kDimensions; }

VoxelVolume read_npy_volume(const InputFile& file) {
  const NpyHeader header = parse_npy_header(file);
  if (header.shape.size() != kDimensions) {
    file.fail("the array has " + counted(header.shape.size(), "dimension") + "; a volume has shape (nx, ny, nz)");
  }
  std::array<std::int64_t, kDimensions> size;
  for (std::size_t a = 0; a < kDimensions; ++a) size[a] = static_cast<std::int64_t>(header.shape[a]);
  const std::uint64_t count = count_voxels(file, size, "shape");
  const std::endian order = header.descr.starts_with('>') ? std::endian::big : std::endian::little;
  VoxelVolume volume;
  volume.size = to_index(size);
  if (!header.fortran_order) {
    // The last index runs fastest: the same voxels, their axes named the other way round.
    std::swap(volume.size[0], volume.size[2]);
    volume.axes = Eigen::Matrix3d::Identity().rowwise().reverse();
  }
  volume.values = decode_voxels(file, std::string_view(file.bytes).substr(header.data_offset), count,
                                voxel_type(file, header.descr), order);
  return volume;
}

}  // namespace taut::detail
