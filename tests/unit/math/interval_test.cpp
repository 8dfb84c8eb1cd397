#include "engine/math/interval.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "engine/expression/formula.hpp"
#include "engine/expression/operation.hpp"

namespace pkm {
namespace {

constexpr double kLargestDouble = std::numeric_limits<double>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Interval, BoundsAreWidenedToTheNextDouble) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 100000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (!std::isfinite(x)) continue;
    EXPECT_EQ(next_up(x), std::nextafter(x, kInfinity));
    EXPECT_EQ(next_down(x), std::nextafter(x, -kInfinity));
  }
  for (const double x : {0.0, -0.0, 5e-324, -5e-324, kLargestDouble, -kLargestDouble}) {
    EXPECT_EQ(next_up(x), std::nextafter(x, kInfinity));
    EXPECT_EQ(next_down(x), std::nextafter(x, -kInfinity));
  }
  EXPECT_EQ(next_down(kInfinity), kLargestDouble);  // an overflow came from a finite number
  EXPECT_EQ(next_up(-kInfinity), -kLargestDouble);
  EXPECT_EQ(next_up(kInfinity), kInfinity);
}

TEST(Interval, IsExactIfNothingIsRounded) {
  EXPECT_TRUE((Interval(3, 4) - Interval(3)).holds(0));
  EXPECT_EQ((Interval(0) * Interval(-5, 7)).upper, 0);
  EXPECT_EQ((Interval(0) * Interval::everything(Decoration::defined)).lower, 0);
  EXPECT_EQ(sqrt(Interval(0)).upper, 0);
  EXPECT_EQ(square(Interval(-2, 1)).lower, 0);
}

TEST(Interval, OverflowKeepsValidBounds) {
  const Interval large(1e308, kLargestDouble), sum = large + large, product = large * large;
  EXPECT_EQ(sum.lower, kLargestDouble);
  EXPECT_EQ(sum.upper, kInfinity);
  EXPECT_EQ(product.lower, kLargestDouble);
  EXPECT_FALSE((sum - sum).is_empty());
  EXPECT_TRUE((sum - sum).holds(0));
  EXPECT_TRUE((Interval(1) / sum).holds(0));
}

TEST(Interval, DecorationShowsUndefinedArguments) {
  const Interval enclosure = sqrt(Interval(-1, 4));
  EXPECT_FALSE(enclosure.is_defined());
  EXPECT_FALSE((enclosure + Interval(1)).is_certified_satisfied());
  EXPECT_GE(enclosure.upper, 2);
  EXPECT_TRUE(sqrt(Interval(-2, -1)).is_empty());
  EXPECT_TRUE((sqrt(Interval(-2, -1)) * Interval(0)).is_empty());
  EXPECT_TRUE(sqrt(Interval(-2, -1)).is_certified_violated());
  EXPECT_FALSE((Interval(1) / Interval(-1, 1)).is_defined());
  EXPECT_EQ((Interval(1) / Interval(0, 1)).upper, kInfinity);
  EXPECT_GT((Interval(1) / Interval(0, 1)).lower, 0.99);
  EXPECT_TRUE((Interval(1) / Interval(0)).is_empty());
  EXPECT_FALSE(acos(Interval(0, 1.5)).is_defined());
  EXPECT_TRUE(acos(Interval(1.1, 1.5)).is_empty());
  EXPECT_FALSE(tan(Interval(1, 2)).is_defined());
  EXPECT_TRUE(Interval(std::nan("")).is_empty());
  EXPECT_TRUE(min(Interval(1), sqrt(Interval(-1))).is_empty());
}

TEST(Interval, DecorationShowsDiscontinuities) {
  EXPECT_TRUE(atan2(Interval(1, 2), Interval(-1, 1)).is_continuous());
  EXPECT_FALSE(atan2(Interval(-1, 1), Interval(-2, -1)).is_continuous());
  EXPECT_TRUE(atan2(Interval(-1, 1), Interval(1, 2)).is_continuous());
  EXPECT_FALSE(wrapped(Interval(3, 4)).is_continuous());
  EXPECT_TRUE(wrapped(Interval(4, 5)).is_continuous());
  EXPECT_TRUE(wrapped(Interval(4, 5)).holds(4.5 - 2 * 3.141592653589793));
  EXPECT_FALSE(choose(Interval(0, 1), Interval(1), Interval(2)).is_continuous());
  EXPECT_TRUE(choose(Interval(1), Interval(1), Interval(2)).is_continuous());
  EXPECT_FALSE(less(Interval(0, 2), Interval(1)).is_continuous());
  EXPECT_EQ(less(Interval(0, 1), Interval(2)).lower, 1);
}

/// Formulas with every operation, evaluated on boxes and at random points in them.
TEST(Interval, OfAFormulaContainsItsValues) {
  const std::vector<std::string> names = {"x", "y", "z"};
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::size_t known = 0;
  for (const std::string text :
       {"x + y - z", "x * y / z", "-x^2 + y^3 - z^-1", "sqrt(x) * abs(y)", "sin(x) + cos(y) * tan(z)",
        "asin(x/3) + acos(y/3) - atan(z)", "atan2(x, y) + sinh(z)", "cosh(x) - tanh(y)", "exp(x) - log(y) + log10(z)",
        "min(x, y, z) + max(x, y)", "sign(x) * y", "x < y ? z : x", "(x <= y) + (y > z)", "(x >= y) * (x == y)",
        "(x != z) - (x > 0 || y > 0) + (x > 0 && z > 0)", "x^y", "x^2.5", "x^(1/3) * z", "x*x - y*y*y"}) {
    const Formula formula(text, names);
    for (int i = 0; i < 3000; ++i) {
      std::array<Interval, 3> box;
      for (Interval& side : box) {
        const double a = -3 + 6 * unit(random), width = std::exp2(-10 * unit(random));
        side = {a, a + width};
      }
      const Interval all = formula.value<Interval>(box);
      for (int k = 0; k < 5; ++k) {
        std::array<double, 3> at;
        for (std::size_t j = 0; j < 3; ++j) at[j] = box[j].lower + unit(random) * (box[j].upper - box[j].lower);
        const double value = formula.value<double>(at);
        if (std::isfinite(value)) {
          ++known;
          ASSERT_LE(all.lower, value + 1e-13 * (1 + std::fabs(value))) << text;
          ASSERT_GE(all.upper, value - 1e-13 * (1 + std::fabs(value))) << text;
        } else {
          ASSERT_FALSE(all.is_defined()) << text;
        }
      }
    }
  }
  EXPECT_GT(known, 200000U);
}

}  // namespace
}  // namespace pkm
