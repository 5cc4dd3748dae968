#include "query/no_way.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numbers>

namespace taut::detail {
namespace {

/// |grad F| at a barrier, of that at the ends, below which a singular point is taken to be near (codimension 1).
constexpr double kSingular = 0.05;
/// Radians.
constexpr double kLeastCrease = 0.5;

double gradient_share(const Surface& surface, const Barrier& barrier, const PathResult& result) {
  if (surface.codim() > 1) return 1;
  const auto gradient = [&](const Vector& x) { return surface.jacobian(x).norm(); };
  return gradient(barrier.point) / std::min(gradient(result.from), gradient(result.to));
}

}  // namespace

void explain_no_way(PathResult& result, const Surface& surface, const NoWay& no_way) {
  const std::optional<Barrier>& barrier = no_way.barrier;
  result.status = Status::not_converged;
  const bool crease = barrier && barrier->turn > kLeastCrease && barrier->turn < std::numbers::pi - kLeastCrease;
  if (barrier && gradient_share(surface, *barrier, result) < kSingular) {
    result.message = fmt::format(
        "the surface is singular between the two points: near ({:.4g}) its gradient falls to nothing; geodesics "
        "through a singular point are not supported",
        fmt::join(barrier->point, ", "));
  } else if (!no_way.walked) {
    result.message = fmt::format(
        "no path was found: cells down to {:.3g} cannot tell the sheets of the surface apart, or the points lie on "
        "different components",
        result.cell);
  } else if (!no_way.resolved) {
    result.message = fmt::format(
        "no path was found, neither on cells of {:.3g}, coarser than the surface bends, nor by walks from both ends; "
        "give a smaller box around both points, or smaller cells",
        result.cell);
  } else if (crease) {
    result.message = fmt::format(
        "the surface is not smooth between the two points: near ({:.4g}) its normal turns by {:.0f} degrees within a "
        "cell of {:.2g}; geodesics over a crease or through a singular point are not supported",
        fmt::join(barrier->point, ", "), barrier->turn * 180 / std::numbers::pi, result.cell);
  } else {
    result.status = Status::disconnected;
    result.message = fmt::format("no path was found on cells down to {:.3g}, nor by walks from both ends", result.cell);
  }
}

}  // namespace taut::detail
