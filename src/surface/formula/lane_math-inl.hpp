// Elementary functions on SIMD lanes, in double. Included once for each instruction set (see Highway's
// foreach_target.h), hence the unusual guard.
//
// Only +, -, *, /, sqrt, rounding and bit operations are used, never a fused multiply-add, so every instruction set
// gives the same bits. Measured errors against long double are below 1 ulp (tests/surface/test_formula_math.cpp holds
// them under kMaxUlp); interval bounds rely on that constant.

#if defined(TAUT_SURFACE_FORMULA_LANE_MATH_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TAUT_SURFACE_FORMULA_LANE_MATH_INL_HPP
#undef TAUT_SURFACE_FORMULA_LANE_MATH_INL_HPP
#else
#define TAUT_SURFACE_FORMULA_LANE_MATH_INL_HPP
#endif

#include <cmath>
#include <cstdint>
#include <limits>

#include "hwy/highway.h"
#include "surface/formula/scalar_math.hpp"

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

HWY_INLINE V lanes(double value) { return hn::Set(D(), value); }

/// A function without a vector version, lane by lane.
template <class F>
HWY_INLINE V each_lane(V x, const F& f) {
  HWY_ALIGN double buffer[HWY_MAX_BYTES / sizeof(double)];
  hn::Store(x, D(), buffer);
  for (std::size_t i = 0; i < hn::Lanes(D()); ++i) buffer[i] = f(buffer[i]);
  return hn::Load(D(), buffer);
}

template <class F>
HWY_INLINE V each_lane(V x, V y, const F& f) {
  HWY_ALIGN double first[HWY_MAX_BYTES / sizeof(double)];
  HWY_ALIGN double second[HWY_MAX_BYTES / sizeof(double)];
  hn::Store(x, D(), first);
  hn::Store(y, D(), second);
  for (std::size_t i = 0; i < hn::Lanes(D()); ++i) first[i] = f(first[i], second[i]);
  return hn::Load(D(), first);
}

/// c[0] + c[1] x + ... by Horner's rule, coefficients highest first.
HWY_INLINE V polynomial(V, double c0) { return lanes(c0); }
template <class... Rest>
HWY_INLINE V polynomial(V x, double c0, Rest... rest) {
  return hn::Add(lanes(c0), hn::Mul(x, polynomial(x, rest...)));
}

/// 2^k for integer-valued k in [-1022, 1023].
HWY_INLINE V power_of_two(V k) {
  // Adding 1.5 * 2^52 leaves k in the low bits of the significand; what is above them leaves with the shift.
  const V shifted = hn::Add(k, lanes(0x1.8p52 + 1023));
  return hn::BitCast(D(), hn::ShiftLeft<52>(hn::BitCast(DI(), shifted)));
}

/// e^x = 2^k e^r with k = round(x / log 2), |r| <= log(2) / 2; e^r by its Taylor polynomial of degree 13.
HWY_INLINE V exp_lanes(V x) {
  constexpr double kOverflow = 709.79;   // beyond: infinity
  constexpr double kUnderflow = -745.2;  // beyond: 0
  const V bounded = hn::Min(hn::Max(x, lanes(kUnderflow)), lanes(kOverflow));
  const V k = hn::Round(hn::Mul(bounded, lanes(0x1.71547652b82fep0)));
  // log 2 = high + low; high has 21 trailing zero bits, so k * high is exact.
  const V high = hn::Sub(bounded, hn::Mul(k, lanes(0x1.62e42fee00000p-1)));
  const V low = hn::Mul(k, lanes(0x1.a39ef35793c76p-33));
  const V r = hn::Sub(high, low);
  const V r_error = hn::Sub(hn::Sub(high, r), low);
  const V tail = polynomial(r, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880,
                            1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800);
  const V r2 = hn::Mul(r, r);
  // e^(r + r_error) - 1 - r = r^2 / 2 + r^3 tail + r_error (1 + r)
  const V rest =
      hn::Add(hn::Add(hn::Mul(r2, lanes(0.5)), hn::Mul(hn::Mul(r2, r), tail)), hn::Add(r_error, hn::Mul(r_error, r)));
  const V mantissa = hn::Add(lanes(1), hn::Add(r, rest));
  // In two steps, since k reaches 1024 and -1075.
  const V half = hn::Floor(hn::Mul(k, lanes(0.5)));
  const V result = hn::Mul(hn::Mul(mantissa, power_of_two(half)), power_of_two(hn::Sub(k, half)));
  return hn::IfThenElse(hn::IsNaN(x), x, result);
}

