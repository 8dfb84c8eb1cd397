// The portable elementary functions against long double, and reference results that must be bit-identical everywhere.
#include "engine/math/portable.hpp"

#include <gtest/gtest.h>

#include "tests/unit/math/uniform.hpp"

namespace pkm::testing {
namespace {

double ulps(double found, long double exact) {
  const double nearest = static_cast<double>(exact);
  const double unit = std::nextafter(std::fabs(nearest), 1e308) - std::fabs(nearest);
  return static_cast<double>(std::fabs(static_cast<long double>(found) - exact) / unit);
}

TEST(Portable, ErrorsStayWithinTheStatedBounds) {
  Uniform draw(1);
  double sine = 0, cosine = 0, arcs = 0, exponential = 0, logarithm = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double a = draw(-100, 100);
    const auto [s, c] = portable::sincos(a);
    sine = std::fmax(sine, static_cast<double>(std::fabs(s - sinl(a))) * 0x1p53);
    cosine = std::fmax(cosine, static_cast<double>(std::fabs(c - cosl(a))) * 0x1p53);
    const double t = std::tan(draw(-1.57, 1.57)), u = draw(-1, 1);
    arcs = std::fmax(arcs, std::fmax(ulps(portable::atan(t), atanl(t)), ulps(portable::asin(u), asinl(u))));
    arcs = std::fmax(arcs, ulps(portable::acos(u), acosl(u)));
    const double x = draw(-1, 1), y = draw(-1, 1);
    arcs = std::fmax(arcs, ulps(portable::atan2(y, x), atan2l(y, x)));
    const double e = draw(-300, 300);
    exponential = std::fmax(exponential, ulps(portable::exp(e), expl(e)));
    const double l = i % 2 ? std::exp(draw(-50, 50)) : draw(0.5, 2);
    logarithm = std::fmax(logarithm, ulps(portable::log(l), logl(l)));
  }
  EXPECT_LT(sine, 1.5);
  EXPECT_LT(cosine, 1.5);
  EXPECT_LT(arcs, 3);
  EXPECT_LT(exponential, 1.5);
  EXPECT_LT(logarithm, 1.5);
}

TEST(Portable, LimitsOfTheirDomains) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(portable::sin(0), 0);
  EXPECT_EQ(portable::cos(0), 1);
  EXPECT_EQ(portable::atan2(0, 0), 0);
  EXPECT_EQ(portable::atan2(0, -1), kPi);
  EXPECT_EQ(portable::asin(1), kPi / 2);
  EXPECT_EQ(portable::acos(1), 0);
  EXPECT_EQ(portable::acos(-1), kPi);
  EXPECT_TRUE(std::isnan(portable::asin(1.1)));
  EXPECT_EQ(portable::exp(0), 1);
  EXPECT_EQ(portable::exp(-1000), 0);
  EXPECT_EQ(portable::exp(1000), infinity);
  EXPECT_EQ(portable::log(1), 0);
  EXPECT_EQ(portable::log(0), -infinity);
  EXPECT_TRUE(std::isnan(portable::log(-1)));
  EXPECT_EQ(portable::pow(0, 0.5), 0);
  EXPECT_NEAR(portable::pow(2, 0.5), std::sqrt(2.0), 1e-15);
  for (const double invalid : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
    EXPECT_TRUE(std::isnan(portable::sin(invalid))) << invalid;
    EXPECT_TRUE(std::isnan(portable::cos(invalid))) << invalid;
  }
}

// If these results change, so do the results of all seeds: then increase kAlgorithms.
TEST(Portable, ReferenceResults) {
  EXPECT_EQ(portable::sin(1), 0x1.aed548f090ceep-1);
  EXPECT_EQ(portable::cos(1), 0x1.14a280fb5068cp-1);
  EXPECT_EQ(portable::exp(1), 0x1.5bf0a8b14576ap+1);
  EXPECT_EQ(portable::log(10), 0x1.26bb1bbb55516p+1);
}

}  // namespace
}  // namespace pkm::testing
