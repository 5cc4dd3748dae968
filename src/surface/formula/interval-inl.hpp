// Interval arithmetic on SIMD lanes. Included once for each instruction set, hence the unusual guard.
//
// Every result is computed with rounding to nearest and then widened outwards: by more than the half ulp that one IEEE
// operation errs, by kMaxUlp for elementary functions. So an interval holds the exact values and, since rounding is
// monotone, also the values that the point kernel computes.
//
// Invariants: lower < +infinity and upper > -infinity, neither is NaN; lanes of `undefined` have all bits set where the
// expression has no value anywhere in the box (the square root of a negative interval), and the bounds then mean
// nothing.

#if defined(TAUT_SURFACE_FORMULA_INTERVAL_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef TAUT_SURFACE_FORMULA_INTERVAL_INL_HPP
#undef TAUT_SURFACE_FORMULA_INTERVAL_INL_HPP
#else
#define TAUT_SURFACE_FORMULA_INTERVAL_INL_HPP
#endif

#include <limits>
#include <numbers>

#include "surface/formula/kernels.hpp"
#include "surface/formula/lane_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {

struct Interval {
  V lower;
  V upper;
  V undefined;
};

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();  // at least 1 ulp, relative
constexpr double kTiny = std::numeric_limits<double>::min();         // absorbs underflow
constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

HWY_INLINE V down(V x, double relative = kEpsilon) {
  const V bounded = hn::Min(x, lanes(kMax));
  return hn::Sub(bounded, hn::Add(hn::Mul(hn::Abs(bounded), lanes(relative)), lanes(kTiny)));
}
HWY_INLINE V up(V x, double relative = kEpsilon) {
  const V bounded = hn::Max(x, lanes(-kMax));
  return hn::Add(bounded, hn::Add(hn::Mul(hn::Abs(bounded), lanes(relative)), lanes(kTiny)));
}
HWY_INLINE V down_function(V x) { return down(x, kMaxUlp * kEpsilon); }
HWY_INLINE V up_function(V x) { return up(x, kMaxUlp * kEpsilon); }

HWY_INLINE V bits(M mask) { return hn::VecFromMask(D(), mask); }
HWY_INLINE V either(V a, V b) { return hn::Or(a, b); }

/// A constant; NaN, as in derivatives where a function has none, has no value and bounds nothing.
HWY_INLINE Interval point(double c) {
  if (c != c) return {lanes(-kInfinity), lanes(kInfinity), bits(hn::Eq(lanes(0), lanes(0)))};
  return {lanes(c), lanes(c), lanes(0)};
}

/// A box as given: NaN bounds nothing.
HWY_INLINE Interval from_box(Interval x) {
  const V lower = hn::IfThenElse(hn::IsNaN(x.lower), lanes(-kInfinity), x.lower);
  const V upper = hn::IfThenElse(hn::IsNaN(x.upper), lanes(kInfinity), x.upper);
  return {hn::Min(lower, lanes(kMax)), hn::Max(upper, lanes(-kMax)), x.undefined};
}

HWY_INLINE Interval negate(const Interval& a) { return {hn::Neg(a.upper), hn::Neg(a.lower), a.undefined}; }

HWY_INLINE Interval absolute(const Interval& a) {
  // max(lower, -upper, 0) is the distance of the interval from 0
  const V nearest = hn::Max(hn::Max(a.lower, hn::Neg(a.upper)), lanes(0));
  return {nearest, hn::Max(hn::Neg(a.lower), a.upper), a.undefined};
}

HWY_INLINE Interval sign(const Interval& a) { return {sign_lanes(a.lower), sign_lanes(a.upper), a.undefined}; }

HWY_INLINE Interval square(const Interval& a) {
  const Interval size = absolute(a);
  return {hn::Max(down(hn::Mul(size.lower, size.lower)), lanes(0)), up(hn::Mul(size.upper, size.upper)), a.undefined};
}

HWY_INLINE Interval odd_power(const Interval& a, std::uint32_t n) {
  // n - 1 roundings of half an ulp each
  const double relative = n * kEpsilon;
  return {down(odd_power_lanes(a.lower, n), relative), up(odd_power_lanes(a.upper, n), relative), a.undefined};
}

