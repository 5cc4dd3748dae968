#include "march/start.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <span>
#include <string>

#include "march/stencil.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {

std::string describe_point(const VectorIn& x) {
  std::string text = "(";
  char number[32];
  for (Index i = 0; i < x.size(); ++i) {
    std::snprintf(number, sizeof number, "%s%.6g", i > 0 ? ", " : "", x(i));
    text += number;
  }
  return text + ")";
}

std::vector<Index> cells_around_source(const SurfaceCells& cells, const VectorIn& source) {
  std::vector<std::int32_t> cell(static_cast<std::size_t>(source.size()));
  cells.grid().cell_of(source, cell);
  Stencil stencil(source.size());
  const std::span<const Index> block = stencil.block(cells.grid(), cell);
  std::vector<Index> valid;
  std::copy_if(block.begin(), block.end(), std::back_inserter(valid), [&](Index i) { return cells.valid(i); });
  if (valid.empty()) throw InvalidArgument("no cell lies around the source " + describe_point(source));
  return valid;
}

}  // namespace taut::detail
