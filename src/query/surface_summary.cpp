// What `taut info` tells: box, cells, components, and for surfaces in space area, Euler number and edges, by a mesh
// over the same cells. For fits, how far the samples lie off. In more than six dimensions cells are grown from samples,
// up to kMostGrownCells. Where nothing is found, the rank of the equations is looked at, for that is the usual reason.
#include "taut/query/surface_summary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "query/edges_of.hpp"
#include "search/cell_levels.hpp"
#include "strata/facet_complex.hpp"
#include "strata/sharp_mesh.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/cells/mesh_surface.hpp"
#include "taut/core/error.hpp"
#include "taut/surface/conformance.hpp"

namespace taut {
namespace {

/// Of cells on which the Euler number is counted: 25 us each on a local fit, so some four seconds.
constexpr Index kMostCountedCells = 150'000;

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

/// Edges that one triangle alone has.
Index count_boundary_edges(const Eigen::Matrix3Xi& faces) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(static_cast<std::size_t>(3 * faces.cols()));
  for (Index f = 0; f < faces.cols(); ++f) {
    for (Index i = 0; i < 3; ++i) edges.push_back(std::minmax(faces(i, f), faces((i + 1) % 3, f)));
  }
  std::ranges::sort(edges);
  Index alone = 0;
  for (std::size_t i = 0; i < edges.size();) {
    const std::size_t first = i;
    while (i < edges.size() && edges[i] == edges[first]) ++i;
    if (i - first == 1) ++alone;
  }
  return alone;
}

SurfaceShape shape_of(const Surface& surface, const CellGrid& grid, std::optional<detail::FacetComplex>& complex,
                      const Context& context) {
  SurfaceMesh mesh = mesh_surface(surface, grid, {}, context);
  if (complex) detail::sharpen_mesh(*complex->surface, complex->network, grid, false, mesh);
  SurfaceShape shape;
  for (Index f = 0; f < mesh.faces.cols(); ++f) {
    const Eigen::Vector3d a = mesh.vertices.col(mesh.faces(0, f));
    const Eigen::Vector3d b = mesh.vertices.col(mesh.faces(1, f));
    const Eigen::Vector3d c = mesh.vertices.col(mesh.faces(2, f));
    shape.area += (b - a).cross(c - a).norm() / 2;
  }
  const Index boundary = count_boundary_edges(mesh.faces);
  // Each inner edge belongs to two triangles, each of the boundary to one.
  const Index edges = (3 * mesh.faces.cols() + boundary) / 2;
  shape.euler = mesh.vertices.cols() - edges + mesh.faces.cols();
  shape.closed = boundary == 0 && mesh.faces.cols() > 0;
  // Without a domain or a box of the user's a boundary can only come from the box that was looked through.
  shape.cut_by_box = boundary > 0 && surface.domain() == nullptr && !surface.box();
  shape.cell = grid.size();
  return shape;
}

/// Counted again on cells of half the size until two sizes tell the same: legs of a scan nearer to each other than a
/// cell grow together on it, and a thin ear is torn.
SurfaceShape settled_shape(const Surface& surface, const detail::CellLevels& levels, const CellGrid& coarsest,
                           std::optional<detail::FacetComplex>& complex, const Context& context) {
  SurfaceShape shape = shape_of(surface, coarsest, complex, context);
  Index num_cells = coarsest.num_cells();
  // Half the size has four times the cells.
  while (!shape.settled && 4 * num_cells <= kMostCountedCells) {
    const CellGrid finer = levels.grid_of(shape.cell / 2);
    SurfaceShape next = shape_of(surface, finer, complex, context);
    next.settled = next.euler == shape.euler && next.closed == shape.closed;
    num_cells = finer.num_cells();
    shape = next;
  }
  return shape;
}

/// In more than 6 dimensions Algorithm II grows no more cells than so many, 20 us each in 7 dimensions.
constexpr Index kMostGrownCells = 200'000;

/// Sizes of the components of these cells, largest first.
std::vector<Index> component_sizes(const Components& found) {
  std::vector<Index> sizes(static_cast<std::size_t>(found.count), 0);
  for (const std::int32_t label : found.label) ++sizes[static_cast<std::size_t>(label)];
  std::ranges::sort(sizes, std::greater<>());
  return sizes;
}

/// Where there are too many cells to make all of them: those that grow from the surface's samples, or from seeds.
void grow_patches(const Surface& surface, const SummaryOptions& options, detail::CellLevels& levels,
                  SurfaceSummary& summary, const Context& context) {
  const bool sampled = surface.samples() != nullptr && surface.samples()->size() > 0;
  const Points& seeds = sampled ? surface.samples()->points : options.seeds;
  if (seeds.cols() == 0) {
    throw InvalidArgument("Algorithm II grows cells from points of the surface: give it some (option samples)");
  }
  levels.prepare(seeds);
  const CellGrid grid =
      grow(surface, seeds,
           {.size = levels.size(0), .origin = {}, .counts = &summary.counts, .most_cells = kMostGrownCells}, context);
  const Eigen::Map<const Eigen::MatrixX<std::int32_t>> cells(grid.coordinates().data(), grid.dim(), grid.num_cells());
  const Vector first = cells.rowwise().minCoeff().cast<double>();
  const Vector last = cells.rowwise().maxCoeff().cast<double>();
  summary.box = {grid.origin() + grid.size() * first, grid.origin() + grid.size() * (last.array() + 1).matrix()};
  summary.cell = grid.size();
  summary.num_cells = grid.num_cells();
  summary.grid = GridMethod::grow;
  if (summary.counts.complete) summary.components = component_sizes(components_across_faces(grid));
}

/// Why there is nothing to be seen, where the equations are the reason.
void throw_if_rank_deficient(const Surface& surface, const detail::CellLevels& levels) {
  constexpr double kReach = 2;  // without a box: where most formulas have their surface
  Box box = levels.box();
  if (box.dim() != surface.dim()) {
    box = surface.box() ? *surface.box()
                        : Box{Vector::Constant(surface.dim(), -kReach), Vector::Constant(surface.dim(), kReach)};
  }
  if (const auto diagnosis = diagnose_rank(surface.function(), box)) throw SingularPoint(diagnosis->text());
}

}  // namespace