HWY_INLINE Interval add(const Interval& a, const Interval& b) {
  return {down(hn::Add(a.lower, b.lower)), up(hn::Add(a.upper, b.upper)), either(a.undefined, b.undefined)};
}

HWY_INLINE Interval minimum(const Interval& a, const Interval& b) {
  return {hn::Min(a.lower, b.lower), hn::Min(a.upper, b.upper), either(a.undefined, b.undefined)};
}
HWY_INLINE Interval maximum(const Interval& a, const Interval& b) {
  return {hn::Max(a.lower, b.lower), hn::Max(a.upper, b.upper), either(a.undefined, b.undefined)};
}

/// Truth of a <= b all over the box: [1, 1] everywhere, [0, 0] nowhere, else [0, 1].
HWY_INLINE Interval less_equal(const Interval& a, const Interval& b) {
  const V one = lanes(1);
  return {hn::IfThenElseZero(hn::Le(a.upper, b.lower), one), hn::IfThenZeroElse(hn::Gt(a.lower, b.upper), one),
          either(a.undefined, b.undefined)};
}

/// Both branches where either may be taken.
HWY_INLINE Interval choose(const Interval& truth, const Interval& if_true, const Interval& if_false) {
  const M always = hn::Gt(truth.lower, lanes(0));
  const M never = hn::Lt(truth.upper, lanes(1));
  const auto pick = [&](V yes, V no, V both) { return hn::IfThenElse(always, yes, hn::IfThenElse(never, no, both)); };
  return {pick(if_true.lower, if_false.lower, hn::Min(if_true.lower, if_false.lower)),
          pick(if_true.upper, if_false.upper, hn::Max(if_true.upper, if_false.upper)),
          either(truth.undefined,
                 pick(if_true.undefined, if_false.undefined, hn::And(if_true.undefined, if_false.undefined)))};
}

/// A product of bounds, where an infinite one is only a bound: 0 * infinity = 0.
HWY_INLINE V bound_product(V a, V b) {
  const V product = hn::Mul(a, b);
  return hn::IfThenZeroElse(hn::IsNaN(product), product);
}

HWY_INLINE Interval multiply(const Interval& a, const Interval& b) {
  const V ll = bound_product(a.lower, b.lower);
  const V lu = bound_product(a.lower, b.upper);
  const V ul = bound_product(a.upper, b.lower);
  const V uu = bound_product(a.upper, b.upper);
  return {down(hn::Min(hn::Min(ll, lu), hn::Min(ul, uu))), up(hn::Max(hn::Max(ll, lu), hn::Max(ul, uu))),
          either(a.undefined, b.undefined)};
}

HWY_INLINE Interval scale(const Interval& a, double c) {
  const V factor = lanes(c);
  const V lower = bound_product(c < 0 ? a.upper : a.lower, factor);
  const V upper = bound_product(c < 0 ? a.lower : a.upper, factor);
  return {down(lower), up(upper), a.undefined};
}

HWY_INLINE Interval divide(const Interval& a, const Interval& b) {
  const M holds_zero = hn::And(hn::Le(b.lower, lanes(0)), hn::Ge(b.upper, lanes(0)));
  // infinity / infinity: a finite numerator over it tends to 0, covered by the other quotients or the whole line
  const auto quotient = [](V p, V q) {
    const V result = hn::Div(p, q);
    return hn::IfThenZeroElse(hn::IsNaN(result), result);
  };
  const V ll = quotient(a.lower, b.lower);
  const V lu = quotient(a.lower, b.upper);
  const V ul = quotient(a.upper, b.lower);
  const V uu = quotient(a.upper, b.upper);
  const V lower = down(hn::Min(hn::Min(ll, lu), hn::Min(ul, uu)));
  const V upper = up(hn::Max(hn::Max(ll, lu), hn::Max(ul, uu)));
  return {hn::IfThenElse(holds_zero, lanes(-kInfinity), lower), hn::IfThenElse(holds_zero, lanes(kInfinity), upper),
          either(a.undefined, b.undefined)};
}

