// The shortest path, by a ladder of rungs from cheap to dear. A rung is climbed where it can lift a doubt that is left;
// what it finds replaces the best path if it is better, and it says which doubts it leaves itself. Every rung ends by a
// count of cells (ladder_rules.hpp), of walked steps or of corrections, so the search does.
//
// clang-format off
//   rung    can lift                                    finds starts by                     leaves, as a doubt
//   faces   no path yet, on a surface with edges; of    ways over a graph of faces          start_failed, budget_spent
//           many pairs also on one that is cut, where
//           the path runs along its border
//   table   no path yet                                 distances between landmarks         start_failed, coarse_cells,
//                                                                                           sharp_bends
//   fields  no path yet; start_failed, once;            distances marched from both ends,   the same
//           sharp_bends that the table has left         on cells of h, h/2, h/4, ...
//   fan     no path yet, before cells get dear; any     all geodesics from the start, as    coarse_cells
//           doubt about a path, and shorter ones that   far as the path is long
//           could leave the box, on a 2-surface
//   walks   no path yet, before cells get dear, and     steps from both ends, random ones   sheets_not_told,
//           where there are none                        where those are stuck               cells_spent, random_search
//   closer  coarse_cells, sharp_bends                   this search, in the part of the     those of that search
//                                                       box that shorter paths can visit
//   wider   shorter paths could leave the box, or the   this search, in windows 2, 4, ...   beyond_window, and those
//           points lie apart in it, and the surface     times as wide                       of that search
//           goes on
//   border  any doubt, or the path leaves the domain    ways over a graph of the one face   start_failed, budget_spent
//                                                       and its border; on fits, the way
//                                                       over cells that stays inside; in    rivals_not_sought
//                                                       more dimensions, starts whose
//                                                       geodesics leave the domain
// clang-format on
//
// Where there are two ways to the same end the cheaper one comes first: a fan and walks before finer cells that cost
// more.
#include "search/path_search.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <utility>

#include "curve/polyline.hpp"
#include "search/contact_search.hpp"
#include "search/explain.hpp"
#include "search/find_obstacle.hpp"
#include "search/ladder_rules.hpp"
#include "search/shorter_paths.hpp"
#include "surface/formula/formula_function.hpp"

