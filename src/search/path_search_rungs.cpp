// The rungs of path_search.cpp: what each does, and which doubts it leaves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/stopwatch.hpp"
#include "curve/polyline.hpp"
#include "fan/fan_answers.hpp"
#include "fan/geodesic_fan.hpp"
#include "search/border_search.hpp"
#include "search/contact_search.hpp"
#include "search/ladder_rules.hpp"
#include "search/path_search.hpp"
#include "taut/cells/find_cells.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"

namespace taut::detail {
namespace {

/// Corrects starts; the time of that counts.
bool correct(Inquiry& now, Corrector& corrector, const Starts& starts, bool last, PathResult& result) {
  result = now.blank;
  const bool sure = corrector.correct(result, starts, last);
  now.blank.seconds = result.seconds;
  now.beyond = corrector.beyond();
  return sure;
}

}  // namespace

/// On a surface with edges the other rungs would follow one face beyond its end, or go round. They come after this one
/// where it cannot be asked or knows no way at all, and their path is in doubt.
void PathSearch::go_over_faces(Inquiry& now) const {
  std::optional<PathResult> found = faces_.find(now.from(), now.to(), levels().extent());
  if (!kinked_) {
    // A path that meets no border is left to the search that knows none: obstacles that are not met change nothing.
    if (found) now.add_effort(*found);
    const auto is_along = [](const PathPiece& piece) { return piece.kind == PathPiece::Kind::border; };
    if (!found || found->status != Status::ok || found->doubts.any() || !std::ranges::any_of(found->pieces, is_along)) {
      return;
    }
    now.best = std::move(found);
    now.settled = true;
    return;
  }
  if (!found) {
    now.over_edges.add(Doubt::edges_not_searched);
    return;
  }
  now.add_effort(*found);
  if (found->status != Status::ok && !(found->marched > 0)) {
    now.over_edges.add(Doubt::edges_failed);
    return;
  }
  // There are ways. Where none was made a geodesic, a search for smooth surfaces would not do better.
  now.doubts = found->doubts;
  now.best = std::move(found);
  now.settled = true;
}

void PathSearch::ask_table(Inquiry& now, Corrector& corrector) const {
  const Starts starts = finder_.find_by_table(now.from(), now.to());
  now.note(starts, levels().grid());
  if (starts.paths.empty()) return;
  PathResult result;
  const bool sure = correct(now, corrector, starts, false, result);
  if (result.status != Status::ok) return;  // fields do better
  now.doubts = starts.doubts;
  if (!sure) {
    now.doubts.add(Doubt::start_failed);
  } else if (!levels().resolved()) {
    now.doubts.add(Doubt::coarse_cells);
  } else if (finder_.bends_sharply(0, result.points)) {
    now.doubts.add(Doubt::sharp_bends);
  }
  now.best = std::move(result);
}

/// Cells that cannot tell sheets apart lead nowhere, or to a start from which the correction fails, or past the
/// shortest way: finer ones are tried. The first path above doubt is kept; failing that, the better of the first two.
/// That no path comes from cells far coarser, by request, than would be chosen says little, and does not count.
void PathSearch::march_fields(Inquiry& now, Corrector& corrector) const {
  const int level = now.level++;
  if (finder_.known_to_be_apart(level, now.from(), now.to())) {
    now.give_up(Status::disconnected, Obstacle::Kind::apart);
    return;
  }
  if (level > 0 && !now.best) {
    context_.tell(fmt::format("cells of {:.3g} cannot tell the sheets of the surface apart; trying finer ones",
                              levels().size(level - 1)));
  }
  Starts starts;
  try {
    const bool given = level == 0 && now.first;
    starts = given ? *std::exchange(now.first, std::nullopt) : finder_.find(now.from(), now.to(), level);
  } catch (const OutOfMemory&) {
    if (level == 0 && !levels().lazy()) throw;
    now.level = num_levels();  // finer ones would not fit either
    now.cells_spent = levels().lazy();
    if (now.cells_spent) now.blank.cell = levels().size(0);
    return;
  }
  now.note(starts, levels().grid());
  now.barrier = starts.barrier;
  now.blocked = starts.paths.empty();
  now.next_cells = starts.cells->num_cells() << (surface_.dim() - 1);
  if (now.blocked) {
    if (finder_.apart(*starts.cells, level, now.from(), now.to())) {
      now.give_up(Status::disconnected, Obstacle::Kind::apart);
    }
    return;
  }
  // Within a cell the start is as good as it gets.
  const bool only = (now.from() - now.to()).norm() < starts.cell;
  const bool coarse = levels().coarser_than_chosen(level);
  const bool second = now.counts;
  const bool last = only || second || coarse || level + 1 == num_levels();
  PathResult result;
  const bool sure = correct(now, corrector, starts, last, result) || only;
  const bool better = !now.best || is_better(result, *now.best);
  if (better) now.best = std::move(result);
  if (better || !now.marched) now.of_cells = doubts_of_cells(*now.best, level);
  now.marched = true;
  now.counts = now.counts || !coarse || now.has_path();
  if (second) now.level = num_levels();
  now.doubts = starts.doubts;
  now.doubts.add(now.of_cells);
  if (!sure) now.doubts.add(Doubt::start_failed);
}

/// In more dimensions than cells reach; where cells have joined the ends nowhere: thin shells, of which a cell holds
/// both sides; and where no more cells may grow.
void PathSearch::walk(Inquiry& now, Corrector& corrector) const {
  const Starts starts = finder_.walk(now.from(), now.to());
  const bool no_cells = !levels().exist();
  if (no_cells) {
    now.note(starts, GridMethod::automatic);
  } else {
    now.blank.seconds.march += starts.seconds.march;
  }
  if (starts.paths.empty() || options_.method == CorrectionMethod::grid) {
    if (no_cells) now.give_up(Status::disconnected, Obstacle::Kind::apart_by_walks);
    if (now.cells_spent) now.give_up(Status::not_converged, Obstacle::Kind::cells_spent);
    return;
  }
  PathResult result;
  (void)correct(now, corrector, starts, true, result);  // there are no other starts
  const bool ok = result.status == Status::ok;
  if (no_cells || now.cells_spent || ok) {
    now.doubts = starts.doubts;
    if (now.cells_spent) now.doubts.add(Doubt::cells_spent);
    if (!no_cells && !now.cells_spent) now.doubts.add(Doubt::sheets_not_told);
    now.best = std::move(result);
    return;
  }
  // Walks on thin shells may step from sheet to sheet: where no geodesic comes of it, there was no way. Along a curve
  // there was.
  if (surface_.dim() - surface_.codim() == 1) now.fallback = std::move(result);
}

/// Cells too coarse for the whole box may be fine enough for the part of it that shorter paths can visit. The paper's
/// march keeps to its cells.
void PathSearch::look_closer(Inquiry& now, Corrector& corrector) const {
  const PathResult& found = *now.best;
  const Box part = part_of_shorter(found);
  PathOptions options = options_;
  const auto search = [&](double cell) {
    options.cell = cell;
    auto closer = std::make_unique<PathSearch>(surface_.with_box(part), options, context_, Scope::part);
    closer->prepare(chord(found.from, found.to));
    return closer;
  };
  std::unique_ptr<PathSearch> closer = search(0);
  if (closer->levels().size(0) > kLadderRules.finer_cells * found.cell) closer = search(found.cell / 2);
  try {
    PathResult again = closer->find(found.from, found.to, corrector);
    now.add_effort(again);
    if (again.status != Status::ok || again.length > (1 + options_.tolerance) * found.length) return;
    now.doubts = again.doubts;
    again.message.clear();
    now.best = std::move(again);
  } catch (const OutOfMemory&) {  // what was found is not lost
  }
}

/// A search that looks through that window.
const PathSearch& PathSearch::through(int doublings) const {
  const std::lock_guard lock(wider_turn_);
  const auto at = static_cast<std::size_t>(doublings) - 1;
  if (wider_.size() <= at) wider_.resize(at + 1);
  if (!wider_[at]) {
    const SurfaceExtent seen = through_window(surface_, levels().extent(), window(doublings), context_);
    wider_[at] = std::make_unique<PathSearch>(surface_.with_box(seen.box), options_, context_, Scope::window);
    wider_[at]->prepare(levels().grows_from_ends() ? points_ : Points(surface_.dim(), 0));
  }
  return *wider_[at];
}

/// Where the surface goes on beyond the box, shorter ways may, too, or the only one: those are sought through windows
/// wide enough.
void PathSearch::look_wider(Inquiry& now, Corrector& corrector) const {
  if (now.doublings == 0) now.window = levels().box();
  const bool path = now.has_path();
  const PathResult& found = *now.best;
  const int before = now.doublings++;
  const int most = kLadderRules.most_doublings;
  while (path && now.doublings < most && !have_room(found, now.doublings)) ++now.doublings;
  if (now.doublings <= most && is_window_affordable(found, now.doublings - before)) {
    try {
      const PathSearch& wider = through(now.doublings);
      PathResult again = wider.find(now.from(), now.to(), corrector);
      now.add_effort(again);
      const bool ahead = path ? again.status == Status::ok && again.length <= (1 + options_.tolerance) * found.length
                              : again.status == Status::ok || again.obstacle.kind == Obstacle::Kind::apart;
      if (ahead) {
        now.window = wider.levels().box();
        now.doubts = again.doubts;
        again.message.clear();
        now.best = std::move(again);
        return;
      }
    } catch (const OutOfMemory&) {  // what was found is not lost
    }
  }
  now.doubts.add(Doubt::beyond_window);
  now.window_shut = true;
}

/// The size of the cells that bound a fan's panels, and do those follow the surface's bends. A size that was asked for
/// may be far too coarse.
std::pair<double, bool> PathSearch::cells_for_fan() const {
  if (options_.cell == 0) return {levels().size(0), levels().resolved()};
  CellLevels chosen(surface_, {.method = options_.grid}, context_);
  chosen.prepare(points_);
  (void)chosen.cells(0, points_);
  return {std::min(levels().size(0), chosen.size(0)), chosen.resolved()};
}

/// All geodesics from the start, in every direction: the least that meets the end is the shortest path, whatever the
/// cells have missed, and where none does there is no path. Of what is smaller than the cells that bound its panels a
/// fan may know nothing, so that doubt stays.
void PathSearch::spread_fan(Inquiry& now, Corrector& corrector) const {
  const Stopwatch watch;
  const LadderRules& rules = kLadderRules;
  const auto [cell, resolved] = cells_for_fan();
  const auto most = static_cast<Index>(rules.fan_effort * static_cast<double>(most_evaluated(surface_)));
  const double longest =
      now.has_path() ? (1 + rules.fan_rivals) * now.best->length : std::numeric_limits<double>::infinity();
  Starts starts;
  FanAnswer answer;
  try {
    const Vector value = Vector::Zero(1);
    GeodesicFan fan(surface_, now.from(), value,
                    {.tolerance = rules.fan_tolerance, .max_panel = kPanelCells * cell, .max_evaluated = most});
    answer = ask_fan(fan, surface_, now.from(), value, now.to(), longest, context_).front();
    const bool complete = fan.finished() && !fan.broken() && std::isinf(fan.reach());
    const bool met = std::isfinite(std::min(answer.hit.distance, answer.hit.astray));
    if (!now.best && complete && !met) now.give_up(Status::disconnected, Obstacle::Kind::apart_by_fan);
    // Farther than the path that is there: then the fan does not know that one.
    if (answer.kind == FanAnswer::Kind::proved) {
      std::vector<FanHit> ways = fan.ways(now.to(), (1 + rules.fan_rivals) * answer.hit.distance);
      if (ways.empty()) ways.push_back(answer.hit);  // it has not left the domain
      for (const FanHit& way : ways) add_ray(way, now, starts);
    }
  } catch (const SingularPoint&) {  // no geodesics leave from there
  }
  now.blank.seconds.march += watch.seconds();
  if (starts.paths.empty()) return;
  PathResult result;
  const bool sure = correct(now, corrector, starts, true, result);
  const double error = answer.hit.error + result.length_error + rules.fan_rivals * answer.hit.distance;
  if (!sure || result.status != Status::ok || std::abs(result.length - answer.hit.distance) > error) return;
  now.best = std::move(result);
  now.doubts = {};
  now.proved = true;
  if (!resolved) now.doubts.add(Doubt::coarse_cells);
}

/// A geodesic of a fan as a start.
void PathSearch::add_ray(const FanHit& way, const Inquiry& now, Starts& starts) const {
  ExponentialMap rays(surface_, {.tolerance = 1e-12, .conjugate = false});
  ExponentialResult ray = rays.trace(Vector(way.foot), Vector(way.departure), way.distance, context_);
  if (ray.status != Status::ok || ray.points.cols() < 2) return;
  ray.points.col(0) = now.from();
  ray.points.rightCols(1) = now.to();
  starts.paths.push_back({way.distance, std::move(ray.points)});
}

/// Where a domain cuts the surface the shortest path may run along the cut: it is the shorter one, or the only one.
void PathSearch::go_along_border(Inquiry& now) const {
  if (surface_.samples() != nullptr) return go_along_samples(now);
  if (has_contacts(surface_, options_)) return follow_borders(now);
  std::optional<PathResult> other = faces_.find(now.from(), now.to(), levels().extent());
  if (!other) return;
  now.add_effort(*other);
  if (other->status != Status::ok && now.best->status == Status::left_domain &&
      other->obstacle.kind == Obstacle::Kind::faces) {
    now.best->obstacle = other->obstacle;
    now.best->reason = other->reason;
    now.best->message.clear();
  }
  if (other->status != Status::ok || (now.has_path() && now.best->length <= other->length)) return;
  now.doubts = other->doubts;
  now.best = std::move(other);
}

/// The same in more dimensions: from every start that has led out of the domain.
void PathSearch::follow_borders(Inquiry& now) const {
  PathResult other = search_contacts(surface_, options_, now.beyond, now.from(), now.to(), context_);
  now.add_effort(other);
  const bool found = other.status == Status::ok;
  if (!found && !now.has_path()) {
    now.best->obstacle = other.obstacle;
    now.best->reason = other.reason;
    now.best->message.clear();
    return;
  }
  const bool better = found && !(now.has_path() && now.best->length <= other.length);
  now.doubts.remove(Doubt::start_failed);
  now.doubts.add(other.doubts);
  if (!found) now.doubts.add(Doubt::start_failed);
  if (!better) {
    now.best->obstacle = other.obstacle;
    return;
  }
  other.cell = now.blank.cell;
  other.num_cells = now.blank.num_cells;
  other.grid = now.blank.grid;
  now.best = std::move(other);
}

/// The same where the samples of a fit end, on cells of one size after the other. Where no step of any leads on, the
/// points are not joined as far as such steps can tell.
void PathSearch::go_along_samples(Inquiry& now) const {
  if (surface_.dim() != 3 || surface_.codim() != 1 || !levels().exist() || levels().lazy()) return;
  if (marches_between_centres(options_) || options_.method != CorrectionMethod::newton) return;
  for (int level = 0; level < num_levels(); ++level) {
    std::shared_ptr<SurfaceCells> cells;
    try {
      cells = finder_.ground(level, chord(now.from(), now.to())).cells;
    } catch (const OutOfMemory&) {
      return;
    }
    BorderAnswer answer = search_along_border(surface_, options_, *cells, now.from(), now.to(), context_);
    now.add_effort(answer.result);
    const bool last = 4 * cells->num_cells() > kLadderRules.most_fitted_cells;
    if (answer.kind == BorderAnswer::Kind::path) {
      if (now.has_path() && now.best->length <= answer.result.length) return;
      now.doubts = answer.result.doubts;
      now.best = std::move(answer.result);
      return;
    }
    if (answer.kind == BorderAnswer::Kind::none && !now.has_path()) {
      const bool apart = finder_.apart(*cells, level, now.from(), now.to());
      if (apart || last) {
        now.give_up(Status::disconnected, apart ? Obstacle::Kind::apart : Obstacle::Kind::no_way);
        return;
      }
    }
    if (last) return;
  }
}

}  // namespace taut::detail
