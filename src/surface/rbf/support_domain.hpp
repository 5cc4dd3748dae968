#pragma once

#include <memory>

#include "taut/surface/implicit_function.hpp"
#include "taut/surface/point_cloud.hpp"

namespace taut::detail {

/// Where the surface has samples to speak for it: g >= 0, C^3 next to where it vanishes. The border is as far from a
/// single sample as its `radius` (one for each, model units), and from the samples along a rim about as far. With
/// `flatness` f > 1 the part of x - sample_i along the sample's normal counts f times: samples need unit normals. Of
/// the order of a signed distance near the border; bounds over a box are rigorous. Far from all samples g jumps.
[[nodiscard]] std::shared_ptr<const ImplicitFunction> make_support_domain(std::shared_ptr<const PointCloud> samples,
                                                                          const Vector& radius, double flatness = 1);

}  // namespace taut::detail
