#include "surface/network/network_kernel.hpp"

#include "surface/simd_dispatch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/network/network_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "surface/formula/lane_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {

/// kVectors side by side, kNetworkRows rows: few enough sums for the registers of every instruction set.
template <std::size_t kVectors>
HWY_INLINE void multiply_block(const double* HWY_RESTRICT weights, std::size_t depth, const double* HWY_RESTRICT in,
                               double* HWY_RESTRICT out, std::size_t columns) {
  const D d;
  const std::size_t lanes_of = hn::Lanes(d);
  V sum[kNetworkRows][kVectors];
  for (std::size_t r = 0; r < kNetworkRows; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v) sum[r][v] = hn::Zero(d);
  }
  for (std::size_t k = 0; k < depth; ++k) {
    V a[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) a[v] = hn::LoadU(d, in + k * columns + v * lanes_of);
    for (std::size_t r = 0; r < kNetworkRows; ++r) {
      const V w = hn::Set(d, weights[r * depth + k]);
      for (std::size_t v = 0; v < kVectors; ++v) sum[r][v] = hn::Add(sum[r][v], hn::Mul(w, a[v]));
    }
  }
  for (std::size_t r = 0; r < kNetworkRows; ++r) {
    for (std::size_t v = 0; v < kVectors; ++v) hn::StoreU(sum[r][v], d, out + r * columns + v * lanes_of);
  }
}

void network_multiply(const double* HWY_RESTRICT weights, std::size_t rows, std::size_t depth,
                      const double* HWY_RESTRICT in, double* HWY_RESTRICT out, std::size_t columns) {
  const std::size_t lanes_of = hn::Lanes(D());
  for (std::size_t column = 0; column < columns;) {
    const bool two = column + 2 * lanes_of <= columns;
    for (std::size_t row = 0; row < rows; row += kNetworkRows) {
      const double* const w = weights + row * depth;
      double* const to = out + row * columns + column;
      two ? multiply_block<2>(w, depth, in + column, to, columns)
          : multiply_block<1>(w, depth, in + column, to, columns);
    }
    column += (two ? 2 : 1) * lanes_of;
  }
}

void network_activate(int activation, double steepness, const double* HWY_RESTRICT z, std::size_t count,
                      double* HWY_RESTRICT value, double* HWY_RESTRICT slope, double* HWY_RESTRICT curvature) {
  const D d;
  const V one = lanes(1);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const V x = hn::LoadU(d, z + i);
    V s = x;
    V s1 = one;
    V s2 = hn::Zero(d);
    if (activation == static_cast<int>(Activation::sine)) {
      s = sin_lanes(x);
      s1 = cos_lanes(x);
      s2 = hn::Neg(s);
    } else if (activation == static_cast<int>(Activation::softplus)) {
      // e = exp(-b |x|): log(1 + exp(b x)) = max(b x, 0) + log(1 + e), and the logistic function is 1 / (1 + e) or
      // e / (1 + e).
      const V b = lanes(steepness);
      const V e = exp_lanes(hn::Neg(hn::Mul(b, hn::Abs(x))));
      const V whole = hn::Add(one, e);
      const M positive = hn::Ge(x, hn::Zero(d));
      const V ramp = hn::IfThenElseZero(hn::Not(hn::Lt(x, hn::Zero(d))), x);  // NaN stays
      s = hn::Add(ramp, hn::Div(log_lanes(whole), b));
      s1 = hn::Div(hn::IfThenElse(positive, one, e), whole);
      s2 = hn::Mul(b, hn::Div(e, hn::Mul(whole, whole)));
    } else {
      const V e = exp_lanes(hn::Mul(lanes(-2), hn::Abs(x)));
      s = hn::CopySign(hn::Div(hn::Sub(one, e), hn::Add(one, e)), x);
      s1 = hn::Sub(one, hn::Mul(s, s));
      s2 = hn::Mul(lanes(-2), hn::Mul(s, s1));
    }
    hn::StoreU(s, d, value + i);
    hn::StoreU(s1, d, slope + i);
    hn::StoreU(s2, d, curvature + i);
  }
}

}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace taut::detail {

void multiply_network(const double* weights, std::size_t rows, std::size_t depth, const double* in, double* out,
                      std::size_t columns) {
  TAUT_DISPATCH(network_multiply)(weights, rows, depth, in, out, columns);
}

void activate_network(Activation activation, double steepness, const double* z, std::size_t count, double* value,
                      double* slope, double* curvature) {
  TAUT_DISPATCH(network_activate)(static_cast<int>(activation), steepness, z, count, value, slope, curvature);
}

}  // namespace taut::detail
#endif
