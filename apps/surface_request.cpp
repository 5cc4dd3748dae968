#include "surface_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <system_error>

namespace taut::app {

std::string surface_request(const SurfaceArguments& arguments) {
  constexpr double kUnset = std::numeric_limits<double>::quiet_NaN();
  std::string text = fmt::format(
      "{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", arguments.surface, arguments.dim.value_or(0),
      arguments.variables, fmt::join(arguments.parameters, " "), fmt::join(arguments.domain, " "), arguments.box,
      arguments.samples, static_cast<int>(arguments.fit.method), arguments.fit.smoothing.value_or(-1),
      arguments.fit.max_samples, arguments.fit.support_radius, arguments.volume.iso.value_or(kUnset),
      arguments.volume.label.value_or(kUnset), arguments.volume.grid_name, arguments.height.heights,
      arguments.height.pixel, arguments.height.z_scale.value_or(kUnset), arguments.height.no_data.value_or(kUnset),
      arguments.network.activation ? static_cast<int>(*arguments.network.activation) : -1, arguments.network.omega,
      arguments.network.beta.value_or(kUnset));
  if (!names_a_file(arguments.surface)) return text;
  std::error_code ignored;
  const auto time = std::filesystem::last_write_time(arguments.surface, ignored).time_since_epoch().count();
  return text + fmt::format(" {}", time);
}

}  // namespace taut::app
