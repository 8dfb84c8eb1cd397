#include "engine/core/instruction_set.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(InstructionSet, DefaultsToTheWidestAndCanBeSelected) {
  EXPECT_EQ(instruction_set(), widest_instruction_set());
  for (const auto set : {InstructionSet::baseline, InstructionSet::avx2, InstructionSet::avx512}) {
    if (set > widest_instruction_set()) {
      EXPECT_THROW(use_instruction_set(set), std::invalid_argument);
      continue;
    }
    use_instruction_set(set);
    [[maybe_unused]] const auto seen = with_instruction_set([]<InstructionSet in_use>() { return in_use; });
    EXPECT_EQ(instruction_set(), set);
#if defined(__x86_64__) && !defined(PKM_SANITIZED)
    EXPECT_EQ(seen, set);
#endif
  }
  use_instruction_set(widest_instruction_set());
}

}  // namespace
}  // namespace pkm
