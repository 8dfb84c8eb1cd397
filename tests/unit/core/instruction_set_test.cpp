#include "engine/core/instruction_set.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace pkm {
namespace {

std::vector<double> roots_of_products() {
  std::vector<double> result(1003);
  with_vectors([&] {
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double x = 0.1 * static_cast<double>(i);
      result[i] = std::sqrt(x * x + 0.3 * x) - x / (x + 0.7);
    }
  });
  return result;
}

TEST(InstructionSet, KernelsRunOnEverySetWithTheSameBits) {
  const InstructionSet before = instruction_set();
  use_instruction_set(InstructionSet::baseline);
  const std::vector<double> baseline = roots_of_products();
  for (const auto set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (set > widest_instruction_set()) {
      EXPECT_THROW(use_instruction_set(set), std::invalid_argument);
      continue;
    }
    use_instruction_set(set);
    EXPECT_EQ(instruction_set(), set);
    EXPECT_EQ(roots_of_products(), baseline) << name_of(set);
  }
  use_instruction_set(before);
}

}  // namespace
}  // namespace pkm
