#pragma once

#include <array>
#include <cstdint>

#include "io/input_file.hpp"
#include "taut/io/read_surface.hpp"

namespace taut::detail {

/// Reads what `read_volume` promises from bytes already in memory; the path's extension decides the format.
[[nodiscard]] VoxelVolume parse_volume(const InputFile& file, const VolumeFileOptions& options = {});

// One function a format. Each throws IoError on anything wrong.
[[nodiscard]] VoxelVolume read_nifti(const InputFile& file);
[[nodiscard]] VoxelVolume read_nrrd(const InputFile& file);
[[nodiscard]] VoxelVolume read_metaimage(const InputFile& file);
[[nodiscard]] VoxelVolume read_inrimage(const InputFile& file);
[[nodiscard]] VoxelVolume read_vtk_volume(const InputFile& file);
[[nodiscard]] VoxelVolume read_npy_volume(const InputFile& file);
/// OpenVDB reads the file by itself: `file` has its path only.
[[nodiscard]] VoxelVolume read_vdb(const InputFile& file, const std::string& grid_name);

/// Is this the start of an array of three dimensions?
[[nodiscard]] bool is_npy_volume(const InputFile& file);

[[nodiscard]] inline std::array<Index, 3> to_index(const std::array<std::int64_t, 3>& size) {
  return {static_cast<Index>(size[0]), static_cast<Index>(size[1]), static_cast<Index>(size[2])};
}

/// The file that a header names for its data, next to the header unless its path is absolute.
[[nodiscard]] InputFile read_detached(const InputFile& header, const std::string& name);

}  // namespace taut::detail
