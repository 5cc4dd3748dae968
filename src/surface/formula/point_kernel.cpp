#include <utility>

#include "surface/formula/kernels.hpp"
#include "surface/simd_dispatch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/formula/point_kernel.cpp"
#include "hwy/foreach_target.h"
// foreach_target first
#include "surface/formula/lane_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {
namespace {

/// The slots of one block.
struct Block {
  double* slots;
  std::size_t size;  // lanes, a multiple of the vector length

  [[nodiscard]] double* operator[](std::uint32_t slot) const { return slots + slot * size; }
};

/// body(i) for each vector of a block, i its first lane: four a turn, for blocks are short.
template <class Body>
HWY_INLINE void for_vectors(const Block& block, const Body& body) {
  const std::size_t step = hn::Lanes(D());
  std::size_t i = 0;
  for (; i + 4 * step <= block.size; i += 4 * step) {
    body(i);
    body(i + step);
    body(i + 2 * step);
    body(i + 3 * step);
  }
  for (; i < block.size; i += step) body(i);
}

template <class F>
HWY_INLINE void map1(const Instruction& ins, const Block& block, const F& f) {
  const D d;
  const double* a = block[ins.a];
  double* result = block[ins.dst];
  for_vectors(block, [&](std::size_t i) { hn::Store(f(hn::Load(d, a + i)), d, result + i); });
}

template <class F>
HWY_INLINE void map2(const Instruction& ins, const Block& block, const F& f) {
  const D d;
  const double* a = block[ins.a];
  const double* b = block[ins.b];
  double* result = block[ins.dst];
  for_vectors(block, [&](std::size_t i) { hn::Store(f(hn::Load(d, a + i), hn::Load(d, b + i)), d, result + i); });
}

template <class F>
HWY_INLINE void map3(const Instruction& ins, const Block& block, const F& f) {
  const D d;
  const double* a = block[ins.a];
  const double* b = block[ins.b];
  const double* c = block[ins.c];
  double* result = block[ins.dst];
  for (std::size_t i = 0; i < block.size; i += hn::Lanes(d)) {
    hn::Store(f(hn::Load(d, a + i), hn::Load(d, b + i), hn::Load(d, c + i)), d, result + i);
  }
}

template <int kFirst, int kSecond>
void map_fused(const Instruction& ins, const Block& block) {
  constexpr auto first = static_cast<FirstOp>(kFirst);
  constexpr auto second = static_cast<SecondOp>(kSecond);
  constexpr bool reads_b = first == FirstOp::multiply || first == FirstOp::add || first == FirstOp::subtract;
  constexpr bool reads_c =
      second == SecondOp::add || second == SecondOp::multiply || second == SecondOp::minus || second == SecondOp::from;
  const D d;
  const double* slot_a = block[ins.a];
  const double* slot_b = block[ins.b];
  const double* slot_c = block[ins.c];
  double* result = block[ins.dst];
  const V value = lanes(ins.value);
  const V value2 = lanes(ins.value2);
  for_vectors(block, [&](std::size_t i) {
    const V a = hn::Load(d, slot_a + i);
    const V b = reads_b ? hn::Load(d, slot_b + i) : value;
    const V c = reads_c ? hn::Load(d, slot_c + i) : value2;
    V t = a;
    if constexpr (first == FirstOp::multiply || first == FirstOp::multiply_c) t = hn::Mul(a, b);
    if constexpr (first == FirstOp::square) t = hn::Mul(a, a);
    if constexpr (first == FirstOp::add || first == FirstOp::add_c) t = hn::Add(a, b);
    if constexpr (first == FirstOp::subtract) t = hn::Sub(a, b);
    if constexpr (second == SecondOp::add || second == SecondOp::add_c) t = hn::Add(t, c);
    if constexpr (second == SecondOp::multiply || second == SecondOp::multiply_c) t = hn::Mul(t, c);
    if constexpr (second == SecondOp::minus) t = hn::Sub(t, c);
    if constexpr (second == SecondOp::from || second == SecondOp::from_c) t = hn::Sub(c, t);
    if constexpr (second == SecondOp::square) t = hn::Mul(t, t);
    hn::Store(t, d, result + i);
  });
}

using FusedKernel = void (*)(const Instruction&, const Block&);

/// Kernels by code, from Code::fused on.
struct FusedKernels {
  FusedKernel kernels[kNumFused];

