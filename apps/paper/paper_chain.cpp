#include "paper_chain.hpp"

#include <cmath>

#include "taut/cells/find_cells.hpp"
#include "taut/cells/surface_cells.hpp"
#include "taut/march/march.hpp"

namespace taut::paper {

Chain run_chain(const Surface& surface, const VectorIn& p, const VectorIn& q, const ChainOptions& options,
                const Context& context) {
  CellGrid grid = surface.samples() != nullptr
                      ? grow(surface, surface.samples()->points, options.cell, context)  // Algorithm II
                      : subdivide(surface, {.size = options.cell}, context);             // Algorithm I
  SurfaceCells cells(surface, std::move(grid), context);
  Chain chain;
  chain.num_cells = cells.num_cells();
  chain.num_layers = options.layers < 0 ? envelope_layers(cells.grid()) : options.layers;
  if (chain.num_layers > 0) cells = cells.thickened(chain.num_layers, context);
  const DistanceField field = march(surface, cells, p, {.method = options.march, .target = Vector(q)}, context);
  chain.marched = field.target_distance;
  chain.cells.resize(surface.dim(), field.num_reached);
  Index count = 0;
  for (Index i = 0; i < field.distance.size(); ++i) {
    if (std::isfinite(field.distance(i))) chain.cells.col(count++) = cells.grid().centre(i);
  }
  chain.grid_path = descend(surface, cells, field, q);
  FlowOptions flow = options.flow;
  flow.lattice = {.size = options.cell, .origin = cells.grid().origin()};
  if (chain.grid_path.cols() > 1) chain.flow = correct_flow(surface, chain.grid_path, flow, context);
  return chain;
}

}  // namespace taut::paper
