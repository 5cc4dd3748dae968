#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "march/barrier.hpp"
#include "march/distance_table.hpp"
#include "march/march_over.hpp"
#include "march/start_paths.hpp"
#include "search/cell_levels.hpp"
#include "search/ground.hpp"
#include "search/start_rules.hpp"
#include "taut/march/march.hpp"
#include "taut/search/path_options.hpp"
#include "taut/search/path_result.hpp"

namespace taut::detail {

/// Starts between two points, and the cells they were found on.
struct Starts {
  std::vector<StartPath> paths;         ///< shortest first; empty = no way was found
  std::shared_ptr<SurfaceCells> cells;  ///< null in more dimensions than cells reach
  double cell = 0;                      ///< h
  double error = kRivalRules.error;  ///< of the starts' lengths against those of the geodesics they lead to, relative
  double doubt = kRivalRules.doubt;  ///< a path this much longer than the marched way has missed it, relative
  Doubts doubts;                     ///< whether `paths` holds all ways that may be the shortest
  /// Of the ends, by the march; NaN where there was none.
  double marched = std::numeric_limits<double>::quiet_NaN();
  Points walked;                   ///< d x n: centres of the cells that were visited, if asked for
  std::optional<Barrier> barrier;  ///< where the march stopped short of the end, if it did
  PathSeconds seconds;
};

/// Does the march go between the centres of cells, as the paper's.
[[nodiscard]] inline bool marches_between_centres(const PathOptions& options) {
  return options.march == MarchMethod::axis || options.envelope != 0;
}

/// Finds ways between points of one surface to start corrections from. After `prepare`, the const members may be called
/// from several threads.
class StartFinder {
 public:
  StartFinder(const Surface& surface, const PathOptions& options, const Context& context);

  /// Makes sure that the points near (d x n) lie where cells are looked for. True when that makes earlier cells void.
  bool prepare(const PointsIn& near) {
    const bool anew = levels_.prepare(near);
    if (anew) table_.reset();
    return anew;
  }
  /// Makes the cells of level 0, and a table of distances where that pays for `num_pairs` pairs.
  void tabulate(Index num_pairs);

  [[nodiscard]] const CellLevels& levels() const { return levels_; }
  [[nodiscard]] bool has_table() const { return table_.has_value(); }
  /// Ways by the table, in microseconds. None where there is no table or it cannot tell.
  [[nodiscard]] Starts find_by_table(const Vector& p, const Vector& q) const;
  /// Ways without cells: by walks from both ends.
  [[nodiscard]] Starts walk(const Vector& p, const Vector& q) const;
  /// Ways by marching on the cells of one level; by walks in more dimensions than cells reach.
  [[nodiscard]] Starts find(const Vector& p, const Vector& q, int level) const;
  /// What is marched over at a level. `seeds` as of CellLevels::cells.
  [[nodiscard]] Ground ground(int level, const PointsIn& seeds) const;
  /// The distances from p over all cells, for `continue_to`.
  [[nodiscard]] DistanceField march_all(const Ground& ground, const Vector& p) const;
  /// Ways where the distances from p are there already, at least up to q.
  [[nodiscard]] Starts continue_to(const Ground& ground, const DistanceField& from_p, const Vector& q) const {
    return continue_to(ground, from_p, q, std::nullopt);
  }
  /// Does the surface bend within the cells of a level along a curve (d x m). False for cells of a given size.
  [[nodiscard]] bool bends_sharply(int level, const Points& curve) const;

  /// True when p and q lie in different components of the cells that found no way, which is a proof where the surface
  /// has interval bounds.
  [[nodiscard]] bool apart(SurfaceCells& cells, int level, const Vector& p, const Vector& q) const;
  /// The same where another pair has had to find that out: without looking for ways first.
  [[nodiscard]] bool known_to_be_apart(int level, const Vector& p, const Vector& q) const;

 private:
  /// Of lengths by the table, relative.
  struct TableError {
    double too_long = 0;
    double too_short = 0;
  };
  [[nodiscard]] TableError measure_error(const DistanceTable& table) const;
  [[nodiscard]] bool seeks_rivals() const;
  /// Ways by marching on these cells, with all rivals no longer than `longest`.
  [[nodiscard]] Starts find_within(double longest, const Ground& ground, const Vector& p, const Vector& q) const;
  /// Ways where the distances from p are there already, at least up to q; those from q, too, if given.
  [[nodiscard]] Starts continue_to(const Ground& ground, const DistanceField& from_p, const Vector& q,
                                   std::optional<DistanceField> from_q) const;
  /// The distances from `source`, as far as paths to `target` need them that are no longer than `longest`.
  [[nodiscard]] DistanceField march_towards(const Ground& ground, const Vector& source, const Vector& target,
                                            double longest) const;

  const Surface& surface_;
  const PathOptions& options_;
  const Context& context_;
  mutable CellLevels levels_;  // makes cells when they are first asked for, under its own lock
  std::optional<DistanceTable> table_;
  double table_error_ = 0;  // of the lengths by the table, relative: rivals within it are sought
  double table_doubt_ = 0;  // a path this much longer than the table says is doubted
};

}  // namespace taut::detail