  constexpr FusedKernels() : FusedKernels(std::make_integer_sequence<int, kNumFused>()) {}
  template <int... I>
  constexpr explicit FusedKernels(std::integer_sequence<int, I...>)
      : kernels{map_fused<I / kNumSecond, I % kNumSecond>...} {}
};

constexpr FusedKernels kFusedKernels;

/// Points [first, first + count) of an input array into a slot; the lanes left over repeat the last point.
HWY_INLINE void read_input(const double* entry, std::size_t stride, std::size_t count, double* slot, std::size_t size) {
  for (std::size_t j = 0; j < count; ++j) slot[j] = entry[j * stride];
  for (std::size_t j = count; j < size; ++j) slot[j] = slot[count - 1];
}

/// A vector of points of N coordinates each, taken apart into N slots.
template <std::uint32_t N>
HWY_INLINE void load_points(const double* from, double* const* slots, std::size_t i) {
  const D d;
  V a, b, c, e;
  if constexpr (N == 1) {
    hn::Store(hn::LoadU(d, from), d, slots[0] + i);
  } else if constexpr (N == 2) {
    hn::LoadInterleaved2(d, from, a, b);
  } else if constexpr (N == 3) {
    hn::LoadInterleaved3(d, from, a, b, c);
    hn::Store(c, d, slots[2] + i);
  } else {
    hn::LoadInterleaved4(d, from, a, b, c, e);
    hn::Store(c, d, slots[2] + i);
    hn::Store(e, d, slots[3] + i);
  }
  if constexpr (N > 1) {
    hn::Store(a, d, slots[0] + i);
    hn::Store(b, d, slots[1] + i);
  }
}

template <std::uint32_t N>
HWY_INLINE void read_rows(const double* from, std::size_t stride, std::size_t count, const std::uint32_t* rows,
                          const Block& block) {
  const D d;
  double* slots[N];
  for (std::uint32_t entry = 0; entry < N; ++entry) slots[entry] = block[rows[entry]];
  if (count == 1 || stride == 0) {  // one point for all lanes
    for (std::uint32_t entry = 0; entry < N; ++entry) {
      const V value = lanes(from[entry]);
      for (std::size_t i = 0; i < block.size; i += hn::Lanes(d)) hn::Store(value, d, slots[entry] + i);
    }
    return;
  }
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= count; i += hn::Lanes(d)) load_points<N>(from + i * N, slots, i);
  if (i == count) return;
  HWY_ALIGN double rest[N * HWY_MAX_BYTES / sizeof(double)];
  for (std::size_t j = 0; j < hn::Lanes(d); ++j) {
    const std::size_t point = i + j < count ? i + j : count - 1;
    for (std::uint32_t entry = 0; entry < N; ++entry) rest[j * N + entry] = from[point * N + entry];
  }
  load_points<N>(rest, slots, i);
}

#if HWY_TARGET <= HWY_AVX2  // AVX2 and AVX-512
constexpr hn::CappedTag<double, 4> kFour;
using Four = hn::Vec<hn::CappedTag<double, 4>>;

/// Four points of N entries each, N even: in square blocks that are transposed.
template <std::uint32_t N>
HWY_INLINE void write_four_even(double* HWY_RESTRICT out, const double* const* slots, std::size_t j) {
  const hn::CappedTag<double, 2> two;
  constexpr std::uint32_t kFours = N / 4 * 4;
  for (std::uint32_t e = 0; e < kFours; e += 4) {
    const Four a = hn::Load(kFour, slots[e] + j);
    const Four b = hn::Load(kFour, slots[e + 1] + j);
    const Four c = hn::Load(kFour, slots[e + 2] + j);
    const Four f = hn::Load(kFour, slots[e + 3] + j);
    const Four ab_even = hn::InterleaveLower(kFour, a, b);  // a0 b0 a2 b2
    const Four ab_odd = hn::InterleaveUpper(kFour, a, b);   // a1 b1 a3 b3
    const Four cf_even = hn::InterleaveLower(kFour, c, f);
    const Four cf_odd = hn::InterleaveUpper(kFour, c, f);
    hn::StoreU(hn::ConcatLowerLower(kFour, cf_even, ab_even), kFour, out + e);
    hn::StoreU(hn::ConcatLowerLower(kFour, cf_odd, ab_odd), kFour, out + N + e);
    hn::StoreU(hn::ConcatUpperUpper(kFour, cf_even, ab_even), kFour, out + 2 * N + e);
    hn::StoreU(hn::ConcatUpperUpper(kFour, cf_odd, ab_odd), kFour, out + 3 * N + e);
  }
  for (std::uint32_t half = 0; half < 4; half += 2) {
    for (std::uint32_t e = kFours; e < N; e += 2) {
      const auto a = hn::Load(two, slots[e] + j + half);
      const auto b = hn::Load(two, slots[e + 1] + j + half);
      hn::StoreU(hn::InterleaveLower(two, a, b), two, out + half * N + e);
      hn::StoreU(hn::InterleaveUpper(two, a, b), two, out + (half + 1) * N + e);
    }
  }
}

