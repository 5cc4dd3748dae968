#include "surface/normals/neighbour_graph.hpp"

#include <algorithm>

#include "core/parallel.hpp"

namespace taut::detail {

NeighbourGraph::NeighbourGraph(const Points& points, const KdTree& tree, Index neighbours, const Context& context) {
  constexpr Index kGrain = 1024;
  const Index n = points.cols();
  const Index k = std::min(neighbours, n);
  std::vector<std::uint32_t> near(static_cast<std::size_t>(n * k));
  parallel_for(context, 0, n, kGrain, [&](Index first, Index last) {
    std::vector<Neighbour> found;
    for (Index i = first; i < last; ++i) {
      tree.nearest(points.col(i).data(), k, found);
      std::transform(found.begin(), found.end(), near.begin() + i * k,
                     [](const Neighbour& q) { return static_cast<std::uint32_t>(q.index); });
    }
  });
  const auto names = [&](std::uint32_t of, std::uint32_t i) {
    const auto begin = near.begin() + static_cast<std::ptrdiff_t>(of) * k;
    return std::find(begin, begin + k, i) != begin + k;
  };
  edges_.reserve(near.size() / 2 + near.size() / 8);
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
    for (Index slot = 0; slot < k; ++slot) {
      const std::uint32_t j = near[static_cast<std::size_t>(static_cast<Index>(i) * k + slot)];
      if (j > i) edges_.push_back({i, j});
      if (j < i && !names(j, i)) edges_.push_back({j, i});
    }
  }
}

}  // namespace taut::detail
