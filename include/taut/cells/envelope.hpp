#pragma once

#include "taut/cells/cell_grid.hpp"
#include "taut/core/context.hpp"

namespace taut {

/// The paper's envelope of a surface (sec. 3.1), as thick as marching in it wants it: the cells given and `layers` >= 0
/// layers around them, each the 2 d neighbours across faces (the paper's Figure 1) of the one before, whether the
/// surface goes through them or not. The cells given come first, in their order. Every point of the envelope lies
/// within (layers + sqrt d) cells of a cell given; where the surface is smooth it is at least layers / sqrt d cells
/// thick on either side. Where cells end, at the edge of a box or a domain, it reaches as far over the edge; sheets
/// closer than twice its reach grow together. Throws InvalidArgument for layers < 0, OutOfMemory.
[[nodiscard]] CellGrid thicken(const CellGrid& cells, Index layers, const Context& context = {});

/// The layers with which distances marched in the envelope converge like sqrt(h) (Memoli and Sapiro 2001; docs/march.md
/// has the measurement): C sqrt(L / h), L the longest side of the cells' box, so that the envelope gets thinner, but
/// slower than its cells.
[[nodiscard]] Index envelope_layers(const CellGrid& cells);

}  // namespace taut
