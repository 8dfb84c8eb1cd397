#include "engine/core/instruction_set.hpp"

#include <atomic>
#include <stdexcept>
#include <string>

namespace pkm {
namespace {

std::atomic<InstructionSet>& in_use() {
  static std::atomic<InstructionSet> set{widest_instruction_set()};
  return set;
}

}  // namespace

InstructionSet widest_instruction_set() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl"))
    return InstructionSet::avx512;
  if (__builtin_cpu_supports("avx2")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

InstructionSet instruction_set() { return in_use().load(std::memory_order_relaxed); }

void use_instruction_set(InstructionSet set) {
  if (set > widest_instruction_set())
    throw std::invalid_argument("this processor does not support " + std::string(name_of(set)) +
                                "; its widest instruction set is " + std::string(name_of(widest_instruction_set())));
  in_use().store(set, std::memory_order_relaxed);
}

}  // namespace pkm
