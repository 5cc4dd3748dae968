#pragma once

#include <memory>

#include "taut/surface/implicit_function.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// Where the surface has samples to speak for it: the largest of radius_i - |x - sample_i| over the samples nearest to
/// x, >= 0 inside. `radius`: one for each sample, model units. Its gradient is a unit vector (zero at a sample); the
/// upper bounds over a box are rigorous, the lower ones, too. Continuous where the radii change by less than the
/// samples are apart.
[[nodiscard]] std::shared_ptr<const ImplicitFunction> make_support_domain(std::shared_ptr<const PointCloud> samples,
                                                                          Vector radius);

}  // namespace taut::detail
