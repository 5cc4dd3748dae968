#pragma once

#include <cstdint>
#include <vector>

#include "taut/core/types.hpp"

namespace taut::detail {

/// Directed segments between numbered nodes, put together to lines.
class Chains {
 public:
  /// A segment from node a to node b.
  void join(Index a, Index b) {
    resize(a > b ? a : b);
    // A node has one segment in and one out at most: level lines cross an edge of a mesh once.
    next_[at(a)] = b;
    previous_[at(b)] = a;
  }

  /// The nodes of each line in order; a closed one repeats its first.
  [[nodiscard]] std::vector<std::vector<Index>> lines() const {
    std::vector<std::vector<Index>> result;
    std::vector<std::uint8_t> seen(next_.size(), 0);
    const auto follow = [&](Index first) {
      std::vector<Index> line;
      for (Index e = first; e >= 0; e = next_[at(e)]) {
        line.push_back(e);
        if (seen[at(e)] != 0) break;  // once round
        seen[at(e)] = 1;
      }
      result.push_back(std::move(line));
    };
    const Index n = static_cast<Index>(next_.size());
    for (Index e = 0; e < n; ++e) {  // open ones from their beginnings
      if (previous_[at(e)] < 0 && next_[at(e)] >= 0) follow(e);
    }
    // What is left are rings: they begin anywhere.
    for (Index e = 0; e < n; ++e) {
      if (seen[at(e)] == 0 && next_[at(e)] >= 0) follow(e);
    }
    return result;
  }

 private:
  static std::size_t at(Index i) { return static_cast<std::size_t>(i); }
  void resize(Index most) {
    if (at(most) < next_.size()) return;
    next_.resize(at(most) + 1, -1);
    previous_.resize(at(most) + 1, -1);
  }

  std::vector<Index> next_, previous_;
};

}  // namespace taut::detail
