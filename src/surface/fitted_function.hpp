#pragma once

#include "taut/surface/implicit_function.hpp"

namespace taut::detail {

/// A function that was fitted to samples, and knows how well.
class FittedFunction : public ImplicitFunction {
 public:
  /// Root mean square of |F| / |grad F| at the samples, model units.
  [[nodiscard]] virtual double residual_rms() const = 0;
};

}  // namespace taut::detail
