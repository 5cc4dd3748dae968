// Shortest paths over edges and along borders: ways over a graph of all faces, each shortened to a broken geodesic, the
// shortest of which is the path. The graph's ways are a few per cent too long, so that all within that of the best
// length found are shortened. The box of the graph must hold all shorter paths, and its cells must be small against the
// path; else another one is made.
#include "search/facet_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/stopwatch.hpp"
#include "search/candidates.hpp"
#include "search/chain_result.hpp"
#include "search/shorter_paths.hpp"
#include "strata/facet_ways.hpp"
#include "strata/shorten_chain.hpp"
#include "strata/way_chain.hpp"
#include "taut/core/error.hpp"

namespace taut::detail {
namespace {

/// Cells of a graph, about: some 10 to 20 ms.
constexpr double kCells = 4000;
/// A graph's ways are too long by at most this part, and too short by its bends.
constexpr double kWaySlack = 0.06;
/// Of all ways, those up to so many times as long.
constexpr double kAllSlack = 3;
/// A path is at least so many cells long, or the graph is made again around it.
constexpr double kCellsAlong = 8;
constexpr int kMostGraphs = 8;
/// A graph of a whole surface reaches so far beyond it, of its size.
constexpr double kMargin = 1e-3;
/// Where the surface goes on, a graph reaches so far beyond the points, of the diagonal of their box; one that is there
/// already is good enough if it reaches so far.
constexpr double kAround = 0.6;
constexpr double kLeastAround = 0.1;
/// Cells of a graph around one path, about: these are closer together.
constexpr double kCellsAround = 1000;
/// So many times as many cells where no way settled.
constexpr double kFiner = 4;

/// All of a surface that ends, and a little more.
Box whole_box(const SurfaceExtent& extent) {
  const Vector margin = Vector::Constant(3, kMargin * extent.box.diagonal());
  return {extent.box.lower - margin, extent.box.upper + margin};
}

}  // namespace

FacetSearch::FacetSearch(const Surface& surface, const PathOptions& options, const Context& context)
    : options_(options), context_(context) {
  if (options.method != CorrectionMethod::newton || options.march != MarchMethod::convergent) {
    return;
  }
  surface_ = FacetedSurface::of(surface);
}

std::shared_ptr<const FacetGraph> FacetSearch::graph(const Box& box, double cells) {
  surface_->scale = box.diagonal();
  try {
    const double size = options_.cell > 0 ? options_.cell : cell_size_for(*surface_, box, cells, context_);
    auto graph = std::make_shared<const FacetGraph>(*surface_, box, size, context_);
    return graph->complete() ? graph : nullptr;
  } catch (const EmptySurface&) {
    return nullptr;
  }
}

bool FacetSearch::prepare(const SurfaceExtent& extent, const Box& points) {
  if (!extent.endless.any()) {
    if (shared_) return false;
    shared_ = graph(whole_box(extent), kCells);
  } else {
    const auto around = [&](double part) {
      const Vector reach = Vector::Constant(3, part * points.diagonal());
      return intersection({points.lower - reach, points.upper + reach}, extent.whole);
    };
    // Of a graph made for other points, unless it is too coarse for these.
    const Box least = around(kLeastAround);
    if (shared_ && shared_->box().contains(least.lower) && shared_->box().contains(least.upper) &&
        shared_->size() * kCellsAlong <= points.diagonal()) {
      return false;
    }
    shared_ = graph(around(kAround), kCells);
  }
  known_ = surface_->known();
  return true;
}

std::unique_ptr<FacetSearch> FacetSearch::clone() const {
  std::unique_ptr<FacetSearch> copy(new FacetSearch(options_, context_));
  copy->surface_ = surface_->clone();
  copy->shared_ = shared_;
  copy->known_ = known_;
  return copy;
}

bool FacetSearch::correct(const FacetGraph& graph, const Point3& p, const Point3& q, PathResult& result,
                          std::vector<Found>& found, double& shortest_way) {
  Stopwatch watch;
  surface_->scale = graph.box().diagonal();
  const double slack = options_.all ? kAllSlack : 1 + kWaySlack;
  const std::vector<FacetWay> ways = ways_between(*surface_, graph, p, q, slack);
  result.seconds.march += watch.restart();
  found.clear();
  shortest_way = ways.empty() ? 0 : ways.front().length;
  double best = std::numeric_limits<double>::infinity();
  double unsolved = best;
  ChainTrouble trouble;  // of the shortest way that was not settled
  for (const FacetWay& way : ways) {
    if (way.length > slack * best) break;
    bool first = true;  // the way's own chain
    for (FacetChain& chain : shorten_with_others(*surface_, chain_of(*surface_, way), context_)) {
      if (std::exchange(first, false) && !chain.solved && way.length < unsolved) {
        unsolved = way.length;
        trouble = chain.trouble;
      }
      if (!chain.solved) continue;
      best = std::min(best, chain.length);
      found.push_back({std::move(chain), way});
    }
  }
  result.seconds.correct += watch.restart();
  std::stable_sort(found.begin(), found.end(),
                   [](const Found& a, const Found& b) { return a.chain.length < b.chain.length; });
  result.obstacle = {};
  result.reason = {};
  result.marched = shortest_way;
  if (found.empty()) {
    if (!ways.empty()) add_trouble(trouble, unsolved, result);
    return false;
  }
  // Of a way that was not settled it is not known whether it is as short.
  result.doubts.remove(Doubt::start_failed);
  result.doubts.remove(Doubt::rivals_not_sought);
  if (unsolved < best) {
    // It promised a shorter path.
    result.doubts.add(Doubt::start_failed);
    result.obstacle = {Obstacle::Kind::faces, trouble.place, unsolved};
  } else if (unsolved <= (1 + kWaySlack) * best) {
    result.doubts.add(Doubt::rivals_not_sought);
  }
  return true;
}

PathResult FacetSearch::find(const Vector& p, const Vector& q, const SurfaceExtent& extent) {
  PathResult result = search(p, q, extent);
  surface_->forget_since(known_);
  return result;
}

PathResult FacetSearch::search(const Vector& p, const Vector& q, const SurfaceExtent& extent) {
  PathResult result;
  result.from = p;
  result.to = q;
  const bool ends = !extent.endless.any();
  const double apart = (q - p).norm();
  if (apart == 0) return result;
  const auto room = [&](double margin) {
    const Vector reach = Vector::Constant(3, margin);
    return intersection({p.cwiseMin(q) - reach, p.cwiseMax(q) + reach}, extent.whole);
  };
  Box box = ends ? whole_box(extent) : room(apart);
  // The shared graph first, where it holds both ends.
  std::shared_ptr<const FacetGraph> current = shared_;
  if (current != nullptr && !ends && !(current->box().contains(p) && current->box().contains(q))) current = nullptr;
  std::vector<Found> found;
  bool solved = false;
  double grown = apart;
  double cells = kCells;
  bool first_try = true;  // else: after one that left doubts
  std::vector<Found> first_try_found;
  Doubts first_try_doubts;
  Obstacle first_try_obstacle;
  const auto back_to_first = [&] {
    found = std::move(first_try_found);
    result.doubts = first_try_doubts;
    result.obstacle = first_try_obstacle;
    result.reason = {};
  };
  for (int round = 0; round < kMostGraphs; ++round) {
    if (round > 0 || current == nullptr) {
      const Stopwatch watch;
      current = graph(box, cells);
      result.seconds.cells += watch.seconds();
    }
    double way = 0;
    solved = current != nullptr && correct(*current, p, q, result, found, way);
    if (!solved && !first_try) {
      back_to_first();
      solved = true;
      break;
    }
    if (!solved && way > 0) {
      // There are ways, but none settled: on finer cells, around them.
      if (cells > kCells) break;
      cells = kFiner * kCells;
      box = intersection(box_of_shorter_paths(p, q, (1 + kWaySlack) * way), ends ? box : extent.whole);
      continue;
    }
    if (!solved) {
      if (ends) break;
      if (round > 0 || shared_ == nullptr) grown *= 2;
      cells = kCells;
      box = room(grown);
      continue;
    }
    const double length = found.front().chain.length;
    const Box needed = intersection(box_of_shorter_paths(p, q, length), ends ? whole_box(extent) : extent.whole);
    const bool holds = current->box().contains(needed.lower) && current->box().contains(needed.upper);
    const bool fine = current->size() <= length / kCellsAlong;
    if (holds && (fine || options_.cell > 0)) {
      if (!first_try) {
        // Twice looked at: the shorter one, and its doubts.
        const bool settled_now = !result.doubts.has(Doubt::start_failed);
        if (first_try_found.front().chain.length <= length) {
          const Doubts doubts = result.doubts;
          back_to_first();
          if (settled_now) {
            result.doubts = doubts;
            result.obstacle = {};
          }
        }
        break;
      }
      if (!result.doubts.has(Doubt::start_failed) || options_.cell > 0) break;
      first_try = false;
      first_try_found = found;
      first_try_doubts = result.doubts;
      first_try_obstacle = result.obstacle;
      cells = kFiner * kCells;
      box = needed;
      continue;
    }
    if (round + 1 == kMostGraphs) {
      result.doubts.add(Doubt::budget_spent);
      break;
    }
    if (holds && needed.extent().maxCoeff() > 0.7 * current->box().extent().maxCoeff()) break;
    cells = std::max(cells == kCells ? kCellsAround : cells, kCellsAround);
    box = needed;
  }
  if (current != nullptr) {
    result.cell = current->size();
    result.num_cells = current->num_cells();
    result.grid = GridMethod::subdivide;
  }
  if (!solved) return result;
  deliver(found, result);
  return result;
}

void FacetSearch::deliver(const std::vector<Found>& found, PathResult& result) const {
  const FacetChain& best = found.front().chain;
  add_chain(*surface_, best, result);
  const FacetWay& way = found.front().way;
  result.marched = way.length;
  result.grid_path.resize(3, static_cast<Index>(way.points.size()));
  for (std::size_t i = 0; i < way.points.size(); ++i) result.grid_path.col(static_cast<Index>(i)) = way.points[i];
  for (const Found& one : found) {
    add_candidate(result.candidates, {one.chain.length, length_error_of(one.chain), one.chain.locally_shortest,
                                      points_of(one.chain, result.from, result.to)});
  }
  result.tied = !first_is_unique(result.candidates, options_.tolerance);
}

}  // namespace taut::detail
