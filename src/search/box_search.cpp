#include "search/box_search.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "curve/polyline.hpp"
#include "search/no_way.hpp"
#include "search/shorter_paths.hpp"

namespace taut::detail {
namespace {

/// Before cells get finer than so many, ways are sought without them; beyond so many, no longer with them.
constexpr Index kMostCellsBeforeWalks = 2'000'000;
constexpr Index kMostCellsForSheets = 6'000'000;
constexpr Index kMostCellsFarther = 500'000;
/// On a surface fitted to samples a cell takes about a millisecond.
constexpr Index kMostFittedCells = 100'000;
/// A part of the box is looked at again where it is smaller by this.
constexpr double kCloser = 0.7;
/// Cells of another size are worth making if they are smaller by this.
constexpr double kFiner = 0.75;
/// Where the surface bends sharply along a path, that is done if it is smaller by this, or the marched way is wrong by
/// more than that.
constexpr double kLocal = 0.5;
constexpr double kMismarched = 0.02;

}  // namespace

BoxSearch::BoxSearch(Surface surface, const PathOptions& options, const Context& context, Look look)
    : surface_(std::move(surface)),
      options_(options),
      context_(context),
      look_(look),
      finder_(surface_, options_, context_) {}

PathResult BoxSearch::find(const Vector& p, const Vector& q, Corrector& corrector, std::optional<Starts> first) const {
  PathResult result;
  result.from = p;
  result.to = q;
  if (p == q) {
    result.status = Status::ok;
    result.locally_shortest = true;
    result.index = 0;
    result.points = chord(p, q);
    result.grid_path = result.points;
    result.cell = levels().size(0);
    return result;
  }
  const auto take = [&](const Starts& starts) {
    result.cell = starts.cell;
    result.rivals_sought = starts.rivals_sought;
    result.marched = starts.marched;
    result.walked_cells = starts.walked;
    if (starts.cells) {
      result.num_cells = starts.cells->num_cells();
      result.num_layers = starts.cells->num_layers();
      result.grid = levels().grid();
    }
    result.seconds.cells += starts.seconds.cells;
    result.seconds.march += starts.seconds.march;
  };
  std::optional<PathResult> by_table;
  if (!first) {
    const Starts starts = finder_.find_by_table(p, q);
    take(starts);
    if (!starts.paths.empty()) {
      if (corrector.correct(result, starts, false)) {
        if (!levels().resolved()) return look_closer(std::move(result), corrector);
        // On which side of a spike a way begins no landmark tells.
        if (!finder_.bends_sharply(0, result.points)) return result;
      }
      if (result.status == Status::ok) by_table = result;
    }
  }
  // Cells that cannot tell sheets apart lead nowhere, or to a start from which the correction fails, or past the
  // shortest way: try finer ones. The first path above doubt is returned; failing that, the better of the first two.
  // That no path comes from cells far coarser, by request, than would be chosen says little, and does not count.
  std::optional<PathResult> best;
  std::optional<Barrier> barrier;
  bool tried = false;
  bool sure = true;
  bool doubts = false;
  std::optional<PathResult> walked;
  double marched = 0;
  const auto disconnected = [&] {
    result.status = Status::disconnected;
    result.message = kApart;
    result.proved_apart = true;
    return result;
  };
  for (int level = 0; level < num_levels(); ++level) {
    if (finder_.known_to_be_apart(level, p, q)) return disconnected();
    Starts starts;
    try {
      starts = level == 0 && first ? *std::move(first) : finder_.find(p, q, level);
    } catch (const OutOfMemory& error) {
      if (levels().lazy()) return walk_past_cells(std::move(result), p, q, corrector, error.what());
      if (level == 0) throw;
      break;
    }
    take(starts);
    barrier = starts.barrier;
    if (starts.paths.empty() && !levels().exist()) {
      result.status = Status::disconnected;
      result.message = fmt::format(
          "no path was found: the two points seem to lie on different components (random searches from both ends do "
          "not meet; in {} dimensions there are no cells to prove it; --samples may help)",
          surface_.dim());
      return result;
    }
    if (starts.paths.empty()) {
      if (finder_.apart(*starts.cells, level, p, q)) return disconnected();
      const Index finer = starts.cells->num_cells() << (surface_.dim() - 1);
      if (look_ == Look::farther && finer > kMostCellsFarther) break;
      if (!walked && finer > kMostCellsBeforeWalks) {
        walked = walk(result, p, q, corrector);
        if (walked->status == Status::ok) return *std::move(walked);
      }
      if (finer > (surface_.samples() != nullptr ? kMostFittedCells : kMostCellsForSheets)) break;
      context_.tell(fmt::format("cells of {:.3g} cannot tell the sheets of the surface apart; trying finer ones",
                                levels().size(level)));
      continue;
    }
    // Within a cell the start is as good as it gets; without cells there is no other.
    const bool only = !levels().exist() || (p - q).norm() < result.cell;
    const bool second_try = tried;
    const bool coarse = levels().coarser_than_chosen(level);
    const bool last = only || second_try || coarse || level + 1 == num_levels();
    sure = corrector.correct(result, starts, last) || only;
    marched = starts.paths.front().length;
    if (!best || is_better(result, *best)) {
      best = result;
      doubts = result.corrected && doubted(result, starts, level);
    }
    best->seconds = result.seconds;
    tried = !coarse || best->status == Status::ok;
    if (sure || second_try) break;
  }
  if (!best) {
    if (!walked && levels().exist() && look_ != Look::farther) walked = walk(result, p, q, corrector);
    if (walked && walked->points.cols() > 0) return *std::move(walked);
    const bool walks = options_.method != CorrectionMethod::grid;
    explain_no_way(result, surface_, {barrier, levels().mostly_resolved(), walks});
    return result;
  }
  if (by_table && is_better(*by_table, *best)) {
    by_table->seconds = best->seconds;
    best = std::move(by_table);
  }
  if (!sure && best->status == Status::ok && options_.method != CorrectionMethod::grid) {
    best->rivals_sought = false;
    best->message = fmt::format(
        "a shorter path may exist: the cells know a way of length {:.6g}, but no geodesic was found along it", marched);
  }
  return doubts ? look_closer(*std::move(best), corrector) : *std::move(best);
}

/// The paper's march goes wherever cells hang together: where it finds no way, finer cells would have none either. It
/// keeps to the cells that were asked for.
int BoxSearch::num_levels() const { return marches_between_centres(options_) ? 1 : levels().num_levels(); }

/// Are the cells too coarse, as a whole or along this path, for a way found on them to be surely the shortest. Sharp
/// bends alone are no reason where finer cells for the part of the box that matters would be hardly finer.
bool BoxSearch::doubted(const PathResult& found, const Starts& starts, int level) const {
  if (!levels().resolved()) return true;
  if (found.status != Status::ok) return false;
  const bool local = box_of_shorter_paths(found.from, found.to, found.length).extent().maxCoeff() <
                     kLocal * levels().box().extent().maxCoeff();
  const double marched = starts.paths.front().length;
  const bool mismarched = std::abs(marched - found.length) > kMismarched * found.length;
  return (local || mismarched) && finder_.bends_sharply(level, found.points);
}

/// Cells too coarse for the whole box may be fine enough for the part of it that shorter paths can visit: the ellipsoid
/// about the ends whose points are no farther from both than the path is long. Where the size was asked for, cells of
/// the size that would be chosen there do, too. The paper's march keeps to its cells, and only says so.
PathResult BoxSearch::look_closer(PathResult found, Corrector& corrector) const {
  found.rivals_sought = false;
  if (found.status != Status::ok) return found;
  if (found.message.empty()) {
    found.message = fmt::format(
        "a shorter path may exist: cells of {:.3g} are coarser than the surface bends, and miss ways", found.cell);
  }
  if (look_ == Look::closer || marches_between_centres(options_)) return found;
  const Box& whole = levels().box();
  const Box near = intersection(box_of_shorter_paths(found.from, found.to, found.length), whole);
  const bool asked_for = options_.cell > 0;
  if (!asked_for && near.extent().maxCoeff() > kCloser * whole.extent().maxCoeff()) return found;
  PathOptions options = options_;
  options.cell = 0;
  const Points ends = chord(found.from, found.to);
  auto closer = std::make_unique<BoxSearch>(surface_.with_box(near), options, context_, Look::closer);
  closer->prepare(ends);
  if (closer->levels().size(0) > kFiner * found.cell) {
    options.cell = found.cell / 2;
    closer = std::make_unique<BoxSearch>(surface_.with_box(near), options, context_, Look::closer);
    closer->prepare(ends);
  }
  PathResult again;
  try {
    again = closer->find(found.from, found.to, corrector);
  } catch (const OutOfMemory&) {  // what was found is not lost
    return found;
  }
  if (again.status != Status::ok || again.length > (1 + options_.tolerance) * found.length) return found;
  add_seconds(found, again);
  return again;
}

/// Where cells grow with the march, and there may be no more of them before it arrives: what walks come to. Without a
/// curve, as not_converged, where they do not arrive either, or nothing is to be corrected.
PathResult BoxSearch::walk_past_cells(PathResult so_far, const Vector& p, const Vector& q, Corrector& corrector,
                                      std::string_view why) const {
  so_far.cell = levels().size(0);
  so_far.rivals_sought = false;
  const Starts starts = finder_.walk(p, q);
  so_far.seconds.march += starts.seconds.march;
  if (starts.paths.empty() || options_.method == CorrectionMethod::grid) {
    so_far.status = Status::not_converged;
    so_far.message = why;
    return so_far;
  }
  (void)corrector.correct(so_far, starts, true);
  const std::string problem = so_far.status == Status::ok ? "a shorter path may exist" : so_far.message;
  so_far.message = fmt::format("{} (found by walks: {})", problem, why);
  return so_far;
}

/// For ends that no cells have joined: thin shells, of which a cell holds both sides. Without a curve where walks find
/// no way either.
PathResult BoxSearch::walk(const PathResult& so_far, const Vector& p, const Vector& q, Corrector& corrector) const {
  const Starts starts = finder_.walk(p, q);
  PathResult found = so_far;
  found.seconds.march += starts.seconds.march;
  if (starts.paths.empty() || options_.method == CorrectionMethod::grid) return found;
  (void)corrector.correct(found, starts, true);
  // Walks on thin shells may step from sheet to sheet: where no geodesic comes of it, there was no way.
  const bool surely_a_way = surface_.dim() - surface_.codim() == 1;
  if (found.status != Status::ok && !surely_a_way) return so_far;
  found.rivals_sought = false;
  if (found.status == Status::ok) {
    found.message = fmt::format(
        "a shorter path may exist: cells of {:.3g} cannot tell the sheets of the surface apart, this one was found by "
        "walks from both ends",
        so_far.cell);
  }
  return found;
}

}  // namespace taut::detail
