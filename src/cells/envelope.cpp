// Layers of cells around those that are crossed, across faces: what the paper's fast marching needs to converge. By
// Memoli and Sapiro (2001) the envelope's width must go to zero more slowly than the cells' size; the law here is
// kLayers sqrt(n) layers for n cells across the surface.
#include "taut/cells/find_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cells/memory_guard.hpp"
#include "taut/core/error.hpp"

namespace taut {
namespace {

/// C of the law.
constexpr double kLayers = 0.25;

}  // namespace

CellGrid thicken(const CellGrid& cells, Index layers, const Context& context) {
  if (layers < 0) throw InvalidArgument("an envelope has zero or more layers, not " + std::to_string(layers));
  const std::size_t limit = detail::memory_limit(context);
  CellGrid envelope = cells;
  std::vector<std::int32_t> neighbour(static_cast<std::size_t>(cells.dim()));
  Index begin = 0;
  for (Index layer = 0; layer < layers; ++layer) {
    // Only cells of the last layer have neighbours that are not there yet.
    const Index end = envelope.num_cells();
    for (Index i = begin; i < end; ++i) {
      const auto cell = envelope.cell(i);
      std::copy(cell.begin(), cell.end(), neighbour.begin());
      for (auto& c : neighbour) {
        const std::int32_t centre = c;
        for (const std::int32_t side : {centre - 1, centre + 1}) {
          c = side;
          envelope.insert(neighbour);
        }
        c = centre;
      }
    }
    begin = end;
    context.check_cancelled();
    detail::check_memory(envelope.bytes(), limit, envelope.num_cells(), envelope.size());
  }
  return envelope;
}

Index envelope_layers(const CellGrid& cells) {
  std::int32_t across = 1;
  const auto d = static_cast<std::size_t>(cells.dim());
  const auto coordinates = cells.coordinates();
  for (std::size_t a = 0; a < d; ++a) {
    std::int32_t least = std::numeric_limits<std::int32_t>::max();
    std::int32_t most = std::numeric_limits<std::int32_t>::lowest();
    for (std::size_t c = a; c < coordinates.size(); c += d) {
      least = std::min(least, coordinates[c]);
      most = std::max(most, coordinates[c]);
    }
    across = std::max(across, most - least + 1);
  }
  return static_cast<Index>(std::ceil(kLayers * std::sqrt(static_cast<double>(across))));
}

}  // namespace taut
