#include "taut/query/surface_summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "query/cell_levels.hpp"
#include "taut/cells/components.hpp"

namespace taut {
namespace {

/// |F| / |grad F| at each sample; for k > 1 the length of J^+ F to first order, with J's rows taken as orthogonal.
Vector first_order_distances(const Surface& surface, const PointsIn& x) {
  const Points value = surface.value(x);
  const Points jacobian = surface.jacobian(x);
  Vector distance(x.cols());
  for (Index j = 0; j < x.cols(); ++j) {
    double squared = 0;
    for (Index i = 0; i < surface.codim(); ++i) {
      const double slope = jacobian.col(j).segment(i * surface.dim(), surface.dim()).norm();
      squared += std::pow(value(i, j) / slope, 2);
    }
    distance(j) = std::sqrt(squared);
  }
  return distance;
}

}  // namespace

SurfaceSummary summarise(const Surface& surface, double cell, const Context& context) {
  detail::CellLevels levels(surface, GridMethod::automatic, cell, context);
  const Points nowhere(surface.dim(), 0);
  levels.prepare(nowhere);
  const std::shared_ptr<SurfaceCells> shared = levels.cells(0, nowhere);
  const SurfaceCells& cells = *shared;

  SurfaceSummary summary;
  summary.kind = surface.kind();
  summary.dim = surface.dim();
  summary.codim = surface.codim();
  summary.box = levels.box();
  summary.cell = cells.grid().size();
  summary.num_cells = cells.num_cells();
  const Components found = components(cells.grid());
  summary.components.assign(static_cast<std::size_t>(found.count), 0);
  for (const std::int32_t label : found.label) ++summary.components[static_cast<std::size_t>(label)];
  std::ranges::sort(summary.components, std::greater<>());
  if (const PointCloud* samples = surface.samples(); samples != nullptr && samples->size() > 0) {
    const Vector distance = first_order_distances(surface, samples->points);
    summary.num_samples = samples->size();
    summary.sample_rms = std::sqrt(distance.squaredNorm() / static_cast<double>(distance.size()));
    summary.sample_max = distance.maxCoeff();
  }
  return summary;
}

}  // namespace taut