/// log x = k log 2 + log(1 + f), 1 + f in [sqrt(1/2), sqrt(2)); log(1 + f) = 2 atanh(s) with s = f / (2 + f).
HWY_INLINE V log_lanes(V x) {
  const D d;
  const DI di;
  const M tiny = hn::Lt(x, lanes(std::numeric_limits<double>::min()));
  const V scaled = hn::IfThenElse(tiny, hn::Mul(x, lanes(0x1p54)), x);
  const auto bits = hn::BitCast(di, scaled);
  // Subtracting the bits of sqrt(1/2) makes the exponent change where the significand passes it.
  const auto moved = hn::Sub(bits, hn::Set(di, 0x3fe6a09e667f3bcdLL));
  const auto k_int = hn::ShiftRight<52>(moved);
  const V m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<52>(k_int)));
  const V k_raw = hn::ConvertTo(d, k_int);
  const V k = hn::IfThenElse(tiny, hn::Sub(k_raw, lanes(54)), k_raw);
  const V f = hn::Sub(m, lanes(1));
  const V s = hn::Div(f, hn::Add(f, lanes(2)));
  const V s2 = hn::Mul(s, s);
  const V series = hn::Mul(s2, polynomial(s2, 2.0 / 3, 2.0 / 5, 2.0 / 7, 2.0 / 9, 2.0 / 11, 2.0 / 13, 2.0 / 15,
                                          2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23));
  // 2 atanh s = 2 s + s series, and 2 s = f - f^2/2 + s f^2/2: the leading f is exact.
  const V half_square = hn::Mul(lanes(0.5), hn::Mul(f, f));
  const V correction = hn::Add(hn::Mul(s, hn::Add(half_square, series)), hn::Mul(k, lanes(0x1.a39ef35793c76p-33)));
  V result = hn::Add(hn::Mul(k, lanes(0x1.62e42fee00000p-1)), hn::Sub(f, hn::Sub(half_square, correction)));
  const double infinity = std::numeric_limits<double>::infinity();
  result = hn::IfThenElse(hn::Eq(x, lanes(infinity)), x, result);
  result = hn::IfThenElse(hn::Eq(x, lanes(0)), lanes(-infinity), result);
  return hn::IfThenElse(hn::Ge(x, lanes(0)), result, lanes(std::numeric_limits<double>::quiet_NaN()));
}

/// An angle minus a multiple k of pi/2: high + low in [-pi/4, pi/4], and k.
struct ReducedAngle {
  V high;
  V low;
  V k;
};

/// Largest |angle| reduced with lanes; beyond, the C library answers lane by lane.
constexpr double kMaxReducedAngle = 0x1p19;

HWY_INLINE ReducedAngle reduce_angle(V x) {
  // pi/2 in four parts; the first three have 33 bits, so their products with k < 2^20 are exact.
  const V k = hn::Round(hn::Mul(x, lanes(0x1.45f306dc9c883p-1)));
  const V a = hn::Sub(x, hn::Mul(k, lanes(0x1.921fb54400000p0)));
  const V b = hn::Mul(k, lanes(0x1.0b4611a600000p-34));
  const V c = hn::Mul(k, lanes(0x1.3198a2e000000p-69));
  const V e = hn::Mul(k, lanes(0x1.b839a252049c1p-104));
  // a - b and then - c with their rounding errors (a may be far smaller than b: two-sum, not fast two-sum)
  const auto subtract = [](V p, V q, V& error) {
    const V r = hn::Sub(p, q);
    const V t = hn::Sub(r, p);
    error = hn::Sub(hn::Sub(p, hn::Sub(r, t)), hn::Add(q, t));
    return r;
  };
  V error_b;
  V error_c;
  const V r1 = subtract(a, b, error_b);
  const V r2 = subtract(r1, c, error_c);
  const V rest = hn::Add(error_b, hn::Sub(error_c, e));
  const V high = hn::Add(r2, rest);
  return {high, hn::Add(hn::Sub(r2, high), rest), k};
}

HWY_INLINE V sin_near_zero(V r, V low) {
  const V r2 = hn::Mul(r, r);
  const V tail = polynomial(r2, -1.0 / 6, 1.0 / 120, -1.0 / 5040, 1.0 / 362880, -1.0 / 39916800, 1.0 / 6227020800,
                            -1.0 / 1307674368000, 1.0 / 355687428096000);
  const V cosine = hn::Sub(lanes(1), hn::Mul(lanes(0.5), r2));
  return hn::Add(r, hn::Add(hn::Mul(hn::Mul(r2, r), tail), hn::Mul(low, cosine)));
}

