// Roots of polynomials up to degree four: against roots that are known, close together, multiple or at the endpoints.
#include "engine/generic/polynomial.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/math/uniform.hpp"

namespace pkm::generic {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<double> roots(const std::vector<double>& coefficients) {
  std::array<double, 8> found{};
  return {found.begin(), found.begin() + static_cast<std::ptrdiff_t>(roots_between(coefficients, found))};
}
std::vector<double> changes(const std::vector<double>& coefficients) {
  std::array<double, 8> found{};
  return {found.begin(), found.begin() + static_cast<std::ptrdiff_t>(sign_changes(coefficients, found))};
}
/// The coefficients of the product of (x - r) for all r.
std::vector<double> with_roots(const std::vector<double>& all) {
  std::vector<double> c = {1};
  for (const double r : all) {
    c.push_back(0);
    for (std::size_t i = c.size() - 1; i > 0; --i) c[i] = c[i - 1] - r * c[i];
    c[0] *= -r;
  }
  return c;
}
double value(const std::vector<double>& c, double x) {
  double sum = 0;
  for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
  return sum;
}
void expect_roots(const std::vector<double>& found, const std::vector<double>& expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size()) << ::testing::PrintToString(found);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << i;
}

TEST(Quadratic, HasAccurateRootsInSpiteOfCancellation) {
  // s^2 - 1e8 s + 1: the smaller root is 1 / (larger root) = 1e-8 (1 + 1e-16)
  const Roots far = roots_of({1, -1e8, 1});
  ASSERT_EQ(far.count, 2);
  EXPECT_DOUBLE_EQ(far.s[0], 1e-8);
  EXPECT_DOUBLE_EQ(far.s[1], 1e8);
  const Roots twice = roots_of({1, 2, 1});
  EXPECT_EQ(twice.count, 2);
  EXPECT_EQ(twice.s[0], -1);
  EXPECT_EQ(twice.s[1], -1);
}

TEST(Quadratic, DegeneratesToALineAndToAConstant) {
  const Roots line = roots_of({3, -2, 0});
  EXPECT_EQ(line.count, 1);
  EXPECT_EQ(line.s[0], 1.5);
  EXPECT_EQ(roots_of({3, 0, 0}).count, 0);
  EXPECT_EQ(roots_of({0, 0, 0}).count, 0);
  EXPECT_EQ(roots_of({1, 0, 1}).count, 0);
}

TEST(PolynomialRoots, SeparatedRootsAreAccurateToRounding) {
  expect_roots(roots(with_roots({-0.8, -0.3, 0.2, 0.7})), {-0.8, -0.3, 0.2, 0.7}, 1e-15);
  expect_roots(roots(with_roots({-0.9, 0.5, 3})), {-0.9, 0.5}, 1e-15);
  // Chebyshev polynomials T3 and T4: roots cos((2 k + 1) pi / (2 n))
  expect_roots(roots({0, -3, 0, 4}), {-std::sqrt(0.75), 0, std::sqrt(0.75)}, 1e-15);
  const double outer = std::cos(std::acos(-1) / 8), inner = std::sin(std::acos(-1) / 8);
  expect_roots(roots({1, 0, -8, 0, 8}), {-outer, -inner, inner, outer}, 1e-15);
}

/// Equidistant roots, as in Wilkinson's polynomial. The error of a root is about epsilon times the sum of the
/// coefficients divided by the derivative, which is d^3 for four roots with the distance d.
TEST(PolynomialRoots, CloseRootsAreAsAccurateAsTheirConditionAllows) {
  for (const double d : {0.3, 0.1, 0.03, 0.01, 0.003}) {
    const std::vector<double> expected = {0.05 - d, 0.05, 0.05 + d, 0.05 + 2 * d};
    expect_roots(roots(with_roots(expected)), expected, 1e-16 / (d * d * d) + 1e-15);
  }
}

TEST(PolynomialRoots, AreFoundAtTheEndpoints) {
  expect_roots(roots({1, 0, -1}), {-1, 1}, 0);
  expect_roots(roots(with_roots({-1, 0.5, 1})), {-1, 0.5, 1}, 1e-15);
  EXPECT_THAT(changes({1, 0, -1}), IsEmpty());
  expect_roots(changes(with_roots({-1, 0.5, 1})), {0.5}, 1e-15);
  EXPECT_THAT(roots(with_roots({-1.001, 1.001, 2, 3})), IsEmpty());
}