/// The same for N odd: two points are N pairs of entries, the one in the middle the last of one point and the first of
/// the next. Pairs of the first two points are the lower halves, of the other two the upper halves, and are stored one
/// after the other.
template <std::uint32_t N>
HWY_INLINE void write_four_odd(double* HWY_RESTRICT out, const double* const* slots, std::size_t j) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    const Four entry[N] = {hn::Load(kFour, slots[I] + j)...};
    const auto pair = [&]<std::size_t P>() {
      constexpr std::size_t kMiddle = N / 2;
      if constexpr (P < kMiddle) return hn::InterleaveLower(kFour, entry[2 * P], entry[2 * P + 1]);
      if constexpr (P == kMiddle) return hn::OddEven(entry[0], entry[N - 1]);
      if constexpr (P > kMiddle) return hn::InterleaveUpper(kFour, entry[2 * P - N], entry[2 * P - N + 1]);
    };
    const Four pairs[N] = {pair.template operator()<I>()...};
    const auto two_pairs = [&]<std::size_t P>() {  // P and P + 1 of 2 N
      if constexpr (P + 1 < N) return hn::ConcatLowerLower(kFour, pairs[P + 1], pairs[P]);
      if constexpr (P + 1 == N) return hn::ConcatUpperLower(kFour, pairs[0], pairs[N - 1]);
      if constexpr (P >= N) return hn::ConcatUpperUpper(kFour, pairs[P + 1 - N], pairs[P - N]);
    };
    (hn::StoreU(two_pairs.template operator()<2 * I>(), kFour, out + 4 * I), ...);
  }
  (std::make_index_sequence<N>());
}
#endif

/// N slots into the N entries of each point.
template <std::uint32_t N>
HWY_INLINE void write_rows(double* HWY_RESTRICT out, std::size_t count, const std::uint32_t* rows, const Block& block) {
  const D d;
  const double* slots[N];
  for (std::uint32_t entry = 0; entry < N; ++entry) slots[entry] = block[rows[entry]];
  std::size_t j = 0;
  if constexpr (N == 1) {
    for (; j + hn::Lanes(d) <= count; j += hn::Lanes(d)) hn::StoreU(hn::Load(d, slots[0] + j), d, out + j);
  } else if constexpr (N == 3) {
    for (; j + hn::Lanes(d) <= count; j += hn::Lanes(d)) {
      hn::StoreInterleaved3(hn::Load(d, slots[0] + j), hn::Load(d, slots[1] + j), hn::Load(d, slots[2] + j), d,
                            out + 3 * j);
    }
  } else {
#if HWY_TARGET <= HWY_AVX2
    for (; j + 4 <= count; j += 4) {
      if constexpr (N % 2 == 0) write_four_even<N>(out + j * N, slots, j);
      if constexpr (N % 2 != 0) write_four_odd<N>(out + j * N, slots, j);
    }
#endif
  }
  for (; j < count; ++j) {
    for (std::uint32_t entry = 0; entry < N; ++entry) out[j * N + entry] = slots[entry][j];
  }
}

