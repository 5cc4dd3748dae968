// Rays are as long as the ends lie apart, then twice as long, and so on until some lead to q: the shortest of those are
// near the shortest path, which bends no more along the surface than they do. Between neighbouring rays lies 2 pi /
// kRays.directions of their length, so that the walk that is left is short, and stays on the sheet of q.
#include "walk/ray_ways.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/linear_algebra.hpp"
#include "curve/polyline.hpp"
#include "surface/normal_angle.hpp"
#include "taut/curve/exponential_map.hpp"

#include "walk/surface_walker.hpp"

namespace taut::detail {
namespace {

/// On ellipsoids 1:1:0.005 and 1:1:0.001 and a rounded plate 1:1:0.01, ends on opposite sides, the best of 24
/// directions is within 1 % of the shortest path, in some 10 ms.
struct RayRules {
  int directions = 48;
  double first_length = 4;  ///< of the distance between the ends
  int most_doublings = 16;
  Index most_evaluated = 2'000'000;  ///< points of all rays together: some 0.3 s on a formula
  double tolerance = 1e-3;           ///< of the rays: they are starts
  double steps_per_gap = 16;         ///< of the walk from the nearest point
  double same_sheet = 0.75;          ///< squared sine of the normals' angle, at most
  std::size_t most = 4;              ///< ways
};
constexpr RayRules kRays;

struct Nearest {
  Index column = 0;
  double gap = std::numeric_limits<double>::infinity();
};

/// Where a ray comes nearest to q on q's sheet: the next sheet of a thin body faces the other way.
std::optional<Nearest> nearest_on_sheet(const Surface& surface, const Points& ray, const Foothold& q,
                                        SurfaceWalker& walker) {
  const Eigen::Map<const Eigen::MatrixXd> normals(q.normals.data(), surface.dim(), surface.codim());
  Nearest nearest;
  for (Index i = 0; i < ray.cols(); ++i) {
    const double gap = (ray.col(i) - q.point).norm();
    Foothold here;
    if (gap >= nearest.gap || !walker.stand(ray.col(i), walker.step(), here)) continue;
    const Eigen::Map<const Eigen::MatrixXd> there(here.normals.data(), surface.dim(), surface.codim());
    if (squared_sines(normals, there) <= kRays.same_sheet && same_orientation(normals, there)) nearest = {i, gap};
  }
  return std::isfinite(nearest.gap) ? std::optional(nearest) : std::nullopt;
}

/// The way along a ray to its nearest point, and from there to q.
Points way_along(const Surface& surface, const Points& ray, const Nearest& nearest, const Vector& q) {
  const Points along = ray.leftCols(nearest.column + 1);
  if (nearest.gap == 0) return along;
  SurfaceWalker walker(surface, nearest.gap / kRays.steps_per_gap);
  const Points rest = walker.walk(along.rightCols<1>(), q);
  Points way(q.size(), rest.cols() < 2 ? 0 : along.cols() + rest.cols() - 1);
  if (way.cols() > 0) way << along, rest.rightCols(rest.cols() - 1);
  return way;
}

}  // namespace

std::vector<Points> ways_by_rays(const Surface& surface, const Vector& p, const Vector& q, const Context& context) {
  if (surface.dim() - surface.codim() != 2) return {};
  const double apart = (q - p).norm();
  SurfaceWalker walker(surface, apart / kRays.steps_per_gap);
  Foothold start, end;
  if (!walker.stand(p, walker.step(), start) || !walker.stand(q, walker.step(), end)) return {};
  const Eigen::Map<const Eigen::MatrixXd> normals(start.normals.data(), surface.dim(), surface.codim());
  const Eigen::MatrixXd tangents = orthogonal_complement(normals);
  ExponentialMap map(surface, {.tolerance = kRays.tolerance, .conjugate = false});
  std::vector<Points> ways;
  Index evaluated = 0;
  for (int doublings = 0; doublings <= kRays.most_doublings; ++doublings) {
    if (!ways.empty() || evaluated > kRays.most_evaluated) break;
    const double length = std::ldexp(kRays.first_length * apart, doublings);
    for (int i = 0; i < kRays.directions; ++i) {
      context.check_cancelled();
      const double angle = 2 * std::numbers::pi * i / kRays.directions;
      const ExponentialResult ray =
          map.trace(p, tangents * Eigen::Vector2d(std::cos(angle), std::sin(angle)), length, context);
      evaluated += ray.num_evaluated;
      const std::optional<Nearest> nearest = nearest_on_sheet(surface, ray.points, end, walker);
      if (!nearest) continue;
      Points way = way_along(surface, ray.points, *nearest, q);
      if (way.cols() >= 2) ways.push_back(std::move(way));
    }
  }
  std::ranges::sort(ways, {}, [](const Points& way) { return polyline_length(way); });
  if (ways.size() > kRays.most) ways.resize(kRays.most);
  return ways;
}

}  // namespace taut::detail
