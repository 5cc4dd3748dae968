#include "search/path_search.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "search/shorter_paths.hpp"
#include "surface/point_text.hpp"
#include "taut/cells/find_box.hpp"

namespace taut::detail {
namespace {

constexpr int kMostDoublings = 6;
/// Cells of a given size get ever more: so many to see whether a path is the shortest, and whether there is one.
constexpr Index kMostCellsForShorter = 6'000'000;
constexpr Index kMostCellsForAny = 500'000;

}  // namespace

/// The first one, made wider where the surface has no end.
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

/// A search that looks through that window.
const BoxSearch& PathSearch::through(int doublings) const {
  const std::lock_guard lock(mutex_);
  const auto at = static_cast<std::size_t>(doublings) - 1;
  if (wider_.size() <= at) wider_.resize(at + 1);
  if (!wider_[at]) {
    const SurfaceExtent seen = through_window(surface_, levels().extent(), window(doublings), context_);
    wider_[at] = std::make_unique<BoxSearch>(surface_.with_box(seen.box), options_, context_, BoxSearch::Look::farther);
    wider_[at]->prepare(levels().grows_from_ends() ? points_ : Points(surface_.dim(), 0));
  }
  return *wider_[at];
}

/// Where the surface goes on beyond the box, shorter ways may, too, or the only one: those are sought through windows
/// wide enough.
PathResult PathSearch::find(const Vector& p, const Vector& q, Corrector& corrector, std::optional<Starts> first) const {
  PathResult found = near_.find(p, q, corrector, std::move(first));
  Box seen = levels().box();
  for (int doublings = 0; levels().endless();) {
    const bool way = found.status == Status::ok;
    if (way ? have_room(found, doublings) : !found.proved_apart) break;
    const int before = doublings++;
    while (way && doublings < kMostDoublings && !have_room(found, doublings)) ++doublings;
    if (doublings <= kMostDoublings && is_affordable(found, doublings - before)) {
      try {
        const BoxSearch& farther = through(doublings);
        PathResult again = farther.find(p, q, corrector);
        const bool ahead = way ? again.status == Status::ok && again.length <= (1 + options_.tolerance) * found.length
                               : again.status == Status::ok || again.proved_apart;
        add_seconds(found, again);
        if (ahead) {
          found = std::move(again);
          seen = farther.levels().box();
          continue;
        }
        found.seconds = again.seconds;
      } catch (const OutOfMemory&) {  // what was found is not lost
      }
    }
    found.rivals_sought = false;
    found.message = way ? fmt::format("a shorter path may exist: the surface goes on beyond {}", text_of(seen))
                        : fmt::format("{} within {}, beyond which it goes on", kApart, text_of(seen));
    break;
  }
  return found;
}

bool PathSearch::is_affordable(const PathResult& found, int doublings) const {
  if (options_.cell == 0) return true;
  const Index most = found.status == Status::ok ? kMostCellsForShorter : kMostCellsForAny;
  return found.num_cells <= most >> (doublings * (surface_.dim() - surface_.codim()));
}

}  // namespace taut::detail
