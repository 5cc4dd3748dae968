#pragma once

#include <utility>

#include "taut/curve/flow.hpp"
#include "taut/search/path_options.hpp"

namespace taut::detail {

/// What a path's options say about the flow, for a start that was walked on the cells of `lattice`.
[[nodiscard]] inline FlowOptions flow_options(const PathOptions& options, FlowLattice lattice) {
  return {.spacing = options.spacing,
          .nodes = options.flow_nodes,
          .lattice = std::move(lattice),
          .beta = options.beta,
          .time_step = options.flow_step};
}

}  // namespace taut::detail
