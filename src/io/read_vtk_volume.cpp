// Legacy VTK files (version 1 to 5) with DATASET STRUCTURED_POINTS and one SCALARS array on its points. Binary data are
// big-endian.

#include "io/text_reader.hpp"
#include "io/volume_readers.hpp"
#include "io/voxel_data.hpp"

namespace taut::detail {
namespace {

VoxelType voxel_type(const TextReader& reader, std::string_view name) {
  struct Name {
    std::string_view name;
    VoxelType type;
  };
  constexpr std::array kNames = {
      Name{"char", VoxelType::int8},
      Name{"unsigned_char", VoxelType::uint8},
      Name{"signed_char", VoxelType::int8},
      Name{"short", VoxelType::int16},
      Name{"unsigned_short", VoxelType::uint16},
      Name{"int", VoxelType::int32},
      Name{"unsigned_int", VoxelType::uint32},
      Name{"long", VoxelType::int64},
      Name{"unsigned_long", VoxelType::uint64},
      Name{"vtktypeint64", VoxelType::int64},
      Name{"vtktypeuint64", VoxelType::uint64},
      Name{"vtkidtype", VoxelType::int32},
      Name{"float", VoxelType::float32},
      Name{"double", VoxelType::float64},
  };
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  reader.fail("SCALARS of type " + quote(name) + " are not read; save float, double or whole numbers");
}

Eigen::Vector3d read_vector(TextReader& reader, std::string_view what) {
  Eigen::Vector3d v;
  for (double& entry : v) entry = reader.coordinate(what);
  return v;
}

}  // namespace

VoxelVolume read_vtk_volume(const InputFile& file) {
  if (!file.bytes.starts_with("# vtk DataFile")) file.fail("does not start with '# vtk DataFile'; the file is damaged");
  TextReader reader(file, 0);
  reader.next_line();
  reader.next_line();  // the title, which may be anything but blank
  if (!reader.next_line()) file.fail("the file ends inside its header; it is cut short");
  const std::string kind(reader.rest());
  if (kind != "ASCII" && kind != "BINARY")
    reader.fail(quote(kind) + " is neither ASCII nor BINARY; correct the header");

  VoxelVolume volume;
  std::array<std::int64_t, 3> size = {0, 0, 0};
  VoxelType type = VoxelType::uint8;
  bool on_points = true;
  while (true) {
    if (!reader.next_line()) file.fail("has no SCALARS on its points; save structured points with one number each");
    const std::string key = lower(reader.word());
    if (key == "dataset") {
      const std::string dataset = lower(reader.word());
      if (dataset != "structured_points") {
        reader.fail("DATASET " + quote(dataset) + " is no volume; save STRUCTURED_POINTS (image data)");
      }
    } else if (key == "dimensions") {
      for (std::int64_t& extent : size) extent = reader.integer("DIMENSIONS");
    } else if (key == "origin") {
      volume.origin = read_vector(reader, "ORIGIN");
    } else if (key == "spacing" || key == "aspect_ratio") {
      volume.axes = read_vector(reader, "SPACING").asDiagonal();
    } else if (key == "cell_data") {
      on_points = false;
    } else if (key == "point_data") {
      on_points = true;
    } else if (key == "scalars" && on_points) {
      reader.word();  // the name
      type = voxel_type(reader, lower(reader.word()));
      if (!reader.line_is_done() && reader.integer("the number of components") != 1) {
        reader.fail("several numbers a voxel; save one");
      }
      break;
    } else if (key == "field" || (key == "scalars" && !on_points) || key == "vectors" || key == "tensors") {
      reader.fail(quote(key) + " comes before SCALARS on the points; save one array, on the points");
    }
  }
  const std::uint64_t count = count_voxels(file, size, "DIMENSIONS");
  volume.size = to_index(size);
  std::size_t offset = file.bytes.size() - reader.remaining();
  const std::string_view rest = std::string_view(file.bytes).substr(offset);
  if (rest.starts_with("LOOKUP_TABLE") || rest.starts_with("lookup_table")) {
    const std::size_t end = rest.find('\n');
    offset += end == std::string_view::npos ? rest.size() : end + 1;
  }
  if (kind == "ASCII") {
    volume.values = read_text_voxels(file, offset, count);
  } else {
    volume.values = decode_voxels(file, std::string_view(file.bytes).substr(offset), count, type, std::endian::big);
  }
  return volume;
}

}  // namespace taut::detail
