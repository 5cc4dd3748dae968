#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "march/barrier.hpp"
#include "search/start_finder.hpp"
#include "taut/core/types.hpp"
#include "taut/search/doubt.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// All that is known of one pair of points while their shortest path is sought: the best path, the doubts left about
/// it, what was tried, and what that has cost.
struct Inquiry {
  Inquiry(const Vector& p, const Vector& q, std::optional<Starts> starts) : first(std::move(starts)) {
    blank.from = p;
    blank.to = q;
  }

  [[nodiscard]] const Vector& from() const { return blank.from; }
  [[nodiscard]] const Vector& to() const { return blank.to; }
  [[nodiscard]] bool has_path() const { return best && best->status == Status::ok; }
  [[nodiscard]] bool is_apart() const { return best && best->obstacle.kind == Obstacle::Kind::apart; }
  [[nodiscard]] bool tried(Rung rung) const { return tried_[static_cast<std::size_t>(rung)]; }
  void set_tried(Rung rung) { tried_[static_cast<std::size_t>(rung)] = true; }

  /// Starts were found: results have their cells from now on.
  void note(const Starts& starts, GridMethod grid);
  /// There is no path, for a reason that is known.
  void give_up(Status status, Obstacle::Kind why);
  /// A search in another box has come to this: its time and its rungs count here, too.
  void add_effort(const PathResult& other);
  /// A rung has been climbed.
  void report(Rung rung);

  PathResult blank;  ///< what every path between the points shares: ends, cells, seconds so far
  std::optional<PathResult>
      best;              ///< the best path so far; without one that is ok, the best curve or why there is none
  Doubts doubts;         ///< whether `best` is the shortest
  bool settled = false;  ///< no rung could change anything
  bool proved = false;   ///< by all geodesics from the start: nothing shorter is anywhere
  std::vector<RungReport> rungs;

  // Faces.
  Doubts over_edges;  ///< about a path of any other rung

  // Fields.
  std::optional<Starts> first;     ///< of level 0, where they were there before
  int level = 0;                   ///< of the next cells
  bool marched = false;            ///< some fields have led to starts
  bool counts = false;             ///< and what came of them says something: the next are the last
  bool blocked = false;            ///< the last ones have led nowhere
  bool cells_spent = false;        ///< no more cells may grow
  Index next_cells = 0;            ///< about so many will those of `level` be
  std::optional<Barrier> barrier;  ///< where the last fields stopped
  Doubts of_cells;                 ///< about `best`, by the cells of the fields

  // Border.
  std::vector<StartPath> beyond;  ///< starts whose geodesics leave the domain, with their least lengths

  // Walks.
  std::optional<PathResult> fallback;  ///< what walks led to where fields may still do better

  // Wider.
  int doublings = 0;
  bool window_shut = false;  ///< no wider one is looked through
  Box window;                ///< through which `best` was found

 private:
  std::array<bool, static_cast<std::size_t>(Rung::border) + 1> tried_{};
};

}  // namespace taut::detail
