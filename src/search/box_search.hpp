#pragma once

#include <optional>
#include <string_view>

#include "search/corrector.hpp"
#include "search/start_finder.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Finds shortest paths in the box that a surface's cells are made in. After `prepare`, the const members may be called
/// from several threads.
class BoxSearch {
 public:
  /// What the box is to another search of the same surface.
  enum class Look {
    first,    ///< there is no other
    closer,   ///< a part of its box, on finer cells
    farther,  ///< more of a surface without end: only as far as that costs little
  };

  /// Keeps the references.
  BoxSearch(Surface surface, const PathOptions& options, const Context& context, Look look = Look::first);

  /// Makes sure that the points near (d x n) lie in the box. True when that makes earlier cells void.
  bool prepare(const PointsIn& near) { return finder_.prepare(near); }
  /// For `num_pairs` pairs to come.
  void tabulate(Index num_pairs) { finder_.tabulate(num_pairs); }

  [[nodiscard]] const CellLevels& levels() const { return finder_.levels(); }
  [[nodiscard]] const StartFinder& finder() const { return finder_; }

  /// The shortest path from p to q. `first`: starts of level 0, when they are there already.
  [[nodiscard]] PathResult find(const Vector& p, const Vector& q, Corrector& corrector,
                                std::optional<Starts> first = std::nullopt) const;

 private:
  [[nodiscard]] int num_levels() const;
  [[nodiscard]] bool doubted(const PathResult& found, const Starts& starts, int level) const;
  [[nodiscard]] PathResult walk(const PathResult& so_far, const Vector& p, const Vector& q, Corrector& corrector) const;
  [[nodiscard]] PathResult walk_past_cells(PathResult so_far, const Vector& p, const Vector& q, Corrector& corrector,
                                           std::string_view why) const;
  [[nodiscard]] PathResult look_closer(PathResult found, Corrector& corrector) const;

  Surface surface_;
  const PathOptions& options_;
  const Context& context_;
  Look look_;
  StartFinder finder_;
};

inline constexpr std::string_view kApart = "the two points lie on different components of the surface";

/// The time spent on `earlier` counts for `later`.
inline void add_seconds(const PathResult& earlier, PathResult& later) {
  later.seconds.cells += earlier.seconds.cells;
  later.seconds.march += earlier.seconds.march;
  later.seconds.correct += earlier.seconds.correct;
}

}  // namespace taut::detail
