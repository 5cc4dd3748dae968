#pragma once

#include "surface/volume/lattice.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// From values to the coefficients of the tricubic B-spline that interpolates them, in place. The values stand in
/// entries 1 .. size - 2 of `lattice` along each axis, at least 4 of them; the outermost layer is filled in.
void prefilter(Lattice& lattice, const Context& context);

/// The same along lines side by side, in one dimension: entry i of line w at lines[i * kBundle + w], the values in
/// entries 1 .. n of n + 2, n >= 4.
void interpolate_lines(double* lines, Index n);

}  // namespace taut::detail
