// What a difference of rounded numbers says.
#include "engine/math/rounding.hpp"

#include <gtest/gtest.h>

namespace pkm::testing {
namespace {

TEST(Rounding, WhatIsLeftOfADifferenceIsRoundingBelowARelativeSize) {
  EXPECT_EQ(beyond_rounding(-4.77e-18, 0.4), 0);
  EXPECT_EQ(beyond_rounding(3.772e-21, 2e-5), 0);
  EXPECT_EQ(beyond_rounding(0.1 + 0.2 - 0.3, 0.3), 0);
  EXPECT_EQ(beyond_rounding(3.772e-21, 1e-20), 3.772e-21);  // small among small ones: said
  EXPECT_EQ(beyond_rounding(-1e-9, 1), -1e-9);
  EXPECT_EQ(beyond_rounding(0.4, 0.4), 0.4);
  EXPECT_EQ(beyond_rounding(0, 0), 0);
}

}  // namespace
}  // namespace pkm::testing
