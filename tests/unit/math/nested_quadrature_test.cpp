// Nested rules against polynomials and integrals with closed forms.
#include "engine/math/nested_quadrature.hpp"

#include <gtest/gtest.h>

#include "engine/math/dual.hpp"

namespace pkm::testing {
namespace {

template <class S, class F>
Integral<S> integral(const F& f, const std::vector<Piece<S>>& pieces, double tolerance) {
  std::vector<NestedPart<S>> scratch;
  const auto values = [&](std::size_t piece, std::span<const S> points, S* value) {
    EXPECT_LE(points.size(), 8u);
    for (const S& point : points) *value++ = f(piece, point);
  };
  return integrate_nested<S>(values, pieces, tolerance, 0, scratch);
}

TEST(NestedQuadrature, EachRuleIsExactToItsDegree) {
  const NestedRule& rule = nested_rule();
  const auto error = [&](const auto& weight, int degree) {  // of the integral of (2 x - 1)^degree; odd ones are 0
    double sum = 0;
    for (std::size_t i = 0; i < weight.size(); ++i) sum += weight[i] * std::pow(2 * rule.node[i] - 1, degree);
    return std::fabs(sum - 1.0 / (degree + 1));
  };
  for (int degree = 0; degree <= 24; degree += 2) {
    EXPECT_EQ(error(rule.weight, degree) < 1e-14, degree <= 23) << degree;
    EXPECT_EQ(error(rule.first_weight, degree) < 1e-14, degree <= 11) << degree;
    EXPECT_EQ(error(rule.least_weight, degree) < 1e-14, degree <= 5) << degree;
  }
}

TEST(NestedQuadrature, AsksForNoMoreNodesThanItTakes) {
  const auto wave = [](double length) {
    return integral<double>([](std::size_t, double x) { return portable::exp(x); }, {{0, length}}, 1e-10);
  };
  EXPECT_EQ(wave(0.1).evaluations, 7);
  EXPECT_EQ(wave(4).evaluations, 15);
  EXPECT_GT(wave(40).evaluations, 15);
  for (const double length : {0.1, 4.0, 40.0}) {
    const double exact = portable::exp(length) - 1;
    EXPECT_NEAR(wave(length).value, exact, 1e-10 * exact);
    EXPECT_LE(wave(length).error, 1e-10 * exact);
  }
}

TEST(NestedQuadrature, PiecesAreToldApartAndDerivativesFollowTheirEnds) {
  using D = Dual<1>;
  const D end = D::variable(0.7, 0);
  const auto result = integral<D>([](std::size_t piece, const D& x) { return piece == 0 ? x * x : x * x * 3.0; },
                                  {{D(0.0), end}, {end, D(1.0)}}, 1e-12);
  EXPECT_NEAR(result.value.a, 0.343 / 3 + 1 - 0.343, 1e-15);
  EXPECT_NEAR(result.value.v[0], 0.49 - 3 * 0.49, 1e-14);
}

TEST(NestedQuadrature, AKinkIsFoundByHalving) {
  const auto result = integral<double>([](std::size_t, double x) { return std::fabs(x - 0.3); }, {{0, 1}}, 1e-8);
  EXPECT_NEAR(result.value, 0.5 * (0.09 + 0.49), 1e-8);
  EXPECT_LE(result.error, 1e-8);
}

}  // namespace
}  // namespace pkm::testing