namespace taut::detail {
namespace {

constexpr Rung kLadder[] = {Rung::faces, Rung::table,  Rung::fields, Rung::fan,
                            Rung::walks, Rung::closer, Rung::wider,  Rung::border};

/// May paths on the surface have to cross edges.
bool has_edges(const Surface& surface) {
  if (surface.dim() != 3 || surface.codim() != 1) return false;
  const auto* formula = dynamic_cast<const FormulaFunction*>(&surface.function());
  return formula != nullptr && formula->program().has_kinks();
}

PathResult standing_still(const Vector& p, double cell) {
  PathResult result;
  result.from = result.to = p;
  result.status = Status::ok;
  result.locally_shortest = true;
  result.index = 0;
  result.points = chord(p, p);
  result.grid_path = result.points;
  result.cell = cell;
  result.unique = true;
  return result;
}

}  // namespace

PathSearch::PathSearch(Surface surface, const PathOptions& options, const Context& context, Scope scope)
    : surface_(std::move(surface)),
      options_(options),
      context_(context),
      scope_(scope),
      kinked_(scope == Scope::whole && has_edges(surface_)),
      finder_(surface_, options_, context_),
      faces_(surface_, options_, context_) {}

void PathSearch::prepare(const PointsIn& near) {
  if (finder_.prepare(near) || levels().grows_from_ends()) wider_.clear();
  points_ = near;
  faces_.expect(near);
}

void PathSearch::tabulate(Index num_pairs) {
  if (!kinked_) finder_.tabulate(num_pairs);
  const bool cut = surface_.dim() == 3 && surface_.codim() == 1 && surface_.domain() != nullptr;
  border_first_ = cut && !kinked_ && scope_ == Scope::whole && surface_.samples() == nullptr &&
                  num_pairs >= kLadderRules.pairs_for_border_first;
}

PathResult PathSearch::find(const Vector& p, const Vector& q, Corrector& corrector, std::optional<Starts> first) const {
  if (p == q) return standing_still(p, levels().size(0));
  Inquiry now(p, q, std::move(first));
  const auto next = [&] { return std::ranges::find_if(kLadder, [&](Rung rung) { return can_help(rung, now); }); };
  for (const Rung* rung = next(); rung != std::end(kLadder); rung = next()) {
    climb(*rung, now, corrector);
    now.set_tried(*rung);
    now.report(*rung);
  }
  return conclude(std::move(now));
}

/// Could a rung lift a doubt that is left, for a price that is worth it.
bool PathSearch::can_help(Rung rung, const Inquiry& now) const {
  if (now.settled) return false;
  const bool whole = scope_ == Scope::whole;
  switch (rung) {
    case Rung::faces: return (kinked_ || border_first_) && !now.tried(rung);
    case Rung::table: return finder_.has_table() && !now.first && !now.tried(rung);
    case Rung::fields: {
      // On which side of a spike a way begins no landmark tells.
      const bool past_spikes = now.tried(Rung::table) && !now.marched && now.doubts.has(Doubt::sharp_bends);
      const bool wanted = !now.best || now.doubts.has(Doubt::start_failed) || past_spikes;
      // Finer cells of a fit cost more than to look along its border, and in many dimensions more than anything.
      const bool by_border = now.best && ((surface_.samples() != nullptr && can_help(Rung::border, now)) ||
                                          (!now.beyond.empty() && has_contacts(surface_, options_)));
      return levels().exist() && now.level < num_levels() && wanted && !by_border && is_affordable(now);
    }
    case Rung::walks:
      return !now.best && !now.tried(rung) && (scope_ != Scope::window || !levels().exist()) &&
             !can_help(Rung::border, now);
    case Rung::closer:
      return scope_ != Scope::part && !marches_between_centres(options_) && now.has_path() && !now.tried(rung) &&
             now.doubts.has_any({Doubt::coarse_cells, Doubt::sharp_bends}) && has_smaller_part(*now.best);
    case Rung::wider:
      return whole && levels().endless() && !now.window_shut && !now.proved &&
             (now.has_path() ? !have_room(*now.best, now.doublings) : now.is_apart());
    case Rung::fan: return fan_can_help(now);
    case Rung::border: {
      // On fits, where a way that promised to be shorter may have left the samples, and where nothing else came of it.
      const bool fitted = surface_.samples() != nullptr;
      const bool doubted = now.has_path() && (fitted ? now.doubts.has(Doubt::start_failed) : now.doubts.any());
      const bool lost = fitted && (now.best ? now.best->status != Status::ok && !now.is_apart()
                                            : now.blocked && !can_help(Rung::fields, now));
      const bool met = has_contacts(surface_, options_)
                           ? now.best && !now.beyond.empty()
                           : (now.best && now.best->status == Status::left_domain) || doubted || lost;
      return whole && surface_.domain() != nullptr && !kinked_ && met && !now.tried(rung);
    }
  }
  return false;
}

void PathSearch::climb(Rung rung, Inquiry& now, Corrector& corrector) const {
  switch (rung) {
    case Rung::faces: return go_over_faces(now);
    case Rung::table: return ask_table(now, corrector);
    case Rung::fields: return march_fields(now, corrector);
    case Rung::walks: return walk(now, corrector);
    case Rung::closer: return look_closer(now, corrector);
    case Rung::wider: return look_wider(now, corrector);
    case Rung::fan: return spread_fan(now, corrector);
    case Rung::border: return go_along_border(now);
  }
}

PathResult PathSearch::conclude(Inquiry now) const {
  if (!now.best && now.fallback) now.best = std::move(now.fallback);
  if (!now.best) {
    now.give_up(Status::not_converged, Obstacle::Kind::no_way);
    const bool walks = options_.method != CorrectionMethod::grid;
    now.best->obstacle =
        find_obstacle(surface_, now.from(), now.to(), {now.blank.cell, now.barrier, levels().mostly_resolved(), walks});
    if (now.best->obstacle.kind == Obstacle::Kind::singular_end) now.best->status = Status::rank_deficient;
  }
  PathResult result = *std::move(now.best);
  result.seconds = now.blank.seconds;
  result.rungs = std::move(now.rungs);
  result.doubts = now.doubts;
  if (result.status == Status::ok && result.corrected && !now.settled) result.doubts.add(now.over_edges);
  result.unique = result.status == Status::ok && result.corrected && !result.tied && !result.doubts.any();
  if (result.doubts.has(Doubt::beyond_window)) result.window = now.window;
  if (result.message.empty()) result.message = explain(result);
  return result;
}

/// The paper's march goes wherever cells hang together: where it finds no way, finer cells would have none either. It
/// keeps to the cells that were asked for.
int PathSearch::num_levels() const { return marches_between_centres(options_) ? 1 : levels().num_levels(); }

/// Where the last cells led nowhere: may the next be made, and is there nothing cheaper to try before.
bool PathSearch::is_affordable(const Inquiry& now) const {
  if (!now.blocked || now.best) return true;
  if (fan_can_help(now)) return false;
  if (scope_ == Scope::window) return now.next_cells <= kLadderRules.most_cells_in_window;
  const bool fitted = surface_.samples() != nullptr;
  if (now.next_cells > (fitted ? kLadderRules.most_fitted_cells : kLadderRules.most_cells)) return false;
  return now.tried(Rung::walks) || now.next_cells <= kLadderRules.most_cells_before_walks;
}

/// A fan costs some 10 to 1,000 ms. It comes where finer cells for a part of the box cannot lift the doubts about a
/// path, and where the next cells are dear and there is no path yet.
bool PathSearch::fan_can_help(const Inquiry& now) const {
  const bool smooth = surface_.dim() == 3 && surface_.codim() == 1 && !kinked_;
  const bool paper = marches_between_centres(options_) || options_.method == CorrectionMethod::grid;
  if (scope_ != Scope::whole || !smooth || paper || now.tried(Rung::fan)) return false;
  const bool bordered = surface_.samples() != nullptr && surface_.domain() != nullptr;
  if (!now.has_path()) {
    return !bordered && !now.best && now.blocked && now.next_cells > kLadderRules.most_cells_before_fan;
  }
  const bool may_be_beyond = levels().endless() && !have_room(*now.best, 0);
  // On a fit with a border that comes first, and of paths along it a fan knows nothing.
  const bool by_border = bordered && (now.tried(Rung::border) || can_help(Rung::border, now));
  return (now.doubts.any() || may_be_beyond) && !by_border && !can_help(Rung::closer, now);
}

/// Are the cells too coarse, as a whole or along this path, for a way found on them to be surely the shortest.
Doubts PathSearch::doubts_of_cells(const PathResult& found, int level) const {
  if (!found.corrected) return {};
  if (!levels().resolved()) return {Doubt::coarse_cells};
  if (found.status != Status::ok) return {};
  if (finder_.bends_sharply(level, found.points)) return {Doubt::sharp_bends};
  return {};
}

/// The part of the box that shorter paths can visit: the ellipsoid about the ends whose points are no farther from both
/// than the path is long.
Box PathSearch::part_of_shorter(const PathResult& found) const {
  return intersection(box_of_shorter_paths(found.from, found.to, found.length), levels().box());
}

/// Is that part so much smaller than the box that its cells will be finer. Where the size was asked for, cells of the
/// size that would be chosen do, too.
bool PathSearch::has_smaller_part(const PathResult& found) const {
  return options_.cell > 0 ||
         part_of_shorter(found).extent().maxCoeff() <= kLadderRules.smaller_part * levels().box().extent().maxCoeff();
}

/// The first window, made wider where the surface has no end.
Box PathSearch::window(int doublings) const {
  const Box& first = levels().extent().window;
  const Vector middle = (first.lower + first.upper) / 2;
  const Vector half = levels().extent().endless.select((std::ldexp(0.5, doublings) * first.extent()).array(),
                                                       0.5 * first.extent().array());
  return {middle - half, middle + half};
}

/// Does that window hold all paths that are shorter.
bool PathSearch::have_room(const PathResult& found, int doublings) const {
  const Box seen = window(doublings);
  const Box shorter = box_of_shorter_paths(found.from, found.to, found.length);
  return (!levels().extent().endless ||
          (shorter.lower.array() >= seen.lower.array() && shorter.upper.array() <= seen.upper.array()))
      .all();
}

/// Cells of a given size get ever more.
bool PathSearch::is_window_affordable(const PathResult& found, int doublings) const {
  if (options_.cell == 0) return true;
  const Index most = found.status == Status::ok ? kLadderRules.most_cells_for_shorter : kLadderRules.most_cells_for_any;
  return found.num_cells <= most >> (doublings * (surface_.dim() - surface_.codim()));
}

}  // namespace taut::detail
