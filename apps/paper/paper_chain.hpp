#pragma once

#include "taut/core/context.hpp"
#include "taut/curve/flow.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/surface.hpp"

namespace taut::paper {

/// The paper's chain, step by step: cells, fast marching, the path on the grid, its projection and correction.
struct ChainOptions {
  double cell = 0;  ///< sigma, model units
  MarchMethod march = MarchMethod::axis;
  /// Layers of cells around those that the surface crosses; negative = as many as the error bound wants.
  Index layers = 0;
  FlowOptions flow = {};
};

struct Chain {
  Index num_cells = 0;   ///< that the surface crosses
  Index num_layers = 0;  ///< around them
  Points cells;          ///< d x n: centres of those that the march reached
  double marched = 0;    ///< distance of the ends by the march
  Points grid_path;      ///< d x m
  FlowResult flow;
};

/// From p to q (d each, on the surface): Algorithm II from the surface's samples where it has some, else Algorithm I.
[[nodiscard]] Chain run_chain(const Surface& surface, const VectorIn& p, const VectorIn& q, const ChainOptions& options,
                              const Context& context = {});

}  // namespace taut::paper
