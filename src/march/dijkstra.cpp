// Dijkstra's shortest walks, which the paper names beside fast marching: over the projected points of cells that touch,
// where one smooth sheet explains the edge between them, or over the centres of all cells of an envelope. A walk has
// the 3^d - 1 directions of a block only, so its length is too large by a part that smaller cells do not take away.
// Kept for comparison; starts come from the convergent march. Cost: O(3^d) edges a cell and the heap.
#include <cmath>
#include <cstdint>
#include <vector>

#include "march/centre_watch.hpp"
#include "march/dimensions.hpp"
#include "march/edge.hpp"
#include "march/growing_field.hpp"
#include "march/methods.hpp"
#include "march/start.hpp"
#include "march/stencil.hpp"
#include "march/target_watch.hpp"

namespace taut::detail {
namespace {

/// Over edges between the projected points of cells that touch, where one smooth sheet explains them.
template <int D, int K>
void run(const MarchTask& task, DistanceField& field) {
  SurfaceCells& cells = task.cells;
  const Index d = field.sources.rows();
  const Index k = field.source_normals.rows() / d;
  const auto point = [&](Index i) { return SurfacePoint{cells.point(i).data(), cells.normals(i).data()}; };
  GrowingField growing(task, field);
  TargetWatch<D, K> target(task, field);
  Edge<D> edge;
  for (Index s = 0; s < field.sources.cols(); ++s) {
    const SurfacePoint source{field.sources.col(s).data(), field.source_normals.col(s).data()};
    for (const Index i : cells_around_source(cells, field.sources.col(s))) {
      if (make_edge<D, K>(source, point(i), d, k, edge)) growing.offer(i, edge.length, s);
    }
  }
  std::vector<Index> neighbours(static_cast<std::size_t>(block_size(d)) - 1);
  Front& front = growing.front();
  while (!front.empty() && !target.is_final(front.min_key())) {
    const double distance = front.min_key();
    const Index i = growing.pop();
    growing.settle(i, distance, growing.source(i));
    cells.neighbours(i, neighbours);
    for (const Index j : neighbours) {
      if (j == CellGrid::kNone || !cells.valid(j) || growing.settled(j)) continue;
      if (make_edge<D, K>(point(i), point(j), d, k, edge)) growing.offer(j, distance + edge.length, growing.source(i));
    }
    target.settled(cells.grid().cell(i));
  }
  growing.finish(target.distance());
}

/// Between the centres of all cells of an envelope that touch.
void run_between_centres(const MarchTask& task, DistanceField& field) {
  const CellGrid& grid = task.cells.grid();
  GrowingField growing(task, field);
  CentreWatch target(task, field);
  for (Index s = 0; s < field.sources.cols(); ++s) {
    const Index start = checked_start_cell(grid, field.sources.col(s));
    growing.offer(start, (grid.centre(start) - field.sources.col(s)).norm(), s);
  }
  std::vector<Index> neighbours(static_cast<std::size_t>(grid.num_neighbours()));
  std::vector<double> lengths(neighbours.size());
  std::vector<std::int32_t> offset(static_cast<std::size_t>(grid.dim()));
  for (Index m = 0; m < grid.num_neighbours(); ++m) {
    grid.neighbour_offset(m, offset);
    double squares = 0;
    for (const std::int32_t step : offset) squares += step * step;
    lengths[static_cast<std::size_t>(m)] = grid.size() * std::sqrt(squares);
  }
  Front& front = growing.front();
  while (!front.empty() && !target.is_final(front.min_key())) {
    const double distance = front.min_key();
    const Index i = growing.pop();
    growing.settle(i, distance, growing.source(i));
    grid.neighbours(i, neighbours);
    // Centres lie on a grid: the length of a step depends on its offset alone, whatever the surface does.
    for (std::size_t m = 0; m < neighbours.size(); ++m) {
      const Index j = neighbours[m];
      if (j != CellGrid::kNone && !growing.settled(j)) growing.offer(j, distance + lengths[m], growing.source(i));
    }
    target.settled(grid.cell(i));
  }
  growing.finish(target.distance());
}

}  // namespace

void march_dijkstra(const MarchTask& task, DistanceField& field) {
  if (field.at_centres) return run_between_centres(task, field);
  with_dimensions(field.sources.rows(), field.source_normals.rows() / field.sources.rows(),
                  [&]<int D, int K>() { run<D, K>(task, field); });
}

}  // namespace taut::detail
