// Which of the processor's vector instructions kernels use, chosen at run time.
//
// A kernel is written once, as plain loops. with_vectors() compiles it for three instruction sets and runs the widest
// one that the processor has. The bits of results are the same on all: the build forbids contraction, compilers don't
// change the order of sums, and nothing in a kernel depends on the width of a vector.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace pkm {

enum class InstructionSet { baseline, avx2, avx512 };  ///< each has what those before it have; baseline is x86-64

inline constexpr std::array<std::string_view, 3> kInstructionSets = {"baseline", "avx2", "avx512"};

inline std::string_view name_of(InstructionSet set) { return kInstructionSets[static_cast<std::size_t>(set)]; }

/// The widest set that this processor, and the system it runs, has.
InstructionSet widest_instruction_set();

/// The set in use: the widest, unless use_instruction_set() chose another.
InstructionSet instruction_set();

/// Chooses the set for the whole program; not while a kernel runs. Wider ones than the processor has are refused by
/// std::invalid_argument.
void use_instruction_set(InstructionSet set);

namespace instruction_set_detail {

// Flattened: everything called whose definition is seen becomes part of the function and is compiled for its set.
// Code that is not seen runs as it was compiled, for the baseline.
template <class Kernel>
[[gnu::flatten, gnu::noinline]] void run_baseline(const Kernel& kernel) {
  kernel();
}
#if defined(__x86_64__)
template <class Kernel>
[[gnu::target("avx2"), gnu::flatten, gnu::noinline]] void run_avx2(const Kernel& kernel) {
  kernel();
}
template <class Kernel>
[[gnu::target("avx512f,avx512dq,avx512bw,avx512vl,prefer-vector-width=512"), gnu::flatten, gnu::noinline]] void
run_avx512(const Kernel& kernel) {
  kernel();
}
#endif

}  // namespace instruction_set_detail

/// Runs kernel(), a function object without arguments or result, compiled for the set in use.
template <class Kernel>
void with_vectors(const Kernel& kernel) {
#if defined(__x86_64__)
  switch (instruction_set()) {
    case InstructionSet::avx512:
      return instruction_set_detail::run_avx512(kernel);
    case InstructionSet::avx2:
      return instruction_set_detail::run_avx2(kernel);
    case InstructionSet::baseline:
      break;
  }
#endif
  instruction_set_detail::run_baseline(kernel);
}

}  // namespace pkm
