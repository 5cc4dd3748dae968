#pragma once

#include <memory>

#include "taut/curve/exponential_map.hpp"

namespace taut {

class ExponentialMap::Backend {
 public:
  virtual ~Backend() = default;
  /// `from` lies on the surface, `direction` is finite; the rest as in ExponentialMap::trace.
  virtual ExponentialResult trace(const Vector& from, const Vector& direction, double length,
                                  const Context& context) = 0;
};

namespace detail {

/// A tracer for surfaces in D dimensions (then of one equation), or in any (Eigen::Dynamic).
template <int D>
std::unique_ptr<ExponentialMap::Backend> make_ray_tracer(const Surface& surface, const ExponentialOptions& options);

}  // namespace detail
}  // namespace taut
