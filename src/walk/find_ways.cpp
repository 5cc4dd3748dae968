#include "walk/find_ways.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <utility>

#include "core/random.hpp"
#include "walk/follow_curve.hpp"
#include "walk/ray_ways.hpp"
#include "walk/sample_graph.hpp"
#include "walk/surface_walker.hpp"
#include "walk/tree_search.hpp"

namespace taut::detail {
namespace {

constexpr int kStepsPerChord = 48;
/// Random searches by turns, each with steps half as long as those before.
constexpr int kSearches = 3;
/// Where the straight walk is stuck, q lies close behind p and several ways round may be about as long: walks that
/// begin in so many random directions, and opposite to them, this part of the distance.
constexpr int kDetours = 6;
constexpr double kDetour = 0.3;

Points walk_round(SurfaceWalker& walker, const Foothold& start, const Vector& direction, const Vector& q) {
  std::vector<Foothold> steps;
  const Vector aside = start.point + kDetour * (q - start.point).norm() * direction;
  (void)walker.walk(start, aside, kStepsPerChord, steps);
  if (steps.empty()) return Points(q.size(), 0);
  const Points rest = walker.walk(steps.back().point, q);
  if (rest.cols() < 2) return Points(q.size(), 0);
  const auto count = static_cast<Index>(steps.size());
  Points path(q.size(), count + rest.cols());
  path.col(0) = start.point;
  for (Index i = 0; i < count; ++i) path.col(i + 1) = steps[static_cast<std::size_t>(i)].point;
  path.rightCols(rest.cols() - 1) = rest.rightCols(rest.cols() - 1);
  return path;
}

void add_detours(SurfaceWalker& walker, const Vector& p, const Vector& q, std::vector<Points>& ways) {
  Foothold start;
  if (!walker.stand(p, walker.step(), start)) return;
  start.point = p;
  std::mt19937_64 random(1);
  for (int i = 0; i < kDetours; ++i) {
    const Vector direction = random_direction(p.size(), random);
    for (const double sign : {1.0, -1.0}) {
      Points way = walk_round(walker, start, sign * direction, q);
      if (way.cols() >= 2) ways.push_back(std::move(way));
    }
  }
}

}  // namespace

Ways find_ways(const Surface& surface, const Vector& p, const Vector& q, bool all, const Context& context) {
  if (surface.dim() - surface.codim() == 1) return {follow_curve(surface, p, q, context), Ways::Sought::all};
  const double step = (q - p).norm() / kStepsPerChord;
  SurfaceWalker walker(surface, step);
  Ways result;
  std::vector<Points>& ways = result.paths;
  Points walk = walker.walk(p, q);
  if (walk.cols() < 2) walk = walker.walk(q, p).rowwise().reverse().eval();
  if (walk.cols() >= 2) ways.push_back(std::move(walk));
  if (surface.samples() != nullptr && surface.samples()->size() > 0) {
    Points way = search_by_samples(walker, p, q, surface.samples()->points, context);
    if (way.cols() >= 2) ways.push_back(std::move(way));
  }
  // Of a thin body a straight walk may have stepped to the other sheet, and lead nowhere.
  std::vector<Points> rays = ways_by_rays(surface, p, q, context);
  if (!rays.empty()) result.sought = Ways::Sought::at_random;
  std::ranges::move(rays, std::back_inserter(ways));
  if (all || ways.empty()) {
    add_detours(walker, p, q, ways);
    result.sought = Ways::Sought::at_random;
  }
  for (int search = 0; search < kSearches && ways.empty(); ++search) {
    SurfaceWalker shorter(surface, step / (1 << search));
    Points way = search_by_trees(shorter, p, q, {.seed = static_cast<std::uint64_t>(search + 1)}, context);
    if (way.cols() >= 2) ways.push_back(std::move(way));
  }
  return result;
}

}  // namespace taut::detail
