#include "search/check_options.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/check_tolerance.hpp"
#include "search/cell_levels.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {

void check_options(const PathOptions& options) {
  check_tolerance(options.tolerance);
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
  check_envelope(options.envelope, options.march);
}

void check_envelope(Index layers, MarchMethod march) {
  if (layers < kEnvelopeByLaw) {
    throw InvalidArgument(fmt::format("envelope {}: an envelope has zero or more layers of cells", layers));
  }
  if (layers != 0 && march == MarchMethod::convergent) {
    throw InvalidArgument("an envelope is for the marches between cell centres, axis and dijkstra");
  }
}

void check_cells(const Surface& surface, const PathOptions& options) {
  if (surface.dim() <= CellLevels::kMostDimensions) return;
  const bool asks = options.march != MarchMethod::convergent || options.cell > 0 || options.envelope != 0 ||
                    options.grid != GridMethod::automatic || options.method == CorrectionMethod::grid;
  const bool fits = options.march == MarchMethod::axis && options.grid == GridMethod::grow && options.envelope == 0;
  if (!asks || fits) return;
  throw InvalidArgument(fmt::format(
      "in {} dimensions (more than {}) paths are found without cells, or on cells that grow where the march "
      "goes: ask for those (option grid grow) with the march along axes (option march axis) and no envelope, or for "
      "neither",
      surface.dim(), CellLevels::kMostDimensions));
}

}  // namespace taut::detail
