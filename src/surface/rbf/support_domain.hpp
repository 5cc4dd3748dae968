#pragma once

#include <memory>

#include "taut/surface/implicit_function.hpp"
#include "taut/surface/rbf.hpp"

namespace taut::detail {

/// radius - (distance to the nearest sample of `model`): >= 0 where the surface has samples to speak for it. Its
/// gradient is a unit vector (zero at a sample), its bounds over a box are rigorous.
[[nodiscard]] std::shared_ptr<const ImplicitFunction> make_support_domain(std::shared_ptr<const RbfModel> model);

}  // namespace taut::detail