HWY_INLINE V cos_near_zero(V r, V low) {
  const V r2 = hn::Mul(r, r);
  const V tail = polynomial(r2, 1.0 / 24, -1.0 / 720, 1.0 / 40320, -1.0 / 3628800, 1.0 / 479001600, -1.0 / 87178291200,
                            1.0 / 20922789888000, -1.0 / 6402373705728000);
  const V half = hn::Mul(lanes(0.5), r2);
  const V one_minus = hn::Sub(lanes(1), half);
  const V error = hn::Sub(hn::Sub(lanes(1), one_minus), half);
  return hn::Add(one_minus, hn::Add(error, hn::Sub(hn::Mul(hn::Mul(r2, r2), tail), hn::Mul(r, low))));
}

/// Bit `bit` of the integer k, as a mask.
template <int kBit>
HWY_INLINE M odd_quarter(V k) {
  const auto bits = hn::BitCast(DI(), hn::Add(k, lanes(0x1.8p52)));
  return hn::MaskFromVec(hn::BitCast(D(), hn::BroadcastSignBit(hn::ShiftLeft<63 - kBit>(bits))));
}

template <class F>
HWY_INLINE V large_angles(V x, V result, const F& f) {
  const M large = hn::Not(hn::Le(hn::Abs(x), lanes(kMaxReducedAngle)));  // or NaN
  if (HWY_LIKELY(hn::AllFalse(D(), large))) return result;
  return hn::IfThenElse(large, each_lane(x, f), result);
}

HWY_INLINE V sin_lanes(V x) {
  const ReducedAngle angle = reduce_angle(x);
  const V sine = sin_near_zero(angle.high, angle.low);
  const V cosine = cos_near_zero(angle.high, angle.low);
  const V value = hn::IfThenElse(odd_quarter<0>(angle.k), cosine, sine);
  const V result = hn::IfThenElse(odd_quarter<1>(angle.k), hn::Neg(value), value);
  return large_angles(x, result, [](double lane) { return std::sin(lane); });
}

HWY_INLINE V cos_lanes(V x) {
  const ReducedAngle angle = reduce_angle(x);
  const V sine = sin_near_zero(angle.high, angle.low);
  const V cosine = cos_near_zero(angle.high, angle.low);
  const V value = hn::IfThenElse(odd_quarter<0>(angle.k), sine, cosine);
  const V result = hn::IfThenElse(odd_quarter<1>(hn::Add(angle.k, lanes(1))), hn::Neg(value), value);
  return large_angles(x, result, [](double lane) { return std::cos(lane); });
}

HWY_INLINE V tan_lanes(V x) {
  const ReducedAngle angle = reduce_angle(x);
  const V sine = sin_near_zero(angle.high, angle.low);
  const V cosine = cos_near_zero(angle.high, angle.low);
  const M odd = odd_quarter<0>(angle.k);
  const V ratio = hn::Div(hn::IfThenElse(odd, cosine, sine), hn::IfThenElse(odd, sine, cosine));
  const V result = hn::IfThenElse(odd, hn::Neg(ratio), ratio);
  return large_angles(x, result, [](double lane) { return std::tan(lane); });
}

HWY_INLINE V odd_power_lanes(V a, std::uint32_t n) {
  V result = a;
  for (V square = hn::Mul(a, a); n >>= 1; square = hn::Mul(square, square)) {
    if (n & 1) result = hn::Mul(result, square);
  }
  return result;
}

/// NaN where either operand is, else `value`.
HWY_INLINE V nan_or(V a, V b, V value) {
  return hn::IfThenElse(hn::Or(hn::IsNaN(a), hn::IsNaN(b)), hn::Add(a, b), value);
}

HWY_INLINE V minimum_lanes(V a, V b) { return nan_or(a, b, hn::IfThenElse(hn::Le(a, b), a, b)); }
HWY_INLINE V maximum_lanes(V a, V b) { return nan_or(a, b, hn::IfThenElse(hn::Ge(a, b), a, b)); }

/// -1, 0, 1; NaN stays.
HWY_INLINE V sign_lanes(V a) {
  const V unit = hn::CopySign(lanes(1), a);
  return hn::IfThenElse(hn::Or(hn::Lt(a, lanes(0)), hn::Gt(a, lanes(0))), unit, a);
}

HWY_INLINE V power_lanes(V a, V b) { return each_lane(a, b, power_of); }

HWY_INLINE V atan2_lanes(V y, V x) {
  return each_lane(y, x, [](double sine, double cosine) { return std::atan2(sine, cosine); });
}

}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard, once for each target
