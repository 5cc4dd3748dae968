#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "search/box_search.hpp"
#include "taut/core/box.hpp"

namespace taut::detail {

/// Finds shortest paths on a surface, though it may have no end: then cells are made in a box around points of
/// interest, which shorter ways may leave, or the only one. After `prepare`, the const members may be called from
/// several threads.
class PathSearch {
 public:
  /// Keeps the references.
  PathSearch(const Surface& surface, const PathOptions& options, const Context& context)
      : surface_(surface), options_(options), context_(context), near_(surface, options, context) {}

  /// Makes sure that the points near (d x n) lie where cells are looked for.
  void prepare(const PointsIn& near) {
    if (near_.prepare(near) || levels().grows_from_ends()) wider_.clear();
    points_ = near;
  }
  /// For `num_pairs` pairs to come.
  void tabulate(Index num_pairs) { near_.tabulate(num_pairs); }

  [[nodiscard]] const CellLevels& levels() const { return near_.levels(); }
  [[nodiscard]] const StartFinder& finder() const { return near_.finder(); }

  /// The shortest path from p to q. `first`: starts of level 0, when they are there already.
  [[nodiscard]] PathResult find(const Vector& p, const Vector& q, Corrector& corrector,
                                std::optional<Starts> first = std::nullopt) const;

 private:
  [[nodiscard]] Box window(int doublings) const;
  [[nodiscard]] bool have_room(const PathResult& found, int doublings) const;
  [[nodiscard]] bool is_affordable(const PathResult& found, int doublings) const;
  [[nodiscard]] const BoxSearch& through(int doublings) const;

  const Surface& surface_;
  const PathOptions& options_;
  const Context& context_;
  BoxSearch near_;
  Points points_;  // of interest, by the last `prepare`
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<BoxSearch>> wider_;  // through windows 2, 4, 8, ... times as wide
};

}  // namespace taut::detail
