#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "surface/formula/expression.hpp"

namespace taut::detail {

/// What one instruction does. `_c` and `c_` mark the operand that is a constant held in the instruction.
enum class Code : std::uint8_t {
  input,            // slot dst = entry b of input array a
  input_row,        // the slots row_slots[b ...] = all c entries of input array a
  output,           // entry b of output array c = slot a
  output_row,       // all a entries of output array c = the slots row_slots[b ...]
  output_constant,  // entry b of output array c = value
  constant,         // slot dst = value
  negate,
  absolute,
  sign,
  square,
  odd_power,  // exponent b
  sqrt,
  cbrt,
  exp,
  log,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  sinh,
  cosh,
  tanh,
  add,
  add_c,
  subtract,
  c_subtract,
  multiply,
  multiply_c,
  divide,
  divide_c,
  c_divide,
  minimum,
  maximum,
  power,
  atan2,
  less_equal,
  choose,
  keep,
  drop,
  fused,  // first of the kNumFused codes of several operations in one, see fused_code
};

/// Two operations in one instruction save a store, a load and a decoding. Each still rounds by itself, so the result
/// has the bits of the two instructions. t = first operation on a (and b, or `value`), then the second with c or
/// `value2`. A scaled one goes on with t * d * `value3`: so end the entries of a Hessian, times the weight.
enum class FirstOp : std::uint8_t { multiply, multiply_c, square, add, add_c, subtract };
enum class SecondOp : std::uint8_t { add, add_c, multiply, multiply_c, minus, from, from_c, square };
inline constexpr int kNumFirst = 6;
inline constexpr int kNumSecond = 8;
inline constexpr int kNumPairs = kNumFirst * kNumSecond;
inline constexpr int kNumFused = 2 * kNumPairs;  // the scaled ones last
inline constexpr int kNumCodes = static_cast<int>(Code::fused) + kNumFused;
static_assert(kNumCodes <= 256);

[[nodiscard]] constexpr Code fused_code(FirstOp first, SecondOp second) {
  return static_cast<Code>(static_cast<int>(Code::fused) + static_cast<int>(first) * kNumSecond +
                           static_cast<int>(second));
}
[[nodiscard]] constexpr Code scaled_code(Code fused) { return static_cast<Code>(static_cast<int>(fused) + kNumPairs); }

struct Instruction {
  Code code = Code::constant;
  std::uint32_t dst = 0;
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t c = 0;
  std::uint32_t d = 0;
  double value = 0;
  double value2 = 0;
  double value3 = 0;
};

/// A straight-line program: read inputs, compute in slots, write outputs. Immutable; what runs it brings the slots.
struct Tape {
  std::vector<Instruction> instructions;
  std::vector<std::uint32_t> row_slots;
  std::uint32_t num_slots = 0;
};

/// Input arrays of at most kMaxInputRow entries a point are read, and output arrays of at most kMaxOutputRow written, a
/// whole point at a time: the strided memory traffic is what small formulas spend most of their time on.
inline constexpr std::uint32_t kMaxInputRow = 4;
inline constexpr std::uint32_t kMaxOutputRow = 16;

/// A variable of the graph is an entry of an input array: variables are numbered array by array.
struct InputArray {
  std::uint32_t first = 0;  // number of its first variable
  std::uint32_t size = 0;
};

/// Entry `entry` of output array `array` is to hold `node`.
struct Output {
  std::uint32_t array;
  std::uint32_t entry;
  NodeId node;
};

/// Compiles what `outputs` need: dead parts are left out, a slot is reused as soon as its value is no longer needed.
/// output_sizes[i] is the number of entries of output array i; of an array with at most kMaxOutputRow entries,
/// `outputs` names all or none. `fuse`: use instructions of several operations (the kernel for boxes has none).
[[nodiscard]] Tape compile(const Graph& graph, const std::vector<InputArray>& inputs,
                           const std::vector<std::uint32_t>& output_sizes, const std::vector<Output>& outputs,
                           bool fuse = true);

}  // namespace taut::detail
