#pragma once

#include <cstddef>

#include "taut/surface/neural_network.hpp"

namespace taut::detail {

/// Points that a network is evaluated at together: one a lane.
inline constexpr std::size_t kNetworkLanes = 8;
/// Rows of a weight matrix are filled up with zeros to a multiple of this.
inline constexpr std::size_t kNetworkRows = 4;

/// out = weights in: `weights` rows x depth, row by row, rows a multiple of kNetworkRows; `in` depth x columns and
/// `out` rows x columns, row by row, columns a multiple of kNetworkLanes. Each entry is summed in the order of the
/// depth, so that a column has the same bits whatever stands beside it, on every instruction set.
void multiply_network(const double* weights, std::size_t rows, std::size_t depth, const double* in, double* out,
                      std::size_t columns);

/// s(z), s'(z) and s''(z) of `count` numbers, a multiple of kNetworkLanes. `steepness`: b of softplus; a sine's
/// frequency is in the weights.
void activate_network(Activation activation, double steepness, const double* z, std::size_t count, double* value,
                      double* slope, double* curvature);

}  // namespace taut::detail
