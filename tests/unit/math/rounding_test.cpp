// Differences within the rounding errors of their operands are set to 0.
#include "engine/math/rounding.hpp"

#include <gtest/gtest.h>

namespace pkm::testing {
namespace {

TEST(Rounding, DifferencesBelowARelativeSizeAreZero) {
  EXPECT_EQ(zero_if_rounding_error(-4.77e-18, 0.4), 0);
  EXPECT_EQ(zero_if_rounding_error(3.772e-21, 2e-5), 0);
  EXPECT_EQ(zero_if_rounding_error(0.1 + 0.2 - 0.3, 0.3), 0);
  EXPECT_EQ(zero_if_rounding_error(3.772e-21, 1e-20), 3.772e-21);  // small, but not relative to its operands
  EXPECT_EQ(zero_if_rounding_error(-1e-9, 1), -1e-9);
  EXPECT_EQ(zero_if_rounding_error(0.4, 0.4), 0.4);
  EXPECT_EQ(zero_if_rounding_error(0, 0), 0);
}

}  // namespace
}  // namespace pkm::testing
