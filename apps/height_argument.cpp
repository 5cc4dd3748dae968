#include "height_argument.hpp"

#include "checks.hpp"
#include "points_argument.hpp"
#include "taut/core/error.hpp"
#include "taut/io/read_surface.hpp"
#include "taut/surface/height_field.hpp"

namespace taut::app {

void HeightArguments::add_to(CLI::App& command) {
  constexpr const char* kGroup = "Heights";
  command.add_flag("--heights", heights, "an .npy array of two dimensions holds heights, not points")->group(kGroup);
  command.add_option("--pixel", pixel, "how far apart heights stand: H, or HX,HY (default 1)")->group(kGroup);
  command.add_option("--z-scale", z_scale, "heights are multiplied by this (default 1)")
      ->check(any_number())
      ->group(kGroup);
  command.add_option("--no-data", no_data, "heights of this value were not measured; NaN never was")
      ->check(any_number())
      ->group(kGroup);
}

const char* HeightArguments::given() const {
  if (heights) return "--heights";
  if (!pixel.empty()) return "--pixel";
  if (z_scale) return "--z-scale";
  return no_data ? "--no-data" : nullptr;
}

bool is_height_file(const std::string& file, const HeightArguments& arguments) {
  return is_height_picture(file) || (arguments.heights && file.ends_with(".npy"));
}

Surface load_heights(const std::string& file, const HeightArguments& arguments, const Context& context) {
  HeightField field = read_height_field(file, context);
  if (!arguments.pixel.empty()) {
    const Vector pixel = parse_numbers(arguments.pixel, "--pixel");
    if (pixel.size() > 2) throw UsageError("--pixel " + arguments.pixel + ": give one number, or two: HX,HY");
    field.pixel_x = pixel(0);
    field.pixel_y = pixel(pixel.size() - 1);
  }
  try {
    return height_surface(field, {.z_scale = arguments.z_scale.value_or(1), .no_data = arguments.no_data}, context);
  } catch (const InvalidArgument& error) {
    throw IoError(file, error.what());
  }
}

}  // namespace taut::app
