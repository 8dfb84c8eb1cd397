// Run-time dispatch of SIMD kernels to the vector instruction set of the processor.
//
// Files named *_kernel.cpp are compiled once for every instruction set, with the set as PKM_INSTRUCTION_SET. They
// define function templates parameterised by the set and instantiate them for that one set; with_instruction_set()
// calls the instantiation for the set in use. Results are bit-identical for all sets: kernels always process batches of
// kLanes numbers, whatever the width of a vector register (math/lanes.hpp), and the build disables floating-point
// contraction. Sanitizer builds always run the baseline kernels, whichever set is chosen.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace pkm {

/// Vector instruction sets; each includes all sets before it. `baseline` runs on every x86-64 processor.
enum class InstructionSet { baseline, avx2, avx512 };

inline constexpr std::array<std::string_view, 3> kInstructionSets = {"baseline", "avx2", "avx512"};

inline std::string_view name_of(InstructionSet set) { return kInstructionSets[static_cast<std::size_t>(set)]; }

/// The largest instruction set that the processor and the operating system support.
InstructionSet widest_instruction_set();

/// The instruction set in use: the largest that is supported, unless use_instruction_set() has selected another one.
InstructionSet instruction_set();

/// Selects the instruction set for the whole program. Throws std::invalid_argument if the processor does not support
/// it.
void use_instruction_set(InstructionSet set);

/// Calls the instantiation of a kernel for the instruction set in use, kernel.template operator()<set>(). Example:
///   with_instruction_set([&]<InstructionSet set> { return tally<set>(columns); })
template <class Kernel>
decltype(auto) with_instruction_set(const Kernel& kernel) {
#if defined(__x86_64__) && !defined(PKM_SANITIZED)
  switch (instruction_set()) {
    case InstructionSet::avx512:
      return kernel.template operator()<InstructionSet::avx512>();
    case InstructionSet::avx2:
      return kernel.template operator()<InstructionSet::avx2>();
    case InstructionSet::baseline:
      break;
  }
#endif
  return kernel.template operator()<InstructionSet::baseline>();
}

}  // namespace pkm
