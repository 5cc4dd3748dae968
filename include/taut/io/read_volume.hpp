#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/surface/volume.hpp"

namespace taut {

/// Extensions `read_volume` knows, lower case with their dot: ".nii", ".nii.gz", ...
[[nodiscard]] const std::vector<std::string>& volume_extensions();

/// Is this a file for `read_volume`, rather than for `read_point_cloud`? The extension tells, but of `.npy` and `.vtk`
/// the first bytes are looked at: an array of three dimensions, structured points. False for a file that cannot be
/// read.
[[nodiscard]] bool is_volume_file(const std::filesystem::path& path);

struct VolumeFileOptions {
  std::string grid_name = {};  ///< which grid of a `.vdb` file; empty = its only one
};

/// Reads a volume with its place in the world. The extension decides the format, in either case: `.nii`, `.nii.gz`
/// (NIfTI-1 and 2), `.nrrd`, `.nhdr`, `.mha`, `.mhd` (MetaImage), `.inr`, `.inr.gz` (Inrimage 4), `.vtk` (legacy
/// structured points), `.npy` (three dimensions) and, where Taut was built with OpenVDB, `.vdb`. All number types of up
/// to 64 bits and both byte orders; docs/volumes.md says which parts of each format are read. Coordinates stay in the
/// system and the unit of the file; without any, a voxel is a unit cube with its centre at whole numbers.
///
/// Throws IoError, which names the file, what is wrong and what to do: a missing, cut or damaged file, sizes that are
/// not positive or do not fit the file (before anything is allocated for them), several numbers a voxel, an encoding
/// that is not read, options that do not fit the format. Values that are not finite come as they are. Throws Cancelled.
/// Memory: the file, its unpacked bytes, and 4 bytes a voxel.
[[nodiscard]] VoxelVolume read_volume(const std::filesystem::path& path, const VolumeFileOptions& options = {},
                                      const Context& context = {});

}  // namespace taut
