// The cells that a march starts from: the valid ones of the 3^d block around a point of the surface. The point's own
// cell may be missing among them, when it lies on a face or the cells were made by growing.
#include "march/start.hpp"

#include <algorithm>
#include <iterator>
#include <span>

#include "march/stencil.hpp"
#include "surface/describe.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {

std::vector<Index> cells_around(const SurfaceCells& cells, const VectorIn& x) {
  std::vector<std::int32_t> cell(static_cast<std::size_t>(x.size()));
  cells.grid().cell_of(x, cell);
  Stencil stencil(x.size());
  const std::span<const Index> block = stencil.block(cells.grid(), cell);
  std::vector<Index> valid;
  std::copy_if(block.begin(), block.end(), std::back_inserter(valid), [&](Index i) { return cells.valid(i); });
  return valid;
}

std::vector<Index> cells_around_source(const SurfaceCells& cells, const VectorIn& source) {
  std::vector<Index> valid = cells_around(cells, source);
  if (valid.empty()) throw InvalidArgument("no cell lies around the source " + describe(source));
  return valid;
}

}  // namespace taut::detail