HWY_INLINE Interval square_root(const Interval& a) {
  const V lower = hn::Sqrt(hn::Max(a.lower, lanes(0)));
  const V upper = hn::Sqrt(hn::Max(a.upper, lanes(0)));
  return {hn::Max(down(lower), lanes(0)), up(upper), either(a.undefined, bits(hn::Lt(a.upper, lanes(0))))};
}

/// A non-decreasing function of the C library.
template <class F>
HWY_INLINE Interval increasing(const Interval& a, const F& f) {
  return {down_function(each_lane(a.lower, f)), up_function(each_lane(a.upper, f)), a.undefined};
}

HWY_INLINE Interval exponential(const Interval& a) {
  return {hn::Max(down_function(exp_lanes(a.lower)), lanes(0)), up_function(exp_lanes(a.upper)), a.undefined};
}

HWY_INLINE Interval logarithm(const Interval& a) {
  const V lower = log_lanes(hn::Max(a.lower, lanes(0)));
  const V upper = log_lanes(hn::Max(a.upper, lanes(0)));
  return {down_function(lower), up_function(upper), either(a.undefined, bits(hn::Lt(a.upper, lanes(0))))};
}

/// Sine (peak = 1/4) or cosine (peak = 0): `peak` is where the maximum lies, in turns. x / (2 pi) - peak is an integer
/// at a maximum, an integer and a half at a minimum.
HWY_INLINE Interval sine(const Interval& a, double peak) {
  constexpr double kLargestAngle = 1e8;  // beyond, the period is not resolved well enough: [-1, 1]
  const bool is_sine = peak != 0;
  const V per_turn = lanes(0.5 * std::numbers::inv_pi);
  const V first = hn::Sub(hn::Mul(a.lower, per_turn), lanes(peak));
  const V last = hn::Sub(hn::Mul(a.upper, per_turn), lanes(peak));
  // A turn is known to a few ulp of its size; near an extreme, assume it is inside.
  const V slack = hn::Mul(lanes(8 * kEpsilon), hn::Add(lanes(1), hn::Max(hn::Abs(first), hn::Abs(last))));
  const V from = hn::Sub(first, slack);
  const V to = hn::Add(last, slack);
  const V half = lanes(0.5);
  const M far =
      hn::Not(hn::And(hn::Le(hn::Abs(a.lower), lanes(kLargestAngle)), hn::Le(hn::Abs(a.upper), lanes(kLargestAngle))));
  const M has_maximum = hn::Or(far, hn::Ge(hn::Floor(to), from));
  const M has_minimum = hn::Or(far, hn::Ge(hn::Add(hn::Floor(hn::Sub(to, half)), half), from));
  const V bounded_lower = hn::IfThenZeroElse(far, a.lower);
  const V bounded_upper = hn::IfThenZeroElse(far, a.upper);
  const V at_lower = is_sine ? sin_lanes(bounded_lower) : cos_lanes(bounded_lower);
  const V at_upper = is_sine ? sin_lanes(bounded_upper) : cos_lanes(bounded_upper);
  const V lower = hn::Max(down_function(hn::Min(at_lower, at_upper)), lanes(-1));
  const V upper = hn::Min(up_function(hn::Max(at_lower, at_upper)), lanes(1));
  return {hn::IfThenElse(has_minimum, lanes(-1), lower), hn::IfThenElse(has_maximum, lanes(1), upper), a.undefined};
}

HWY_INLINE Interval tangent(const Interval& a) {
  constexpr double kLargestAngle = 1e8;
  const V per_half_turn = lanes(std::numbers::inv_pi);
  const V first = hn::Sub(hn::Mul(a.lower, per_half_turn), lanes(0.5));
  const V last = hn::Sub(hn::Mul(a.upper, per_half_turn), lanes(0.5));
  const V slack = hn::Mul(lanes(8 * kEpsilon), hn::Add(lanes(1), hn::Max(hn::Abs(first), hn::Abs(last))));
  const M far =
      hn::Not(hn::And(hn::Le(hn::Abs(a.lower), lanes(kLargestAngle)), hn::Le(hn::Abs(a.upper), lanes(kLargestAngle))));
  const M pole = hn::Or(far, hn::Ge(hn::Floor(hn::Add(last, slack)), hn::Sub(first, slack)));
  const V lower = down_function(tan_lanes(hn::IfThenZeroElse(pole, a.lower)));
  const V upper = up_function(tan_lanes(hn::IfThenZeroElse(pole, a.upper)));
  return {hn::IfThenElse(pole, lanes(-kInfinity), lower), hn::IfThenElse(pole, lanes(kInfinity), upper), a.undefined};
}

