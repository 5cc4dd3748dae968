// Checks a geodesic that somebody else claims: the ray from its start in its direction over its length must end where
// they say. The miss along the ray is an error in length, the rest one in direction, times the amplification.
#include "taut/curve/exponential_map.hpp"

#include <string>

#include "taut/core/error.hpp"

namespace taut {

Verification verify_geodesic(const Surface& surface, const VectorIn& from, const VectorIn& direction, double length,
                             const VectorIn& to, const Context& context) {
  if (to.size() != surface.dim()) {
    throw InvalidArgument("the end has " + std::to_string(to.size()) + " coordinates, the surface lies in " +
                          std::to_string(surface.dim()) + " dimensions");
  }
  const ExponentialResult ray =
      exponential_map(surface, from, direction, length, {.conjugate = false, .points = false}, context);
  const Vector gap = to - ray.point;
  return {.status = ray.status,
          .miss = gap.norm(),
          .miss_along = gap.dot(ray.direction),
          .error = ray.error,
          .amplification = ray.amplification};
}

}  // namespace taut
