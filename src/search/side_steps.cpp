// Further starts where a known way passes a sharp bend: from its middle a short ray to the left and one to the right,
// and from each tip down both fields. A tip's s = u_p + u_q bounds the way through it; those too long are left.
#include "search/side_steps.hpp"

#include <Eigen/Geometry>
#include <cstdint>
#include <utility>

#include "march/march_over.hpp"
#include "march/point_normals.hpp"
#include "search/scout.hpp"
#include "taut/core/error.hpp"
#include "taut/curve/exponential_map.hpp"
#include "taut/march/march.hpp"
#include "taut/surface/projection.hpp"

namespace taut::detail {
namespace {

/// Length of a step aside, in cells: half of it and twice of it lead to the same geodesics.
constexpr double kAside = 1;

/// The middles of the parts of a way with sharp bends, but for those at its ends.
std::vector<Index> sharp_places(const std::vector<std::uint8_t>& sharp) {
  std::vector<Index> places;
  const auto size = static_cast<Index>(sharp.size());
  for (Index first = 0, end = 0; first < size; first = end + 1) {
    for (end = first; end < size && sharp[static_cast<std::size_t>(end)] != 0;) ++end;
    if (first > 0 && end > first && end < size) places.push_back((first + end - 1) / 2);
  }
  return places;
}

/// Points a step to the left and to the right of a way at one of its inner points: along geodesics, for the nearest
/// surface point may be across a cleft. Those that can be reached.
std::vector<Vector> aside(ExponentialMap& map, const Surface& surface, const Points& way, Index at, double step,
                          const Context& context) {
  std::vector<Vector> points;
  const ProjectionResult on = project_to_surface(surface, way.col(at));
  if (!on.converged) return points;
  const Eigen::Vector3d normal = normals_at(surface, on.point).col(0);
  const Eigen::Vector3d along = way.col(at + 1) - way.col(at - 1);
  const Vector side = normal.cross(along).normalized();
  if (!side.allFinite()) return points;
  for (const double sign : {-1.0, 1.0}) {
    const ExponentialResult ray = map.trace(on.point, sign * side, step, context);
    if (ray.status == Status::ok) points.emplace_back(ray.points.rightCols(1));
  }
  return points;
}

}  // namespace

std::vector<StartPath> side_steps(const Surface& surface, const Ground& ground, const Points& way,
                                  const DistanceField& from_p, const DistanceField& from_q, double most,
                                  const Context& context) {
  std::vector<StartPath> starts;
  const SurfaceCells& cells = *ground.cells;
  ExponentialMap map(surface, kScout);
  for (const Index at : sharp_places(ground.bends->at(way))) {
    std::vector<Vector> points;
    try {
      points = aside(map, surface, way, at, kAside * cells.grid().size(), context);
    } catch (const SingularPoint&) {
      continue;
    }
    for (const Vector& x : points) {
      const double length = distance_at(surface, cells, from_p, x)(0) + distance_at(surface, cells, from_q, x)(0);
      if (!(length <= most)) continue;
      const Points there = descend_over(surface, cells, ground.map.get(), from_p, x);
      const Points back = descend_over(surface, cells, ground.map.get(), from_q, x);
      if (there.cols() < 2 || back.cols() < 2) continue;
      Points joined(3, there.cols() + back.cols() - 1);
      joined << there, back.leftCols(back.cols() - 1).rowwise().reverse();
      starts.push_back({length, std::move(joined)});
    }
  }
  return starts;
}

}  // namespace taut::detail
