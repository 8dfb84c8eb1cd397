// Enclosures of constraints and of their derivatives over boxes.
#include "engine/workspace/bounds/constraints.hpp"

#include <gtest/gtest.h>

#include "tests/unit/workspace/bounds/formulas.hpp"

namespace pkm::bounds {
namespace {

void expect_tight(const Interval& found, double lower, double upper) {
  EXPECT_LE(found.lower, lower);
  EXPECT_GE(found.upper, upper);
  EXPECT_NEAR(found.lower, lower, 1e-14);
  EXPECT_NEAR(found.upper, upper, 1e-14);
}

TEST(Constraints, EncloseValuesAndDerivatives) {
  const Constraints disc = conditions("xz", {"1 - x^2 - z^2"});
  Constraints::Scratch scratch = disc.make_scratch();
  disc.set_box({Interval(0.1, 0.2)}, scratch);
  expect_tight(disc.value(0, {-0.5, 0.3}, scratch), 1 - 0.04 - 0.25, 1 - 0.01);
  const Derivatives slope = disc.derivatives(0, {-0.5, 0.3}, scratch);
  EXPECT_TRUE(slope.is_known && slope.is_last_derivative_known);
  expect_tight(slope.by_axis[0], -0.4, -0.2);
  expect_tight(slope.by_axis[1], -0.6, 1);
  disc.set_box({Interval(2, 3)}, scratch);  // what depends on x must be computed again
  expect_tight(disc.value(0, {-0.5, 0.3}, scratch), 1 - 9 - 0.25, 1 - 4);
}

TEST(Constraints, KnowWhichDerivativesExist) {
  const Constraints kink = conditions("xz", {"1 - abs(x) - z", "sqrt(x) - z", "sign(x) - z"});
  Constraints::Scratch scratch = kink.make_scratch();
  kink.set_box({Interval(-1, 1)}, scratch);
  EXPECT_TRUE(kink.derivatives(0, {0, 1}, scratch).is_last_derivative_known);
  EXPECT_FALSE(kink.derivatives(1, {0, 1}, scratch).is_last_derivative_known);  // undefined for x < 0
  EXPECT_FALSE(kink.derivatives(2, {0, 1}, scratch).is_last_derivative_known);  // discontinuous
  kink.set_box({Interval(0, 1)}, scratch);
  EXPECT_TRUE(kink.derivatives(1, {0, 1}, scratch).is_last_derivative_known);
  EXPECT_FALSE(kink.derivatives(1, {0, 1}, scratch).is_known) << "the derivative by x is infinite at 0";
  kink.set_box({Interval(0.5, 1)}, scratch);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(kink.derivatives(k, {0, 1}, scratch).is_known) << k;
  expect_tight(kink.derivatives(0, {0, 1}, scratch).by_axis[0], -1, -1);
}

TEST(Constraints, AreListedOnce) {
  const Constraints same = conditions("xz", {"x - z", "z + 1", "x - z"});
  EXPECT_EQ(same.size(), 2u);
  EXPECT_TRUE(same.depends(0, 0) && same.depends(0, 1) && same.depends(1, 1));
  EXPECT_FALSE(same.depends(1, 0));
}

}  // namespace
}  // namespace pkm::bounds
