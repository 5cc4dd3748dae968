#include "surface/simd_dispatch.hpp"

#include <atomic>
#include <cassert>

#if HWY_ARCH_X86
#include <cpuid.h>
#endif

namespace taut::detail {
namespace {

#if HWY_ARCH_X86
bool has_half_precision() {
  unsigned a = 0;
  unsigned b = 0;
  unsigned c = 0;
  unsigned d = 0;
  return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_F16C) != 0;
}
#endif

InstructionSet best() {
  for (const InstructionSet set : {InstructionSet::avx512, InstructionSet::avx2, InstructionSet::sse4}) {
    if (has_instruction_set(set)) return set;
  }
  return InstructionSet::baseline;
}

std::atomic<InstructionSet>& in_use() {
  static std::atomic<InstructionSet> set = best();
  return set;
}

}  // namespace

/// All that Highway lets the compiler assume for its target of that name; of AVX, that the system saves its registers,
/// too.
bool has_instruction_set(InstructionSet set) {
#if HWY_ARCH_X86
  __builtin_cpu_init();
  const bool sse4 = __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") &&
                    __builtin_cpu_supports("aes") && __builtin_cpu_supports("pclmul");
  const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") && has_half_precision();
  const bool avx512 = avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd");
  switch (set) {
    case InstructionSet::baseline: return true;
    case InstructionSet::sse4: return sse4;
    case InstructionSet::avx2: return avx2;
    case InstructionSet::avx512: return avx512;
  }
  return false;
#else
  return set == InstructionSet::baseline;
#endif
}

InstructionSet instruction_set() { return in_use().load(std::memory_order_relaxed); }

void use_instruction_set(InstructionSet set) {
  assert(has_instruction_set(set));
  in_use().store(set, std::memory_order_relaxed);
}

}  // namespace taut::detail
