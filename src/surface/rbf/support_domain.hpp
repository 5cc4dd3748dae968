#pragma once

#include <memory>

#include "taut/surface/implicit_function.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// Where the surface has samples to speak for it: the largest of radius_i - |x - sample_i| over the samples nearest to
/// x, >= 0 inside. `radius`: one for each sample, model units. With `flatness` f > 1 the part of x - sample_i along the
/// sample's normal counts f times: samples need unit normals. The gradient's length is 1 to f (zero at a sample); the
/// bounds over a box are rigorous. Continuous where the radii change by less than the samples are apart.
[[nodiscard]] std::shared_ptr<const ImplicitFunction> make_support_domain(std::shared_ptr<const PointCloud> samples,
                                                                          Vector radius, double flatness = 1);

}  // namespace taut::detail