TEST(PolynomialRoots, MultipleRootsOfEvenOrderAreContactsWithoutSignChange) {
  const std::vector<double> twice = with_roots({0.25, 0.25}), contact = with_roots({-0.5, 0.25, 0.25});
  expect_roots(roots(twice), {0.25, 0.25}, 1e-15);
  EXPECT_THAT(roots({0.0625 + 1e-15, -0.5, 1}), ElementsAre(0.25)) << "above zero by a rounding error";
  EXPECT_THAT(roots({0.0625 + 1e-9, -0.5, 1}), IsEmpty());
  EXPECT_THAT(changes(contact), ElementsAre(DoubleNear(-0.5, 1e-15)));
  const std::vector<double> found = roots(contact);
  EXPECT_THAT(found, ::testing::Contains(DoubleNear(-0.5, 1e-15)));
  EXPECT_THAT(found, ::testing::Contains(DoubleNear(0.25, 1e-7)));
  EXPECT_THAT(roots({1, 0, 0, 0, 1}), IsEmpty());
}

/// Where a polynomial is exactly zero, at an endpoint or at an extremum, it counts as positive; beyond, it is negative,
/// and there must be no root far away.
TEST(PolynomialRoots, AreNotFoundWhereThePolynomialOnlyLeavesZero) {
  for (const auto& [c, zero] : {std::pair(std::vector<double>{0, 0, -1, 0, -1}, 0.0),    // -x^2 - x^4
                                std::pair(std::vector<double>{-0.5, -1, 0.5, 1}, -1.0),  // (x + 1) (x^2 - x/2 - 1/2)
                                std::pair(std::vector<double>{0.5, 1, -0.5, -1}, -1.0)}) {
    for (const double x : changes(c)) EXPECT_LT(std::fabs(value(c, x)), 1e-15) << x;
    for (const double x : roots(c)) EXPECT_LT(std::fabs(value(c, x)), 1e-15) << x;
    EXPECT_THAT(roots(c), ::testing::Contains(DoubleNear(zero, 1e-15)));
  }
}

/// A root of order m is known to the m-th root of the rounding error.
TEST(PolynomialRoots, MultipleRootsOfOddOrderChangeTheSign) {
  expect_roots(changes(with_roots({-0.5, 0.3, 0.3, 0.3})), {-0.5, 0.3}, 2e-5);
  expect_roots(changes({0, 0, 0, 1}), {0}, 1e-14);
}

TEST(PolynomialRoots, NegligibleLeadingCoefficientsAreIgnored) {
  expect_roots(roots({-0.5, 1, 0, 1e-17, -1e-16}), {0.5}, 1e-15);
  EXPECT_THAT(roots({0, 0, 0}), IsEmpty());
  EXPECT_THAT(roots({2}), IsEmpty());
}

/// Between consecutive sign changes that were found, and up to the endpoints, random polynomials keep their sign.
TEST(PolynomialRoots, NoSignChangeIsMissed) {
  testing::Uniform random(3);
  std::size_t most = 0;
  for (int i = 0; i < 3000; ++i) {
    std::vector<double> c(static_cast<std::size_t>(2 + i % 4));
    for (double& each : c) each = random(-1, 1);
    if (i % 2 == 1) c[0] *= 0.05;  // more roots in the interval
    std::vector<double> ends = changes(c);
    most = std::max(most, ends.size());
    ends.insert(ends.begin(), -1);
    ends.push_back(1);
    double before = 0;
    for (std::size_t k = 1; k < ends.size(); ++k) {
      const double middle = value(c, 0.5 * (ends[k - 1] + ends[k]));
      EXPECT_LT(before * middle, 1e-15) << "no sign change at " << ends[k - 1];
      before = middle;
      for (int j = 1; j < 20; ++j)
        EXPECT_GT(value(c, ends[k - 1] + (ends[k] - ends[k - 1]) * j / 20) * middle, -1e-15)
            << ::testing::PrintToString(c);
    }
  }
  EXPECT_GE(most, 3u);
}

}  // namespace
}  // namespace pkm::generic
