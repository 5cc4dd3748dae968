#pragma once

#include "surface/volume/lattice.hpp"
#include "taut/core/context.hpp"

namespace taut::detail {

/// Convolves `lattice` with a Gaussian of standard deviation `sigma` > 0, in entries, along each axis. Beyond the faces
/// the last entry is repeated.
void smooth_gaussian(Lattice& lattice, double sigma, const Context& context);

}  // namespace taut::detail
