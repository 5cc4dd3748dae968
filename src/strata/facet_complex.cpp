#include "strata/facet_complex.hpp"

#include <utility>

#include "strata/facet_graph.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// Cells of the graph that edges are found by, about: some 40 to 70 ms.
constexpr double kCells = 4000;
/// Edges may lie in the sides of a tight box: it is made larger by this part.
constexpr double kMargin = 1e-3;

}  // namespace

std::optional<FacetComplex> FacetComplex::of(const Surface& surface, const Box& box, const Context& context) {
  if (surface.samples() != nullptr) return std::nullopt;
  FacetComplex complex{FacetedSurface::of(surface), {}};
  if (!complex.surface) return std::nullopt;
  const Vector margin = Vector::Constant(3, kMargin * box.diagonal());
  const Box wide{box.lower - margin, box.upper + margin};
  complex.surface->scale = wide.diagonal();
  try {
    const double size = cell_size_for(*complex.surface, wide, kCells, context);
    const FacetGraph graph(*complex.surface, wide, size, context);
    if (!graph.complete()) return std::nullopt;
    complex.network = edge_network(*complex.surface, graph, context);
  } catch (const EmptySurface&) {
    return std::nullopt;
  }
  if (complex.network.lines.empty()) return std::nullopt;
  return complex;
}

}  // namespace taut::detail
