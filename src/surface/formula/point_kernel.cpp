#include <array>
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

/// One block of points: `count` from number `first` on, in `size` lanes, a multiple of the vector length; the lanes
/// left over repeat the last point.
struct Block {
  const Tape& tape;
  const PointArrays& arrays;
  std::size_t first;
  std::size_t count;
  double* slots;
  std::size_t size;

  [[nodiscard]] double* operator[](std::uint32_t slot) const { return slots + slot * size; }
};

/// What runs an instruction.
using Kernel = void (*)(const Instruction&, const Block&);

/// body(i) for each vector of a block, i its first lane: four a turn, for blocks are short.
template <class Body>
HWY_INLINE void for_vectors(const Block& block, const Body& body) {
  const std::size_t step = hn::Lanes(D());
  const std::size_t size = block.size;
  std::size_t i = 0;
  for (; i + 4 * step <= size; i += 4 * step) {
    body(i);
    body(i + step);
    body(i + 2 * step);
    body(i + 3 * step);
  }
  for (; i < size; i += step) body(i);
}

template <auto f>
void map1(const Instruction& ins, const Block& block) {
  const D d;
  const double* a = block[ins.a];
  double* result = block[ins.dst];
  for_vectors(block, [&](std::size_t i) { hn::Store(f(hn::Load(d, a + i)), d, result + i); });
}

/// f(a, the constant of the instruction).
template <auto f>
void map1_c(const Instruction& ins, const Block& block) {
  const D d;
  const double* a = block[ins.a];
  const V c = lanes(ins.value);
  double* result = block[ins.dst];
  for_vectors(block, [&](std::size_t i) { hn::Store(f(hn::Load(d, a + i), c), d, result + i); });
}

template <auto f>
void map2(const Instruction& ins, const Block& block) {
  const D d;
  const double* a = block[ins.a];
  const double* b = block[ins.b];
  double* result = block[ins.dst];
  for_vectors(block, [&](std::size_t i) { hn::Store(f(hn::Load(d, a + i), hn::Load(d, b + i)), d, result + i); });
}

template <auto f>
void map3(const Instruction& ins, const Block& block) {
  const D d;
  const double* a = block[ins.a];
  const double* b = block[ins.b];
  const double* c = block[ins.c];
  double* result = block[ins.dst];
  for_vectors(block, [&](std::size_t i) {
    hn::Store(f(hn::Load(d, a + i), hn::Load(d, b + i), hn::Load(d, c + i)), d, result + i);
  });
}

void constant(const Instruction& ins, const Block& block) {
  const V value = lanes(ins.value);
  double* result = block[ins.dst];
  for_vectors(block, [&](std::size_t i) { hn::Store(value, D(), result + i); });
}

void odd_power(const Instruction& ins, const Block& block) {
  const D d;
  const double* a = block[ins.a];
  double* result = block[ins.dst];
  for_vectors(block, [&](std::size_t i) { hn::Store(odd_power_lanes(hn::Load(d, a + i), ins.b), d, result + i); });
}

template <int kFirst, int kSecond, bool kScaled>
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
  const double* slot_d = block[ins.d];
  double* result = block[ins.dst];
  const V value = lanes(ins.value);
  const V value2 = lanes(ins.value2);
  const V value3 = lanes(ins.value3);
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
    if constexpr (kScaled) t = hn::Mul(hn::Mul(t, hn::Load(d, slot_d + i)), value3);
    hn::Store(t, d, result + i);
  });
}

