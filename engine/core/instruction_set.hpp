// Which of the processor's vector instructions kernels use, chosen at run time.
//
// Files named *_kernel.cpp are compiled once for every instruction set, with the set as PKM_INSTRUCTION_SET. They
// define function templates over the set and instantiate them for theirs; with_instruction_set() calls the one in use.
// The bits of results are the same on all: kernels work on kLanes numbers side by side whatever the width of vectors
// (math/lanes.hpp), and the build forbids contraction. Sanitizers watch the baseline alone, whichever is chosen.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace pkm {

enum class InstructionSet { baseline, avx2, avx512 };  ///< each has what those before it have; baseline: any x86-64

inline constexpr std::array<std::string_view, 3> kInstructionSets = {"baseline", "avx2", "avx512"};

inline std::string_view name_of(InstructionSet set) { return kInstructionSets[static_cast<std::size_t>(set)]; }

/// The widest set that this processor and its system have.
InstructionSet widest_instruction_set();

/// The set in use: the widest, unless use_instruction_set() chose another.
InstructionSet instruction_set();

/// Chooses the set for the whole program. Throws std::invalid_argument where the processor has less.
void use_instruction_set(InstructionSet set);

/// kernel.template operator()<set>() for the set in use, as in
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
