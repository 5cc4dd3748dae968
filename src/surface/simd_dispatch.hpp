#pragma once

#include <cstddef>

#include "hwy/detect_targets.h"

namespace taut::detail {

/// Instruction sets that SIMD kernels are compiled for, the least first. All of them give the same bits.
///
/// Kernels are written with Highway and compiled once a target, but which of them runs is decided here: Highway's own
/// choice lies in a shared library that times the clock for 4 ms at every start of a program.
enum class InstructionSet { baseline, sse4, avx2, avx512 };

/// Does this machine have it.
[[nodiscard]] bool has_instruction_set(InstructionSet set);

/// The one in use: the best that the machine has, unless a test has asked for a lesser one.
[[nodiscard]] InstructionSet instruction_set();

/// For tests: from now on all kernels run on `set`, which the machine must have.
void use_instruction_set(InstructionSet set);

}  // namespace taut::detail

#if HWY_TARGETS & HWY_SSE4
#define TAUT_OF_SSE4(name) N_SSE4::name
#else
#define TAUT_OF_SSE4(name) HWY_STATIC_DISPATCH(name)
#endif
#if HWY_TARGETS & HWY_AVX2
#define TAUT_OF_AVX2(name) N_AVX2::name
#else
#define TAUT_OF_AVX2(name) HWY_STATIC_DISPATCH(name)
#endif
#if HWY_TARGETS & HWY_AVX3
#define TAUT_OF_AVX512(name) N_AVX3::name
#else
#define TAUT_OF_AVX512(name) HWY_STATIC_DISPATCH(name)
#endif

/// The function `name` of this namespace's HWY_NAMESPACE, as compiled for the instruction set in use. Only where
/// HWY_ONCE holds.
#define TAUT_DISPATCH(name)                                                                                 \
  ([](::taut::detail::InstructionSet set) {                                                                 \
    using Function = decltype(&HWY_STATIC_DISPATCH(name));                                                  \
    constexpr Function kCompiled[] = {&HWY_STATIC_DISPATCH(name), &TAUT_OF_SSE4(name), &TAUT_OF_AVX2(name), \
                                      &TAUT_OF_AVX512(name)};                                               \
    return kCompiled[static_cast<std::size_t>(set)];                                                        \
  }(::taut::detail::instruction_set()))
