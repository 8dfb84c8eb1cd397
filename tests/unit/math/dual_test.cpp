// Dual numbers: derivatives of every function against finite differences, values bit by bit, and limits of domains.
#include "engine/math/dual.hpp"

#include <gtest/gtest.h>

#include "engine/math/random.hpp"

namespace pkm::testing {
namespace {

/// Tests a function template of two variables on a range where it is smooth.
template <class F>
void expect_exact(const char* name, const F& f, double lower, double upper) {
  Stream random(1, 0, 0, Stream::Use::start);
  for (int i = 0; i < 200; ++i) {
    const double x = lower + (upper - lower) * random.u01(), y = lower + (upper - lower) * random.u01();
    SCOPED_TRACE(std::string(name) + " at " + std::to_string(x) + ", " + std::to_string(y));
    const Dual4 result = f(Dual4::variable(x, 1), Dual4::variable(y, 2));
    EXPECT_EQ(result.a, f(x, y));
    constexpr double kStep = 1e-5;
    const double by_x = (f(x + kStep, y) - f(x - kStep, y)) / (2 * kStep);
    const double by_y = (f(x, y + kStep) - f(x, y - kStep)) / (2 * kStep);
    EXPECT_EQ(result.v[0], 0);
    EXPECT_NEAR(result.v[1], by_x, 1e-7 * (1 + std::fabs(by_x)));
    EXPECT_NEAR(result.v[2], by_y, 1e-7 * (1 + std::fabs(by_y)));
    EXPECT_EQ(result.v[3], 0);
  }
}

TEST(Dual, DerivativesAreExactAndValuesBitIdentical) {
  expect_exact(
      "sums", [](auto x, auto y) { return -(x + y) - (y - x * 2.5) + 3.0 - (1.5 + x) - 0.5 * y; }, -2, 2);
  expect_exact(
      "products", [](auto x, auto y) { return x * y * x + y * y; }, -2, 2);
  expect_exact(
      "quotients", [](auto x, auto y) { return x / y + 2.0 / (x * y) - y / 3.0; }, 0.5, 2);
  expect_exact(
      "assignments",
      [](auto x, auto y) {
        x += y;
        x *= y;
        x -= y * y * y;
        x /= y;
        return x;
      },
      0.5, 2);
  expect_exact(
      "sqrt", [](auto x, auto y) { return sqrt(x * y); }, 0.5, 2);
  expect_exact(
      "sincos", [](auto x, auto y) { return sincos(x).sin * sincos(y).cos; }, -4, 4);
  expect_exact(
      "atan2", [](auto x, auto y) { return atan2(x, y); }, 0.2, 2);
  expect_exact(
      "asin and acos", [](auto x, auto y) { return asin(x) * acos(y); }, -0.9, 0.9);
  expect_exact(
      "exp and log", [](auto x, auto y) { return exp(x) * log(y + 3.0); }, -2, 2);
}

TEST(Dual, MinMaxAndClampSelectByValue) {
  const Dual4 x = Dual4::variable(0.3, 0), y = Dual4::variable(0.7, 1);
  EXPECT_EQ(min(x, y).v[0], 1);
  EXPECT_EQ(max(x, y).v[1], 1);
  EXPECT_EQ(clamp(x, Dual4(0.0), Dual4(0.2)).v[0], 0);
  EXPECT_EQ(clamp(x, Dual4(0.0), Dual4(0.5)).v[0], 1);
}

TEST(Dual, InfiniteDerivativesAreReplacedByZero) {
  const auto expect_zero = [](const Dual4& x) {
    for (int i = 0; i < 4; ++i) EXPECT_EQ(x.v[i], 0);
  };
  for (const double sign : {-1.0, 1.0}) {
    expect_zero(asin(Dual4::variable(sign, 0)));
    expect_zero(acos(Dual4::variable(sign, 0)));
    expect_zero(acos(Dual4(sign)));
  }
  expect_zero(sqrt_or_zero(Dual4::variable(0.0, 0)));
  expect_zero(sqrt_or_zero(Dual4::variable(-1.0, 0)));
}

}  // namespace
}  // namespace pkm::testing