/// Calls body<N>() for a run-time N in 1 .. kMax.
template <std::uint32_t kMax, class Body>
HWY_INLINE void with_size(std::uint32_t n, const Body& body) {
  [&]<std::uint32_t... I>(std::integer_sequence<std::uint32_t, I...>) {
    (void)((n == I + 1 ? (body.template operator()<I + 1>(), true) : false) || ...);
  }
  (std::make_integer_sequence<std::uint32_t, kMax>());
}

HWY_INLINE M as_mask(V v) { return hn::MaskFromVec(v); }

void run_block(const Tape& tape, const PointArrays& arrays, std::size_t first, std::size_t count, const Block& block) {
  const D d;
  for (const Instruction& ins : tape.instructions) {
    if (ins.code >= Code::fused) {  // most are
      kFusedKernels.kernels[static_cast<int>(ins.code) - static_cast<int>(Code::fused)](ins, block);
      continue;
    }
    switch (ins.code) {
      case Code::input: {
        const std::size_t stride = arrays.input_stride[ins.a];
        read_input(arrays.input[ins.a] + first * stride + ins.b, stride, count, block[ins.dst], block.size);
        break;
      }
      case Code::input_row: {
        const std::size_t stride = arrays.input_stride[ins.a];
        const double* from = arrays.input[ins.a] + first * stride;
        const std::uint32_t* rows = tape.row_slots.data() + ins.b;
        with_size<kMaxInputRow>(ins.c, [&]<std::uint32_t N>() { read_rows<N>(from, stride, count, rows, block); });
        break;
      }
      case Code::output_row: {
        if (arrays.output[ins.c] == nullptr) break;
        double* out = arrays.output[ins.c] + first * ins.a;
        const std::uint32_t* rows = tape.row_slots.data() + ins.b;
        with_size<kMaxOutputRow>(ins.a, [&]<std::uint32_t N>() { write_rows<N>(out, count, rows, block); });
        break;
      }
      case Code::output: {
        if (arrays.output[ins.c] == nullptr) break;
        const std::size_t stride = arrays.output_stride[ins.c];
        double* out = arrays.output[ins.c] + first * stride + ins.b;
        const double* slot = block[ins.a];
        for (std::size_t j = 0; j < count; ++j) out[j * stride] = slot[j];
        break;
      }
      case Code::output_constant: {
        if (arrays.output[ins.c] == nullptr) break;
        const std::size_t stride = arrays.output_stride[ins.c];
        double* out = arrays.output[ins.c] + first * stride + ins.b;
        for (std::size_t j = 0; j < count; ++j) out[j * stride] = ins.value;
        break;
      }
      case Code::constant: {
        double* result = block[ins.dst];
        const V value = lanes(ins.value);
        for_vectors(block, [&](std::size_t i) { hn::Store(value, d, result + i); });
        break;
      }
      case Code::negate: map1(ins, block, [](V a) { return hn::Neg(a); }); break;
      case Code::absolute: map1(ins, block, [](V a) { return hn::Abs(a); }); break;
      case Code::sign: map1(ins, block, [](V a) { return sign_lanes(a); }); break;
      case Code::square: map1(ins, block, [](V a) { return hn::Mul(a, a); }); break;
      case Code::odd_power: {
        const std::uint32_t n = ins.b;
        map1(ins, block, [n](V a) { return odd_power_lanes(a, n); });
        break;
      }
      case Code::sqrt: map1(ins, block, [](V a) { return hn::Sqrt(a); }); break;
      case Code::cbrt: map1(ins, block, [](V a) { return each_lane(a, [](double x) { return std::cbrt(x); }); }); break;
      case Code::exp: map1(ins, block, [](V a) { return exp_lanes(a); }); break;
      case Code::log: map1(ins, block, [](V a) { return log_lanes(a); }); break;
      case Code::sin: map1(ins, block, [](V a) { return sin_lanes(a); }); break;
      case Code::cos: map1(ins, block, [](V a) { return cos_lanes(a); }); break;
      case Code::tan: map1(ins, block, [](V a) { return tan_lanes(a); }); break;
      case Code::asin: map1(ins, block, [](V a) { return each_lane(a, [](double x) { return std::asin(x); }); }); break;
      case Code::acos: map1(ins, block, [](V a) { return each_lane(a, [](double x) { return std::acos(x); }); }); break;
      case Code::atan: map1(ins, block, [](V a) { return each_lane(a, [](double x) { return std::atan(x); }); }); break;
      case Code::sinh: map1(ins, block, [](V a) { return each_lane(a, [](double x) { return std::sinh(x); }); }); break;
      case Code::cosh: map1(ins, block, [](V a) { return each_lane(a, [](double x) { return std::cosh(x); }); }); break;
      case Code::tanh: map1(ins, block, [](V a) { return each_lane(a, [](double x) { return std::tanh(x); }); }); break;
      case Code::add: map2(ins, block, [](V a, V b) { return hn::Add(a, b); }); break;
      case Code::subtract: map2(ins, block, [](V a, V b) { return hn::Sub(a, b); }); break;
      case Code::multiply: map2(ins, block, [](V a, V b) { return hn::Mul(a, b); }); break;
      case Code::divide: map2(ins, block, [](V a, V b) { return hn::Div(a, b); }); break;
      case Code::add_c: map1(ins, block, [c = lanes(ins.value)](V a) { return hn::Add(a, c); }); break;
      case Code::c_subtract: map1(ins, block, [c = lanes(ins.value)](V a) { return hn::Sub(c, a); }); break;
      case Code::multiply_c: map1(ins, block, [c = lanes(ins.value)](V a) { return hn::Mul(a, c); }); break;
      case Code::divide_c: map1(ins, block, [c = lanes(ins.value)](V a) { return hn::Div(a, c); }); break;
      case Code::c_divide: map1(ins, block, [c = lanes(ins.value)](V a) { return hn::Div(c, a); }); break;
      case Code::minimum: map2(ins, block, [](V a, V b) { return minimum_lanes(a, b); }); break;
      case Code::maximum: map2(ins, block, [](V a, V b) { return maximum_lanes(a, b); }); break;
      case Code::power: map2(ins, block, [](V a, V b) { return power_lanes(a, b); }); break;
      case Code::atan2: map2(ins, block, [](V a, V b) { return atan2_lanes(a, b); }); break;
      case Code::less_equal: map2(ins, block, [](V a, V b) { return hn::VecFromMask(D(), hn::Le(a, b)); }); break;
      case Code::choose: map3(ins, block, [](V m, V a, V b) { return hn::IfThenElse(as_mask(m), a, b); }); break;
      case Code::keep: map2(ins, block, [](V m, V a) { return hn::IfThenElseZero(as_mask(m), a); }); break;
      case Code::drop: map2(ins, block, [](V m, V a) { return hn::IfThenZeroElse(as_mask(m), a); }); break;
      default: break;
    }
  }
}

