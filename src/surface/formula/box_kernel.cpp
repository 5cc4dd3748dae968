#include "surface/formula/kernels.hpp"
#include "surface/simd_dispatch.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/formula/box_kernel.cpp"
#include "hwy/foreach_target.h"
// foreach_target first
#include "surface/formula/interval-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace taut::detail::HWY_NAMESPACE {
namespace {

/// The slots of one block of boxes: lower bounds, upper bounds, undefined lanes.
struct Block {
  double* slots;
  std::size_t size;

  [[nodiscard]] double* operator[](std::uint32_t slot) const { return slots + slot * 3 * size; }
  [[nodiscard]] Interval load(std::uint32_t slot, std::size_t i) const {
    const D d;
    const double* at = (*this)[slot] + i;
    return {hn::Load(d, at), hn::Load(d, at + size), hn::Load(d, at + 2 * size)};
  }
  void store(const Interval& x, std::uint32_t slot, std::size_t i) const {
    const D d;
    double* at = (*this)[slot] + i;
    hn::Store(x.lower, d, at);
    hn::Store(x.upper, d, at + size);
    hn::Store(x.undefined, d, at + 2 * size);
  }
};

template <class F>
HWY_INLINE void map1(const Instruction& ins, const Block& block, const F& f) {
  for (std::size_t i = 0; i < block.size; i += hn::Lanes(D())) block.store(f(block.load(ins.a, i)), ins.dst, i);
}

template <class F>
HWY_INLINE void map2(const Instruction& ins, const Block& block, const F& f) {
  for (std::size_t i = 0; i < block.size; i += hn::Lanes(D())) {
    block.store(f(block.load(ins.a, i), block.load(ins.b, i)), ins.dst, i);
  }
}

template <class F>
HWY_INLINE void map3(const Instruction& ins, const Block& block, const F& f) {
  for (std::size_t i = 0; i < block.size; i += hn::Lanes(D())) {
    block.store(f(block.load(ins.a, i), block.load(ins.b, i), block.load(ins.c, i)), ins.dst, i);
  }
}

void read_box(const BoxArrays& arrays, std::size_t first, std::size_t count, std::uint32_t entry, const Block& block,
              std::uint32_t slot_index) {
  double* slot = block[slot_index];
  const std::size_t size = block.size;
  const double* lower = arrays.lower + first * arrays.dim + entry;
  const double* upper = arrays.upper + first * arrays.dim + entry;
  for (std::size_t j = 0; j < size; ++j) {
    const std::size_t point = (j < count ? j : count - 1) * arrays.dim;
    slot[j] = lower[point];
    slot[size + j] = upper[point];
    slot[2 * size + j] = 0;
  }
  for (std::size_t i = 0; i < size; i += hn::Lanes(D())) {
    block.store(from_box(block.load(slot_index, i)), slot_index, i);
  }
}

/// A value that is undefined in all of a box has NaN bounds.
void write_bounds(const BoxArrays& arrays, std::size_t first, std::size_t count, std::uint32_t array,
                  std::uint32_t entry, const Block& block, std::uint32_t slot) {
  const D d;
  for (std::size_t i = 0; i < block.size; i += hn::Lanes(d)) {
    Interval x = block.load(slot, i);
    x.lower = hn::Or(x.lower, x.undefined);  // all bits set is a NaN
    x.upper = hn::Or(x.upper, x.undefined);
    block.store(x, slot, i);
  }
  const double* at = block[slot];
  for (std::size_t j = 0; j < count; ++j) {
    const std::size_t to = (first + j) * arrays.output_stride[array] + entry;
    arrays.output_lower[array][to] = at[j];
    arrays.output_upper[array][to] = at[block.size + j];
  }
}

void run_block(const Tape& tape, const BoxArrays& arrays, std::size_t first, std::size_t count, const Block& block) {
  for (const Instruction& ins : tape.instructions) {
    switch (ins.code) {
      case Code::input: read_box(arrays, first, count, ins.b, block, ins.dst); break;
      case Code::input_row:
        for (std::uint32_t entry = 0; entry < ins.c; ++entry) {
          read_box(arrays, first, count, entry, block, tape.row_slots[ins.b + entry]);
        }
        break;
      case Code::output_row:
        for (std::uint32_t entry = 0; entry < ins.a; ++entry) {
          write_bounds(arrays, first, count, ins.c, entry, block, tape.row_slots[ins.b + entry]);
        }
        break;
      case Code::output: write_bounds(arrays, first, count, ins.c, ins.b, block, ins.a); break;
      case Code::output_constant:
        for (std::size_t j = first; j < first + count; ++j) {
          const std::size_t to = j * arrays.output_stride[ins.c] + ins.b;
          arrays.output_lower[ins.c][to] = arrays.output_upper[ins.c][to] = ins.value;
        }
        break;
      case Code::constant:
        for (std::size_t i = 0; i < block.size; i += hn::Lanes(D())) block.store(point(ins.value), ins.dst, i);
        break;
      case Code::negate: map1(ins, block, [](Interval a) { return negate(a); }); break;
      case Code::absolute: map1(ins, block, [](Interval a) { return absolute(a); }); break;
      case Code::sign: map1(ins, block, [](Interval a) { return sign(a); }); break;
      case Code::square: map1(ins, block, [](Interval a) { return square(a); }); break;
      case Code::odd_power: {
        const std::uint32_t n = ins.b;
        map1(ins, block, [n](Interval a) { return odd_power(a, n); });
        break;
      }
      case Code::sqrt: map1(ins, block, [](Interval a) { return square_root(a); }); break;
      case Code::cbrt:
        map1(ins, block, [](Interval a) { return increasing(a, [](double x) { return std::cbrt(x); }); });
        break;
      case Code::exp: map1(ins, block, [](Interval a) { return exponential(a); }); break;
      case Code::log: map1(ins, block, [](Interval a) { return logarithm(a); }); break;
      case Code::sin: map1(ins, block, [](Interval a) { return sine(a, 0.25); }); break;
      case Code::cos: map1(ins, block, [](Interval a) { return sine(a, 0); }); break;
      case Code::tan: map1(ins, block, [](Interval a) { return tangent(a); }); break;
      case Code::asin: map1(ins, block, [](Interval a) { return arcsine(a); }); break;
      case Code::acos: map1(ins, block, [](Interval a) { return arccosine(a); }); break;
      case Code::atan:
        map1(ins, block, [](Interval a) { return increasing(a, [](double x) { return std::atan(x); }); });
        break;
      case Code::sinh:
        map1(ins, block, [](Interval a) { return increasing(a, [](double x) { return std::sinh(x); }); });
        break;
      case Code::cosh: map1(ins, block, [](Interval a) { return hyperbolic_cosine(a); }); break;
      case Code::tanh:
        map1(ins, block, [](Interval a) { return increasing(a, [](double x) { return std::tanh(x); }); });
        break;
      case Code::add: map2(ins, block, [](Interval a, Interval b) { return add(a, b); }); break;
      case Code::subtract: map2(ins, block, [](Interval a, Interval b) { return add(a, negate(b)); }); break;
      case Code::multiply: map2(ins, block, [](Interval a, Interval b) { return multiply(a, b); }); break;
      case Code::divide: map2(ins, block, [](Interval a, Interval b) { return divide(a, b); }); break;
      case Code::add_c: map1(ins, block, [c = point(ins.value)](Interval a) { return add(a, c); }); break;
      case Code::c_subtract: map1(ins, block, [c = point(ins.value)](Interval a) { return add(c, negate(a)); }); break;
      case Code::multiply_c: map1(ins, block, [c = ins.value](Interval a) { return scale(a, c); }); break;
      case Code::divide_c: map1(ins, block, [c = point(ins.value)](Interval a) { return divide(a, c); }); break;
      case Code::c_divide: map1(ins, block, [c = point(ins.value)](Interval a) { return divide(c, a); }); break;
      case Code::minimum: map2(ins, block, [](Interval a, Interval b) { return minimum(a, b); }); break;
      case Code::maximum: map2(ins, block, [](Interval a, Interval b) { return maximum(a, b); }); break;
      case Code::power: map2(ins, block, [](Interval a, Interval b) { return power(a, b); }); break;
      case Code::atan2: map2(ins, block, [](Interval a, Interval b) { return arctangent2(a, b); }); break;
      case Code::less_equal: map2(ins, block, [](Interval a, Interval b) { return less_equal(a, b); }); break;
      case Code::choose: map3(ins, block, [](Interval m, Interval a, Interval b) { return choose(m, a, b); }); break;
      case Code::keep: map2(ins, block, [](Interval m, Interval a) { return choose(m, a, point(0)); }); break;
      case Code::drop: map2(ins, block, [](Interval m, Interval a) { return choose(m, point(0), a); }); break;
      default: break;  // not on a tape for boxes
    }
  }
}

void run_boxes_of_target(const Tape& tape, const BoxArrays& arrays, std::size_t n, std::size_t block, double* slots) {
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

void run_boxes(const Tape& tape, const BoxArrays& arrays, std::size_t n, std::size_t block, double* slots) {
  TAUT_DISPATCH(run_boxes_of_target)(tape, arrays, n, block, slots);
}

}  // namespace taut::detail
#endif
