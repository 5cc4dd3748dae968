#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "fan/geodesic_fan.hpp"
#include "search/corrector.hpp"
#include "search/facet_workers.hpp"
#include "search/inquiry.hpp"
#include "search/start_finder.hpp"
#include "taut/core/context.hpp"
#include "taut/core/types.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// Finds shortest paths on a surface, by a ladder of rungs (path_search.cpp). After `prepare`, the const members may be
/// called from several threads.
class PathSearch {
 public:
  /// What the box that cells are made in is to the whole surface.
  enum class Scope {
    whole,   ///< all that is asked for; a surface without end goes on beyond it
    part,    ///< a part that was looked at on coarser cells before
    window,  ///< more of a surface without end: only as far as that costs little
  };

  /// Keeps the references.
  PathSearch(Surface surface, const PathOptions& options, const Context& context, Scope scope = Scope::whole);

  /// Makes sure that the points near (d x n) lie where cells are looked for.
  void prepare(const PointsIn& near);
  /// For `num_pairs` pairs to come.
  void tabulate(Index num_pairs);

  [[nodiscard]] const CellLevels& levels() const { return finder_.levels(); }
  [[nodiscard]] const StartFinder& finder() const { return finder_; }
  /// May paths have to cross edges: then starts on cells are of no use.
  [[nodiscard]] bool has_kinks() const { return kinked_; }

  /// The shortest path from p to q (d each, on the surface). `first`: starts of level 0, where they are there already.
  [[nodiscard]] PathResult find(const Vector& p, const Vector& q, Corrector& corrector,
                                std::optional<Starts> first = std::nullopt) const;

 private:
  [[nodiscard]] bool can_help(Rung rung, const Inquiry& now) const;
  void climb(Rung rung, Inquiry& now, Corrector& corrector) const;
  [[nodiscard]] PathResult conclude(Inquiry now) const;

  void go_over_faces(Inquiry& now) const;
  void ask_table(Inquiry& now, Corrector& corrector) const;
  void march_fields(Inquiry& now, Corrector& corrector) const;
  void walk(Inquiry& now, Corrector& corrector) const;
  void look_closer(Inquiry& now, Corrector& corrector) const;
  void look_wider(Inquiry& now, Corrector& corrector) const;
  void spread_fan(Inquiry& now, Corrector& corrector) const;
  void go_along_border(Inquiry& now) const;
  void go_along_samples(Inquiry& now) const;
  void follow_borders(Inquiry& now) const;

  [[nodiscard]] int num_levels() const;
  [[nodiscard]] bool is_affordable(const Inquiry& now) const;
  [[nodiscard]] Doubts doubts_of_cells(const PathResult& found, int level) const;
  [[nodiscard]] bool fan_can_help(const Inquiry& now) const;
  [[nodiscard]] std::pair<double, bool> cells_for_fan() const;
  void add_ray(const FanHit& way, const Inquiry& now, Starts& starts) const;
  [[nodiscard]] Box part_of_shorter(const PathResult& found) const;
  [[nodiscard]] bool has_smaller_part(const PathResult& found) const;
  [[nodiscard]] Box window(int doublings) const;
  [[nodiscard]] bool have_room(const PathResult& found, int doublings) const;
  [[nodiscard]] bool is_window_affordable(const PathResult& found, int doublings) const;
  [[nodiscard]] const PathSearch& through(int doublings) const;

  Surface surface_;
  const PathOptions& options_;
  const Context& context_;
  Scope scope_;
  bool kinked_;
  bool border_first_ = false;  // so many pairs are expected on a cut surface that its graph is worth making
  StartFinder finder_;
  Points points_;               // of interest, by the last `prepare`
  mutable FacetWorkers faces_;  // under their own lock
  mutable std::mutex wider_turn_;
  mutable std::vector<std::unique_ptr<PathSearch>> wider_;  // through windows 2, 4, 8, ... times as wide
};

}  // namespace taut::detail
