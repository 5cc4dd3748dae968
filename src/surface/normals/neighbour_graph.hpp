#pragma once

#include <cstdint>
#include <vector>

#include "surface/rbf/kd_tree.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"

namespace taut::detail {

/// Each point's nearest ones (itself left out), and the edges between them, each once.
class NeighbourGraph {
 public:
  /// `neighbours`: how many of each point, itself counted.
  NeighbourGraph(const Points& points, const KdTree& tree, Index neighbours, const Context& context);

  struct Edge {
    std::uint32_t a = 0;
    std::uint32_t b = 0;  // > a
  };
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }

 private:
  std::vector<Edge> edges_;
};

}  // namespace taut::detail
