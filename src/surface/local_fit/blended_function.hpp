#pragma once

#include <memory>

#include "taut/surface/fit.hpp"
#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// F of a LocalFitModel (d = 2 or 3): the patches' polynomials, blended. Keeps a copy of the patches, not the model.
[[nodiscard]] std::shared_ptr<const ImplicitFunction> make_blended_function(const LocalFitModel& model);

}  // namespace taut::detail
