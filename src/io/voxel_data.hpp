#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>
#include <vector>

#include "io/input_file.hpp"
#include "io/text_reader.hpp"
#include "taut/core/types.hpp"
#include "taut/surface/volume.hpp"

namespace taut::detail {

enum class VoxelType { int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64 };

/// Bytes of one number.
[[nodiscard]] std::size_t size_of(VoxelType type);

/// Sizes as a header gives them, as the number of voxels. Throws IoError where one is not positive, or their product is
/// more than a file could hold; `where` names them ("DimSize").
[[nodiscard]] std::uint64_t count_voxels(const InputFile& file, const std::array<std::int64_t, 3>& size,
                                         std::string_view where);

/// Refuses `available` bytes that hold fewer than `count` voxels of `type`: before anything is allocated.
void require_bytes(const InputFile& file, std::uint64_t count, VoxelType type, std::uint64_t available);

/// `count` numbers from the start of `bytes`, which hold them.
[[nodiscard]] std::vector<float> decode_voxels(const InputFile& file, std::string_view bytes, std::uint64_t count,
                                               VoxelType type, std::endian order);

/// Where and how the numbers stand in a file.
struct VoxelEncoding {
  std::uint64_t count = 0;
  VoxelType type = VoxelType::uint8;
  std::endian order = std::endian::little;
  bool compressed = false;  ///< gzip or zlib
};

/// The numbers in `bytes`, which may be followed by others. Throws IoError where there are too few.
[[nodiscard]] std::vector<float> read_voxels(const InputFile& file, std::string_view bytes,
                                             const VoxelEncoding& encoding);

/// `count` numbers written as text, from byte `offset` of the file on.
[[nodiscard]] std::vector<float> read_text_voxels(const InputFile& file, std::size_t offset, std::uint64_t count);

/// The bytes of one number of type T, in either order.
template <class T>
[[nodiscard]] T load_number(const char* p, std::endian order) {
  std::array<char, sizeof(T)> raw;
  for (std::size_t i = 0; i < sizeof(T); ++i) raw[i] = order == std::endian::native ? p[i] : p[sizeof(T) - 1 - i];
  return std::bit_cast<T>(raw);
}

/// values * slope + intercept.
void rescale(std::vector<float>& values, double slope, double intercept);

}  // namespace taut::detail