std::size_t lanes_of_target() { return hn::Lanes(D()); }

bool any_nan_of_target(const double* x, std::size_t n) {
  const D d;
  const std::size_t step = hn::Lanes(d);
  // A sum is NaN where a term is, and hardly ever else.
  V sums[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  std::size_t i = 0;
  for (; i + 4 * step <= n; i += 4 * step) {
    for (std::size_t s = 0; s < 4; ++s) sums[s] = hn::Add(sums[s], hn::LoadU(d, x + i + s * step));
  }
  const V sum = hn::Add(hn::Add(sums[0], sums[1]), hn::Add(sums[2], sums[3]));
  if (!hn::AllFalse(d, hn::IsNaN(sum))) i = 0;
  while (i < n && x[i] == x[i]) ++i;
  return i < n;
}

void run_points_of_target(const Tape& tape, const PointArrays& arrays, std::size_t n, std::size_t block,
                          double* slots) {
  const std::size_t step = hn::Lanes(D());
  for (std::size_t first = 0; first < n; first += block) {
    const std::size_t count = n - first < block ? n - first : block;
    run_block(tape, arrays, first, count, {slots, (count + step - 1) / step * step});
  }
}

}  // namespace
}  // namespace taut::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace taut::detail {

std::size_t num_lanes() { return TAUT_DISPATCH(lanes_of_target)(); }

bool any_nan(const double* x, std::size_t n) { return TAUT_DISPATCH(any_nan_of_target)(x, n); }

void run_points(const Tape& tape, const PointArrays& arrays, std::size_t n, std::size_t block, double* slots) {
  TAUT_DISPATCH(run_points_of_target)(tape, arrays, n, block, slots);
}

}  // namespace taut::detail
#endif
