// Rules against integrals with closed forms; pieces with root-like ends; derivatives through moving ends.
#include "engine/math/quadrature.hpp"

#include <gtest/gtest.h>

#include "engine/math/dual.hpp"
#include "engine/math/statistics.hpp"

namespace pkm::testing {
namespace {

TEST(Quadrature, GaussRulesAreExactForPolynomials) {
  for (const int n : {1, 2, 5, 12, 40}) {
    const GaussRule rule = gauss_legendre(n);
    for (int degree = 0; degree < 2 * n; ++degree) {
      double sum = 0;
      for (std::size_t i = 0; i < rule.node.size(); ++i) sum += rule.weight[i] * std::pow(rule.node[i], degree);
      EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-14) << n << " nodes, degree " << degree;
    }
  }
}

TEST(Quadrature, KronrodRuleHoldsItsGaussRule) {
  const KronrodRule& rule = kronrod_15();
  for (int degree = 0; degree <= 22; ++degree) {
    double kronrod = 0, gauss = 0;
    for (std::size_t i = 0; i < KronrodRule::kNodes; ++i) {
      kronrod += rule.weight[i] * std::pow(rule.node[i], degree);
      gauss += rule.gauss_weight[i] * std::pow(rule.node[i], degree);
    }
    EXPECT_NEAR(kronrod, 1.0 / (degree + 1), 1e-14) << degree;
    if (degree <= 13) {
      EXPECT_NEAR(gauss, 1.0 / (degree + 1), 1e-14) << degree;
    }
  }
}

TEST(Quadrature, RootLikeEndsBecomeSmooth) {
  std::vector<Integral<double>> scratch;
  const auto half_disc = [](double x) { return std::sqrt(std::fmax(0.0, 1 - x * x)); };
  const auto mapped = integrate<double>(half_disc, {{-1, 1, true, true}}, 1e-12, scratch);
  EXPECT_NEAR(mapped.value, kPi / 2, 1e-12);
  const auto plain = integrate<double>(half_disc, {{-1, 1}}, 1e-12, scratch);
  EXPECT_LT(3 * mapped.evaluations, plain.evaluations);
}

TEST(Quadrature, AKinkIsFoundByHalving) {
  std::vector<Integral<double>> scratch;
  const auto result = integrate<double>([](double x) { return std::fabs(x - 0.3); }, {{0, 1}}, 1e-8, scratch);
  EXPECT_NEAR(result.value, 0.5 * (0.09 + 0.49), 1e-8);
  EXPECT_LE(result.error, 1e-8);
}

TEST(Quadrature, DerivativesMoveWithTheEnds) {
  using Scalar = Dual<1>;
  const Scalar end = Scalar::variable(0.7, 0);
  std::vector<Integral<Scalar>> scratch;
  // integral of sqrt(end - x) over [0, end] is (2/3) end^(3/2); its derivative is sqrt(end)
  const auto result = integrate<Scalar>([&](const Scalar& x) { return root_or_zero(Scalar(end - x)); },
                                        {{Scalar(0.0), end, false, true}}, 1e-12, scratch);
  EXPECT_NEAR(result.value.a, 2.0 / 3 * std::pow(0.7, 1.5), 1e-13);
  EXPECT_NEAR(result.value.v[0], std::sqrt(0.7), 1e-12);
}

TEST(Statistics, OfWeightedSamplesAndOfNone) {
  EXPECT_EQ(weighted_mean<double>({1, 3}, {2, 6}), 5);
  EXPECT_EQ(least<double>({0.3, 0.1, 0.2}), 0.1);
  EXPECT_EQ(weighted_mean<double>({}, {}), 0);
  EXPECT_EQ(least<double>({}), 0);
}

}  // namespace
}  // namespace pkm::testing
