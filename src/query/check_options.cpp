#include "query/check_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "taut/core/error.hpp"

namespace taut::detail {

void check_options(const PathOptions& options) {
  if (!(options.tolerance >= 1e-13) || !(options.tolerance <= 1e-3)) {
    throw InvalidArgument(fmt::format("tolerance {}: must be from 1e-13 to 1e-3", options.tolerance));
  }
  if (!(options.spacing >= 0) || !std::isfinite(options.spacing)) {
    throw InvalidArgument(fmt::format("node spacing {}: must be positive, or 0 to have it chosen", options.spacing));
  }
  if (!(options.beta > 0) || !std::isfinite(options.beta)) {
    throw InvalidArgument(fmt::format("beta {}: must be positive", options.beta));
  }
  if (options.beta > 4 && options.flow_step == FlowTimeStep::explicit_euler) {
    throw InvalidArgument(
        fmt::format("beta {}: must be at most 4 with explicit steps, beyond that nodes overshoot the "
                    "surface",
                    options.beta));
  }
}

}  // namespace taut::detail
