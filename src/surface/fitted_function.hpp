#pragma once

#include <string>

#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// A function that was fitted to samples, and knows how well.
class FittedFunction : public ImplicitFunction {
 public:
  /// Root mean square of |F| / |grad F| at the samples, model units.
  [[nodiscard]] virtual double residual_rms() const = 0;
  /// Why the fitted surface may not be the sampled one, in one sentence; empty = nothing is known against it.
  [[nodiscard]] virtual std::string doubt() const = 0;
};

}  // namespace taut::detail