SurfaceSummary summarise(const Surface& surface, const SummaryOptions& options, const Context& context) {
  detail::CellLevels levels(surface, {options.grid, options.cell, options.seeds}, context);
  if (surface.dim() > detail::CellLevels::kMostDimensions &&
      (options.envelope != 0 || (options.cell > 0 && !levels.lazy()))) {
    throw InvalidArgument(
        "in more than 6 dimensions there are only cells that grow from samples (GridMethod::grow), and no envelope");
  }
  SurfaceSummary summary;
  summary.kind = surface.kind();
  summary.dim = surface.dim();
  summary.codim = surface.codim();
  if (levels.lazy()) {
    grow_patches(surface, options, levels, summary, context);
  } else if (levels.exist()) {
    try {
      const Points nowhere(surface.dim(), 0);
      levels.prepare(nowhere);
      const std::shared_ptr<SurfaceCells> cells = levels.cells(0, nowhere);
      summary.box = levels.box();
      summary.cell = cells->grid().size();
      summary.num_cells = cells->num_cells();
      summary.grid = levels.grid();
      summary.counts = levels.counts(0);
      if (options.envelope != 0) {
        const std::shared_ptr<SurfaceCells> envelope = levels.envelope(0, options.envelope);
        summary.num_layers = envelope->num_layers();
        summary.num_envelope_cells = envelope->num_cells();
      }
      if (surface.dim() == 3 && surface.codim() == 1) {
        std::optional<detail::FacetComplex> complex = detail::FacetComplex::of(surface, levels.box(), context);
        if (complex) summary.edges = detail::edges_of(*complex);
        summary.shape = options.cell > 0 ? shape_of(surface, cells->grid(), complex, context)
                                         : settled_shape(surface, levels, cells->grid(), complex, context);
      }
      summary.components = component_sizes(components(cells->grid()));
    } catch (const EmptySurface&) {
      throw_if_rank_deficient(surface, levels);
      throw;
    }
  } else {
    throw_if_rank_deficient(surface, levels);
  }
  if (const PointCloud* samples = surface.samples(); samples != nullptr && samples->size() > 0) {
    const Vector distance = first_order_distances(surface, samples->points);
    summary.num_samples = samples->size();
    summary.sample_rms = std::sqrt(distance.squaredNorm() / static_cast<double>(distance.size()));
    summary.sample_max = distance.maxCoeff();
  }
  return summary;
}

}  // namespace taut
