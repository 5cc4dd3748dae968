#pragma once

#include <string>

#include "load_surface.hpp"

namespace taut::app {

/// All that says which surface it is, in one line: results that were made for another one are not continued. Of a file,
/// its name and time.
[[nodiscard]] std::string surface_request(const SurfaceArguments& arguments);

}  // namespace taut::app
