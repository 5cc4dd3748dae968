#include <algorithm>
#include <limits>
#include <numeric>
#include <queue>
#include <vector>

#include "isomap.hpp"

namespace taut::paper {

Eigen::MatrixXd isomap_distances(const PointsIn& points, Index neighbours, const Eigen::VectorX<Index>& sources) {
  const Index n = points.cols();
  std::vector<std::vector<std::pair<Index, double>>> edges(static_cast<std::size_t>(n));
  std::vector<Index> order(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    const Vector distance = (points.colwise() - points.col(i)).colwise().norm();
    std::iota(order.begin(), order.end(), Index(0));
    std::ranges::nth_element(order, order.begin() + neighbours, {}, [&](Index j) { return distance(j); });
    for (Index k = 0; k <= neighbours; ++k) {
      const Index j = order[static_cast<std::size_t>(k)];
      if (j == i) continue;
      edges[static_cast<std::size_t>(i)].emplace_back(j, distance(j));
      edges[static_cast<std::size_t>(j)].emplace_back(i, distance(j));
    }
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Constant(n, sources.size(), std::numeric_limits<double>::infinity());
  for (Index s = 0; s < sources.size(); ++s) {
    using Entry = std::pair<double, Index>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    result(sources(s), s) = 0;
    front.emplace(0, sources(s));
    while (!front.empty()) {
      const auto [u, i] = front.top();
      front.pop();
      if (u > result(i, s)) continue;
      for (const auto& [j, length] : edges[static_cast<std::size_t>(i)]) {
        if (u + length >= result(j, s)) continue;
        result(j, s) = u + length;
        front.emplace(u + length, j);
      }
    }
  }
  return result;
}

}  // namespace taut::paper
