// Weights and cubics of several patches at one point, a patch a lane: most of the time of rays and corrections over a
// fit goes here.
//
// With u = (x - c) / R, s = |u|^2 and p the patch's cubic, w = (1 - s)^4 and f = R p(u):
//   w_a = -8 (1 - s)^3 u_a / R,   w_ab = 48 (1 - s)^2 u_a u_b / R^2 - 8 (1 - s)^3 delta_ab / R^2,
//   f_a = p_a,   f_ab = p_ab / R.

#include "surface/local_fit/blend_kernel.hpp"

#include "surface/simd_dispatch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/local_fit/blend_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<double, kBlendLanes>;
using V = hn::Vec<Lanes>;

HWY_INLINE V plus(V a, V b) { return hn::Add(a, b); }
HWY_INLINE V times(V a, V b) { return hn::Mul(a, b); }
HWY_INLINE V times(double a, V b) { return hn::Mul(hn::Set(Lanes(), a), b); }

/// In pairs, so that no order of adding depends on how many lanes a vector has.
HWY_INLINE double fold(const double* a) { return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7])); }

/// What every lane gives of the numbers that are summed.
template <int D>
struct Terms {
  static constexpr std::size_t kDim = D;
  static constexpr std::size_t kPairs = Cubic<D>::kPairs;
  static constexpr std::size_t kJet = 1 + kDim + kPairs;
  HWY_ALIGN double weight[kJet][kBlendLanes];
  HWY_ALIGN double product[kJet][kBlendLanes];
};

template <int D, bool kDerivatives>
HWY_INLINE void add(const PatchLanes<D>& lanes, std::size_t count, const double* HWY_RESTRICT x, BlendSums<D>& sums) {
  using P = Cubic<D>;
  constexpr std::size_t kDim = D;
  constexpr std::size_t kPairs = P::kPairs;
  constexpr auto& layout = P::kLayout;
  const Lanes d;
  Terms<D> terms;
  for (std::size_t lane = 0; lane < kBlendLanes; lane += hn::Lanes(d)) {
    const auto used = hn::FirstN(d, count > lane ? count - lane : 0);
    const auto row = [&](std::size_t r) HWY_ATTR { return hn::MaskedLoad(used, d, lanes.row[r].data() + lane); };
    const auto coefficient = [&](std::size_t c) HWY_ATTR { return row(kDim + 1 + c); };
    const V radius = hn::IfThenElse(used, row(kDim), hn::Set(d, 1.0));
    const V per_radius = hn::Div(hn::Set(d, 1.0), radius);
    V u[kDim];
    V s = hn::Zero(d);
    for (std::size_t a = 0; a < kDim; ++a) {
      u[a] = times(hn::Sub(hn::Set(d, x[a]), row(a)), per_radius);
      s = plus(s, times(u[a], u[a]));
    }
    const V rest = hn::IfThenElseZero(used, hn::Max(hn::Sub(hn::Set(d, 1.0), s), hn::Zero(d)));
    const V rest2 = times(rest, rest);
    const V w = times(rest2, rest2);
    // T(u, ., .), then p, its gradient and its Hessian as in Cubic.
    V third[kPairs];
    for (std::size_t i = 0; i < kDim; ++i) {
      for (std::size_t j = i; j < kDim; ++j) {
        V sum = times(coefficient(P::kCubic + layout.triple[i][j][0]), u[0]);
        for (std::size_t k = 1; k < kDim; ++k) {
          sum = plus(sum, times(coefficient(P::kCubic + layout.triple[i][j][k]), u[k]));
        }
        third[layout.pair[i][j]] = sum;
      }
    }
    V p = coefficient(0);
    V gradient[kDim];
    for (std::size_t i = 0; i < kDim; ++i) {
      V of_value = hn::Zero(d);
      V of_slope = hn::Zero(d);
      for (std::size_t j = 0; j < kDim; ++j) {
        const std::size_t ij = layout.pair[i][j];
        const V second = coefficient(P::kQuadratic + ij);
        of_value = plus(of_value, times(plus(second, times(1.0 / 3, third[ij])), u[j]));
        if (kDerivatives) of_slope = plus(of_slope, times(plus(second, times(0.5, third[ij])), u[j]));
      }
      p = plus(p, times(u[i], plus(coefficient(P::kLinear + i), times(0.5, of_value))));
      if (kDerivatives) gradient[i] = plus(coefficient(P::kLinear + i), of_slope);
    }
    const V f = times(radius, p);
    std::size_t at = 0;
    const auto put = [&](V weight, V product) HWY_ATTR {
      hn::Store(weight, d, terms.weight[at] + lane);
      hn::Store(product, d, terms.product[at] + lane);
      ++at;
    };
    put(w, times(w, f));
    if (!kDerivatives) continue;
    const V slope = times(-8, times(times(rest2, rest), per_radius));
    const V bend = times(48, times(rest2, times(per_radius, per_radius)));
    V w_a[kDim];
    for (std::size_t a = 0; a < kDim; ++a) {
      w_a[a] = times(slope, u[a]);
      put(w_a[a], plus(times(w_a[a], f), times(w, gradient[a])));
    }
    for (std::size_t a = 0; a < kDim; ++a) {
      for (std::size_t b = a; b < kDim; ++b) {
        const std::size_t ab = layout.pair[a][b];
        V w_ab = times(bend, times(u[a], u[b]));
        if (a == b) w_ab = plus(w_ab, times(slope, per_radius));
        const V hessian = times(plus(coefficient(P::kQuadratic + ab), third[ab]), per_radius);
        const V mixed = plus(times(w_a[a], gradient[b]), times(w_a[b], gradient[a]));
        put(w_ab, plus(plus(times(w_ab, f), mixed), times(w, hessian)));
      }
    }
  }
  sums.weight.value += fold(terms.weight[0]);
  sums.product.value += fold(terms.product[0]);
  if (!kDerivatives) return;
  for (std::size_t a = 0; a < kDim; ++a) {
    sums.weight.gradient[a] += fold(terms.weight[1 + a]);
    sums.product.gradient[a] += fold(terms.product[1 + a]);
  }
  for (std::size_t ab = 0; ab < kPairs; ++ab) {
    sums.weight.hessian[ab] += fold(terms.weight[1 + kDim + ab]);
    sums.product.hessian[ab] += fold(terms.product[1 + kDim + ab]);
  }
}

}  // namespace

void add_in_plane(const PatchLanes<2>& lanes, std::size_t count, const double* x, bool derivatives,
                  BlendSums<2>& sums) {
  derivatives ? add<2, true>(lanes, count, x, sums) : add<2, false>(lanes, count, x, sums);
}

void add_in_space(const PatchLanes<3>& lanes, std::size_t count, const double* x, bool derivatives,
                  BlendSums<3>& sums) {
  derivatives ? add<3, true>(lanes, count, x, sums) : add<3, false>(lanes, count, x, sums);
}

}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace taut::detail {

template <>
void add_patches(const PatchLanes<2>& lanes, std::size_t count, const double* x, bool derivatives, BlendSums<2>& sums) {
  TAUT_DISPATCH(add_in_plane)(lanes, count, x, derivatives, sums);
}

template <>
void add_patches(const PatchLanes<3>& lanes, std::size_t count, const double* x, bool derivatives, BlendSums<3>& sums) {
  TAUT_DISPATCH(add_in_space)(lanes, count, x, derivatives, sums);
}

}  // namespace taut::detail
#endif
