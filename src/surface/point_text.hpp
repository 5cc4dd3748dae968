#pragma once

#include <string>

#include "taut/core/types.hpp"
#include "taut/surface/surface.hpp"

namespace taut::detail {

/// "1,0,0.5": a point as the command line takes it.
[[nodiscard]] std::string text_of(const VectorIn& x);
/// "[0, 2] x [-1, 1]"
[[nodiscard]] std::string text_of(const Box& box);

/// Throws InvalidArgument unless x has the surface's dimension and is finite.
void check_point(const Surface& surface, const VectorIn& x, const char* name);

}  // namespace taut::detail