HWY_INLINE V into_unit(V x) { return hn::Min(hn::Max(x, lanes(-1)), lanes(1)); }
HWY_INLINE V outside_unit(const Interval& a) {
  return either(a.undefined, bits(hn::Or(hn::Gt(a.lower, lanes(1)), hn::Lt(a.upper, lanes(-1)))));
}

HWY_INLINE Interval arcsine(const Interval& a) {
  const auto f = [](double x) { return std::asin(x); };
  return {down_function(each_lane(into_unit(a.lower), f)), up_function(each_lane(into_unit(a.upper), f)),
          outside_unit(a)};
}

HWY_INLINE Interval arccosine(const Interval& a) {
  const auto f = [](double x) { return std::acos(x); };
  return {down_function(each_lane(into_unit(a.upper), f)), up_function(each_lane(into_unit(a.lower), f)),
          outside_unit(a)};
}

HWY_INLINE Interval hyperbolic_cosine(const Interval& a) {
  return increasing(absolute(a), [](double x) { return std::cosh(x); });
}

/// Bounds over four corners, lane by lane; `f` must be monotone in each operand over the box.
template <class F>
HWY_INLINE Interval corners(const Interval& a, const Interval& b, const F& f) {
  const V ll = each_lane(a.lower, b.lower, f);
  const V lu = each_lane(a.lower, b.upper, f);
  const V ul = each_lane(a.upper, b.lower, f);
  const V uu = each_lane(a.upper, b.upper, f);
  return {down_function(hn::Min(hn::Min(ll, lu), hn::Min(ul, uu))),
          up_function(hn::Max(hn::Max(ll, lu), hn::Max(ul, uu))), either(a.undefined, b.undefined)};
}

/// a^b. For a >= 0 monotone in each operand; a negative base has a value only for integer exponents, which are told
/// apart only when the exponent is one number.
HWY_INLINE Interval power(const Interval& a, const Interval& b) {
  const V zero = lanes(0);
  const M fixed = hn::Eq(b.lower, b.upper);
  const M whole = hn::And(fixed, hn::Eq(b.lower, hn::Floor(b.lower)));
  const M fraction = hn::AndNot(whole, fixed);
  const M below = hn::Lt(a.lower, zero);
  // A fractional exponent sees the part of the base that is not negative.
  const Interval base{hn::IfThenElse(below, zero, a.lower), hn::Max(a.upper, zero), a.undefined};
  Interval result = corners(base, b, power_of);
  const M unknown = hn::And(below, hn::Not(fraction));
  result.lower = hn::IfThenElse(unknown, lanes(-kInfinity), result.lower);
  result.upper = hn::IfThenElse(unknown, lanes(kInfinity), result.upper);
  result.undefined = either(result.undefined, bits(hn::And(fraction, hn::Lt(a.upper, zero))));
  return result;
}

/// The angle of (x, y): monotone along every line while the box meets neither the origin nor the cut x < 0, y = 0.
HWY_INLINE Interval arctangent2(const Interval& y, const Interval& x) {
  const V zero = lanes(0);
  const M cut = hn::And(hn::Le(x.lower, zero), hn::And(hn::Le(y.lower, zero), hn::Ge(y.upper, zero)));
  Interval result = corners(y, x, [](double sine, double cosine) { return std::atan2(sine, cosine); });
  const double pi_above = std::numbers::pi * (1 + 2 * kEpsilon);
  result.lower = hn::IfThenElse(cut, lanes(-pi_above), result.lower);
  result.upper = hn::IfThenElse(cut, lanes(pi_above), result.upper);
  return result;
}

}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // guard, once for each target
