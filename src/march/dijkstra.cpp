#include <vector>

#include "march/dimensions.hpp"
#include "march/edge.hpp"
#include "march/growing_field.hpp"
#include "march/methods.hpp"
#include "march/start.hpp"
#include "march/stencil.hpp"
#include "march/target_watch.hpp"

namespace taut::detail {
namespace {

template <int D, int K>
void run(const MarchTask& task, DistanceField& field) {
  SurfaceCells& cells = task.cells;
  const Index d = field.sources.rows();
  const Index k = field.source_normals.rows() / d;
  const auto point = [&](Index i) { return SurfacePoint{cells.point(i).data(), cells.normals(i).data()}; };
  GrowingField growing(task, field, false);
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

}  // namespace

void march_dijkstra(const MarchTask& task, DistanceField& field) {
  with_dimensions(field.sources.rows(), field.source_normals.rows() / field.sources.rows(),
                  [&]<int D, int K>() { run<D, K>(task, field); });
}

}  // namespace taut::detail
