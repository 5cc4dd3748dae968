#include "io/voxel_data.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "io/inflate.hpp"

namespace taut::detail {
namespace {

/// More voxels than any machine holds as floats.
constexpr std::uint64_t kMostVoxels = std::uint64_t{1} << 40;
/// Deflate packs no better.
constexpr std::uint64_t kMostRatio = 1032;
constexpr Index kDecodedAtOnce = Index{1} << 20;

template <class T>
void decode(const InputFile& file, const char* from, std::vector<float>& to, std::endian order) {
  parallel_for(file.context, 0, static_cast<Index>(to.size()), kDecodedAtOnce, [&](Index first, Index last) {
    const char* p = from + static_cast<std::size_t>(first) * sizeof(T);
    if (order == std::endian::native) {
      for (Index i = first; i < last; ++i, p += sizeof(T)) {
        to[static_cast<std::size_t>(i)] = static_cast<float>(load_number<T>(p, std::endian::native));
      }
    } else {
      for (Index i = first; i < last; ++i, p += sizeof(T)) {
        to[static_cast<std::size_t>(i)] = static_cast<float>(load_number<T>(p, order));
      }
    }
  });
}

}  // namespace

std::size_t size_of(VoxelType type) {
  switch (type) {
    case VoxelType::int8:
    case VoxelType::uint8: return 1;
    case VoxelType::int16:
    case VoxelType::uint16: return 2;
    case VoxelType::int32:
    case VoxelType::uint32:
    case VoxelType::float32: return 4;
    case VoxelType::int64:
    case VoxelType::uint64:
    case VoxelType::float64: return 8;
  }
  return 1;
}

std::uint64_t count_voxels(const InputFile& file, const std::array<std::int64_t, 3>& size, std::string_view where) {
  std::uint64_t count = 1;
  for (const std::int64_t extent : size) {
    if (extent < 1) {
      file.fail(std::string(where) + ": a volume of " + std::to_string(size[0]) + " x " + std::to_string(size[1]) +
                " x " + std::to_string(size[2]) + " voxels; sizes must be at least 1");
    }
    if (static_cast<std::uint64_t>(extent) > kMostVoxels / count) {
      file.fail(std::string(where) + ": " + std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
                std::to_string(size[2]) + " voxels are more than any file holds; the header is wrong");
    }
    count *= static_cast<std::uint64_t>(extent);
  }
  return count;
}

void require_bytes(const InputFile& file, std::uint64_t count, VoxelType type, std::uint64_t available) {
  if (count <= available / size_of(type)) return;
  file.fail("the header announces " + counted(count, "voxel") + " of " + counted(size_of(type), "byte") + ", but " +
            counted(available, "byte") + (available == 1 ? " follows" : " follow") +
            "; the file is cut short or its header is wrong");
}

std::vector<float> decode_voxels(const InputFile& file, std::string_view bytes, std::uint64_t count, VoxelType type,
                                 std::endian order) {
  require_bytes(file, count, type, bytes.size());
  std::vector<float> values(static_cast<std::size_t>(count));
  const char* from = bytes.data();
  switch (type) {
    case VoxelType::int8: decode<std::int8_t>(file, from, values, order); break;
    case VoxelType::uint8: decode<std::uint8_t>(file, from, values, order); break;
    case VoxelType::int16: decode<std::int16_t>(file, from, values, order); break;
    case VoxelType::uint16: decode<std::uint16_t>(file, from, values, order); break;
    case VoxelType::int32: decode<std::int32_t>(file, from, values, order); break;
    case VoxelType::uint32: decode<std::uint32_t>(file, from, values, order); break;
    case VoxelType::int64: decode<std::int64_t>(file, from, values, order); break;
    case VoxelType::uint64: decode<std::uint64_t>(file, from, values, order); break;
    case VoxelType::float32: decode<float>(file, from, values, order); break;
    case VoxelType::float64: decode<double>(file, from, values, order); break;
  }
  return values;
}

std::vector<float> read_voxels(const InputFile& file, std::string_view bytes, const VoxelEncoding& encoding) {
  if (!encoding.compressed) return decode_voxels(file, bytes, encoding.count, encoding.type, encoding.order);
  require_bytes(file, encoding.count, encoding.type, bytes.size() * kMostRatio);
  const std::string unpacked = inflate(file, bytes, encoding.count * size_of(encoding.type));
  return decode_voxels(file, unpacked, encoding.count, encoding.type, encoding.order);
}

std::vector<float> read_text_voxels(const InputFile& file, std::size_t offset, std::uint64_t count) {
  require_bytes(file, count, VoxelType::uint16, file.bytes.size() - offset + 1);  // a digit and a blank at least
  std::vector<float> values(static_cast<std::size_t>(count));
  const auto lines_before =
      std::count(file.bytes.begin(), file.bytes.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
  TextReader reader(file, 0, offset, static_cast<std::size_t>(lines_before) + 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    while (reader.line_is_done()) {
      if (reader.next_line()) continue;
      file.fail("the file ends after " + std::to_string(i) + " of " + counted(count, "voxel") +
                "; it is cut short or its header is wrong");
    }
    values[i] = static_cast<float>(reader.number("a voxel"));
  }
  return values;
}

void rescale(std::vector<float>& values, double slope, double intercept) {
  for (float& value : values) value = static_cast<float>(slope * static_cast<double>(value) + intercept);
}

}  // namespace taut::detail
