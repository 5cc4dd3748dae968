#pragma once

#include "surface/volume/lattice.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// From values to the coefficients of the tricubic B-spline that interpolates them, in place. The values stand in
/// entries 1 .. size - 2 of `lattice` along each axis, at least 4 of them; the outermost layer is filled in.
void prefilter(Lattice& lattice, const Context& context);

}  // namespace taut::detail
