#include "volume_argument.hpp"

#include <utility>

#include "checks.hpp"
#include "help_format.hpp"
#include "points_argument.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_surface.hpp"
#include "taut/surface/volume.hpp"

namespace taut::app {

void VolumeArguments::add_to(CLI::App& command) {
  const OptionGroup group(command, "Volumes");
  command.add_option("--iso", iso, "the surface is where the volume has this value")->check(any_number());
  command.add_option("--label", label, "the surface bounds the voxels of this value, smoothed by --smooth voxels (1)")
      ->check(any_number());
  command.add_option("--grid-name", grid_name, "which grid of a .vdb file (default: its only one)");
}

const char* VolumeArguments::given() const {
  if (iso) return "--iso";
  if (label) return "--label";
  return grid_name.empty() ? nullptr : "--grid-name";
}

Surface load_volume(const std::string& file, const VolumeArguments& arguments, std::optional<double> smooth,
                    const Context& context) {
  VoxelVolume volume = read_volume(file, {.grid_name = arguments.grid_name}, context);
  const bool has_level = arguments.iso || arguments.label;
  try {
    return volume_surface(std::move(volume), {.iso = arguments.iso, .label = arguments.label, .smooth = smooth},
                          context);
  } catch (const InvalidArgument& error) {
    if (!has_level) throw UsageError(file + ": " + error.what());
    throw IoError(file, error.what());
  } catch (const EmptySurface& error) {
    throw EmptySurface(file + ": " + error.what());
  }
}

}  // namespace taut::app
