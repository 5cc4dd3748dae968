#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "taut/core/context.hpp"
#include "taut/surface/fit.hpp"
#include "taut/surface/formula.hpp"
#include "taut/surface/height_field.hpp"
#include "taut/surface/neural_network.hpp"
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

/// Does the extension name a picture that `read_height_field` reads: `.pgm` or `.png`?
[[nodiscard]] bool is_height_picture(const std::filesystem::path& path);

/// Reads heights from a grey picture (`.pgm`, plain or raw, of 8 or 16 bits; `.png` of up to 16 bits) or from an `.npy`
/// array of two dimensions. Values come as they are in the file, with no gamma, one pixel = 1 unit.
///  - A picture: column i stands at x = i, the lowest row at y = 0, as it is seen.
///  - An array: entry [j, i] stands at x = i, y = j, as it is indexed.
/// Throws IoError for what cannot be read (colours, three dimensions, a cut file), naming the file; Cancelled.
[[nodiscard]] HeightField read_height_field(const std::filesystem::path& path, const Context& context = {});

/// The surface that a clause file (.vm) describes, see `parse_clauses`. Throws IoError for a file that cannot be read
/// or has a bad clause (which it names by its line), InvalidArgument for the options.
[[nodiscard]] Surface read_clauses(const std::filesystem::path& path, const FormulaOptions& options = {},
                                   const Context& context = {});

/// The surface that a scene file (.scene) describes, see `parse_scene`. Throws IoError for a file that cannot be read
/// or has a bad line (which it names), InvalidArgument for the options.
[[nodiscard]] Surface read_scene(const std::filesystem::path& path, const FormulaOptions& options = {},
                                 const Context& context = {});

/// Does the extension name a file of weights: `.npz` or `.safetensors`?
[[nodiscard]] bool is_network_file(const std::filesystem::path& path);

/// What a file of weights may leave open, or say otherwise.
struct NetworkFileOptions {
  std::optional<Activation> activation = std::nullopt;
  std::optional<double> frequency = std::nullopt;
  std::optional<double> first_frequency = std::nullopt;  ///< unset = as `frequency`
  std::optional<double> sharpness = std::nullopt;
};

/// Reads a multilayer perceptron from a NumPy archive (`.npz`, packed or not) or a `.safetensors` file. The layers are
/// the arrays of two dimensions, in the order of the numbers in their names ("net.10.weight" after "net.9.weight",
/// "W1" after "W0"), out x in as PyTorch has them, or all of them in x out; each has the array of one dimension that is
/// called "bias" for "weight" or "kernel", "b1" for "W1" (none: zero). Numbers of 16, 32 and 64 bits. What else is
/// needed stands in arrays "activation" (text: sine, softplus, tanh), "omega", "omega_first" and "beta" (of an `.npz`),
/// in the metadata of those names (of a `.safetensors`), or in `options`, which come first. A sine without omega has
/// 30, a softplus without beta 1.
/// Throws IoError, naming the file, for what cannot be read, arrays that make no perceptron (skip connections, normal-
/// isation), an activation that is not said, and one that is not C^2, such as relu.
[[nodiscard]] NeuralNetwork read_neural_network(const std::filesystem::path& path,
                                                const NetworkFileOptions& options = {}, const Context& context = {});

/// Writes a fitted model to a `.taut` file, which appears whole or not at all. `read_model` gives back every bit.
/// Throws IoError with the system's reason.
void write_model(const std::filesystem::path& path, const FitModel& model);

/// Reads what `write_model` wrote, on any machine. Throws IoError for a file that is no model, of another version, cut
/// short or damaged anywhere (it ends with a checksum); nothing is allocated on a count's word alone.
[[nodiscard]] FitModel read_model(const std::filesystem::path& path, const Context& context = {});

}  // namespace taut