/// One entry of each point.
void read_entry(const Instruction& ins, const Block& block) {
  const std::size_t stride = block.arrays.input_stride[ins.a];
  const double* from = block.arrays.input[ins.a] + block.first * stride + ins.b;
  double* slot = block[ins.dst];
  for (std::size_t j = 0; j < block.count; ++j) slot[j] = from[j * stride];
  for (std::size_t j = block.count; j < block.size; ++j) slot[j] = slot[block.count - 1];
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

/// All N entries of each point, taken apart into N slots.
template <std::uint32_t N>
void read_rows(const Instruction& ins, const Block& block) {
  const D d;
  const std::size_t stride = block.arrays.input_stride[ins.a];
  const double* from = block.arrays.input[ins.a] + block.first * stride;
  const std::uint32_t* rows = block.tape.row_slots.data() + ins.b;
  double* slots[N];
  for (std::uint32_t entry = 0; entry < N; ++entry) slots[entry] = block[rows[entry]];
  if (block.count == 1 || stride == 0) {  // one point for all lanes
    for (std::uint32_t entry = 0; entry < N; ++entry) {
      const V value = lanes(from[entry]);
      for (std::size_t i = 0; i < block.size; i += hn::Lanes(d)) hn::Store(value, d, slots[entry] + i);
    }
    return;
  }
  const std::size_t count = block.count;
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
void write_rows(const Instruction& ins, const Block& block) {
  if (block.arrays.output[ins.c] == nullptr) return;
  const D d;
  double* HWY_RESTRICT out = block.arrays.output[ins.c] + block.first * N;
  const std::size_t count = block.count;
  const std::uint32_t* rows = block.tape.row_slots.data() + ins.b;
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

/// One entry of each point of an output array, or null if that is not asked for.
double* output_entry(const Instruction& ins, const Block& block) {
  double* out = block.arrays.output[ins.c];
  return out == nullptr ? nullptr : out + block.first * block.arrays.output_stride[ins.c] + ins.b;
}

void write_entry(const Instruction& ins, const Block& block) {
  double* out = output_entry(ins, block);
  if (out == nullptr) return;
  const std::size_t stride = block.arrays.output_stride[ins.c];
  const double* slot = block[ins.a];
  for (std::size_t j = 0; j < block.count; ++j) out[j * stride] = slot[j];
}

void write_constant(const Instruction& ins, const Block& block) {
  double* out = output_entry(ins, block);
  if (out == nullptr) return;
  const std::size_t stride = block.arrays.output_stride[ins.c];
  for (std::size_t j = 0; j < block.count; ++j) out[j * stride] = ins.value;
}

template <std::uint32_t... I>
constexpr std::array<Kernel, sizeof...(I)> read_rows_by_size(std::integer_sequence<std::uint32_t, I...>) {
  return {read_rows<I + 1>...};
}
template <std::uint32_t... I>
constexpr std::array<Kernel, sizeof...(I)> write_rows_by_size(std::integer_sequence<std::uint32_t, I...>) {
  return {write_rows<I + 1>...};
}

void read_row(const Instruction& ins, const Block& block) {
  static constexpr auto kBySize = read_rows_by_size(std::make_integer_sequence<std::uint32_t, kMaxInputRow>());
  kBySize[ins.c - 1](ins, block);
}

void write_row(const Instruction& ins, const Block& block) {
  static constexpr auto kBySize = write_rows_by_size(std::make_integer_sequence<std::uint32_t, kMaxOutputRow>());
  kBySize[ins.a - 1](ins, block);
}

HWY_INLINE M as_mask(V v) { return hn::MaskFromVec(v); }

template <int... I>
constexpr void set_fused(Kernel* kernels, std::integer_sequence<int, I...>) {
  ((kernels[I] = map_fused<I % kNumPairs / kNumSecond, I % kNumSecond, (I >= kNumPairs)>), ...);
}

/// By code.
constexpr auto kKernels = [] {
  std::array<Kernel, kNumCodes> kernels{};
  const auto set = [&](Code code, Kernel kernel) { kernels[static_cast<std::size_t>(code)] = kernel; };
  set(Code::input, read_entry);
  set(Code::input_row, read_row);
  set(Code::output, write_entry);
  set(Code::output_row, write_row);
  set(Code::output_constant, write_constant);
  set(Code::constant, constant);
  set(Code::negate, map1<[](V a) { return hn::Neg(a); }>);
  set(Code::absolute, map1<[](V a) { return hn::Abs(a); }>);
  set(Code::sign, map1<[](V a) { return sign_lanes(a); }>);
  set(Code::square, map1<[](V a) { return hn::Mul(a, a); }>);
  set(Code::odd_power, odd_power);
  set(Code::sqrt, map1<[](V a) { return hn::Sqrt(a); }>);
  set(Code::cbrt, map1<[](V a) { return each_lane(a, [](double x) { return std::cbrt(x); }); }>);
  set(Code::exp, map1<[](V a) { return exp_lanes(a); }>);
  set(Code::log, map1<[](V a) { return log_lanes(a); }>);
  set(Code::sin, map1<[](V a) { return sin_lanes(a); }>);
  set(Code::cos, map1<[](V a) { return cos_lanes(a); }>);
  set(Code::tan, map1<[](V a) { return tan_lanes(a); }>);
  set(Code::asin, map1<[](V a) { return each_lane(a, [](double x) { return std::asin(x); }); }>);
  set(Code::acos, map1<[](V a) { return each_lane(a, [](double x) { return std::acos(x); }); }>);
  set(Code::atan, map1<[](V a) { return each_lane(a, [](double x) { return std::atan(x); }); }>);
  set(Code::sinh, map1<[](V a) { return each_lane(a, [](double x) { return std::sinh(x); }); }>);
  set(Code::cosh, map1<[](V a) { return each_lane(a, [](double x) { return std::cosh(x); }); }>);
  set(Code::tanh, map1<[](V a) { return each_lane(a, [](double x) { return std::tanh(x); }); }>);
  set(Code::add, map2<[](V a, V b) { return hn::Add(a, b); }>);
  set(Code::add_c, map1_c<[](V a, V c) { return hn::Add(a, c); }>);
  set(Code::subtract, map2<[](V a, V b) { return hn::Sub(a, b); }>);
  set(Code::c_subtract, map1_c<[](V a, V c) { return hn::Sub(c, a); }>);
  set(Code::multiply, map2<[](V a, V b) { return hn::Mul(a, b); }>);
  set(Code::multiply_c, map1_c<[](V a, V c) { return hn::Mul(a, c); }>);
  set(Code::divide, map2<[](V a, V b) { return hn::Div(a, b); }>);
  set(Code::divide_c, map1_c<[](V a, V c) { return hn::Div(a, c); }>);
  set(Code::c_divide, map1_c<[](V a, V c) { return hn::Div(c, a); }>);
  set(Code::minimum, map2<[](V a, V b) { return minimum_lanes(a, b); }>);
  set(Code::maximum, map2<[](V a, V b) { return maximum_lanes(a, b); }>);
  set(Code::power, map2<[](V a, V b) { return power_lanes(a, b); }>);
  set(Code::atan2, map2<[](V a, V b) { return atan2_lanes(a, b); }>);
  set(Code::less_equal, map2<[](V a, V b) { return hn::VecFromMask(D(), hn::Le(a, b)); }>);
  set(Code::choose, map3<[](V m, V a, V b) { return hn::IfThenElse(as_mask(m), a, b); }>);
  set(Code::keep, map2<[](V m, V a) { return hn::IfThenElseZero(as_mask(m), a); }>);
  set(Code::drop, map2<[](V m, V a) { return hn::IfThenZeroElse(as_mask(m), a); }>);
  set_fused(kernels.data() + static_cast<std::size_t>(Code::fused), std::make_integer_sequence<int, kNumFused>());
  return kernels;
}();

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
    const Block points{tape, arrays, first, count, slots, (count + step - 1) / step * step};
    for (const Instruction& ins : tape.instructions) kKernels[static_cast<std::size_t>(ins.code)](ins, points);
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
