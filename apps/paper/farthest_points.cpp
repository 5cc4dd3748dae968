#include "farthest_points.hpp"

#include <cmath>
#include <limits>

#include "taut/march/march.hpp"

namespace taut::paper {

FarthestPoints farthest_points(const Surface& surface, SurfaceCells& cells, const VectorIn& first, Index count,
                               const Context& context) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FarthestPoints chosen{.points = Points(surface.dim(), count),
                        .distance = Vector::Constant(cells.num_cells(), kInfinity),
                        .nearest = std::vector<Index>(static_cast<std::size_t>(cells.num_cells()), -1),
                        .cover = {}};
  Vector next = first;
  for (Index k = 0; k < count; ++k) {
    chosen.points.col(k) = next;
    // No cell beyond what was farthest so far can come nearer.
    MarchOptions options;
    if (!chosen.cover.empty()) options.radius = chosen.cover.back();
    const DistanceField field = march(surface, cells, next, options, context);
    Index farthest = -1;
    for (Index i = 0; i < cells.num_cells(); ++i) {
      if (field.distance(i) < chosen.distance(i)) {
        chosen.distance(i) = field.distance(i);
        chosen.nearest[static_cast<std::size_t>(i)] = k;
      }
      if (!std::isfinite(chosen.distance(i))) continue;
      if (farthest < 0 || chosen.distance(i) > chosen.distance(farthest)) farthest = i;
    }
    chosen.cover.push_back(chosen.distance(farthest));
    next = cells.point(farthest);
  }
  return chosen;
}

}  // namespace taut::paper
