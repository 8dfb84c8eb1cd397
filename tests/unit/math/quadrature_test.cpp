// Quadrature against closed-form integrals, with square-root singularities at endpoints and derivatives with respect to
// endpoints; statistics of samples.
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

TEST(Quadrature, NestedRulesHaveTheStatedDegrees) {
  // Degree of exactness, from the integrals of even powers of 2 x - 1; those of odd powers are 0.
  const auto exact_to = [](const NestedRule& rule, const auto& weight) {
    int degree = 0;
    for (double error = 0; error < 1e-14; degree += 2) {
      error = -1.0 / (degree + 1);
      for (std::size_t i = 0; i < weight.size(); ++i) error += weight[i] * std::pow(2 * rule.node[i] - 1, degree);
      error = std::fabs(error);
    }
    return degree - 3;
  };
  const NestedRule &kronrod = kronrod_rule(), &patterson = patterson_rule();
  EXPECT_EQ(exact_to(kronrod, kronrod.level[0].weight), 23);
  EXPECT_EQ(exact_to(kronrod, kronrod.level[0].fewer), 13);
  EXPECT_EQ(exact_to(patterson, patterson.level[0].fewer), 5);
  EXPECT_EQ(exact_to(patterson, patterson.level[0].weight), 11);
  EXPECT_EQ(exact_to(patterson, patterson.level[1].fewer), 11);
  EXPECT_EQ(exact_to(patterson, patterson.level[1].weight), 23);
}

TEST(Quadrature, UsesTheFewestNodesThatReachTheTolerance) {
  std::vector<QuadratureCell<double>> scratch;
  const auto integral = [&](double length) {
    return integrate<double>([](double x) { return portable::exp(x); }, {{0, length}}, 1e-10, 0, scratch,
                             {.rule = patterson_rule()});
  };
  EXPECT_EQ(integral(0.1).evaluations, 7);
  EXPECT_EQ(integral(4).evaluations, 15);
  EXPECT_GT(integral(40).evaluations, 15);
  for (const double length : {0.1, 4.0, 40.0}) {
    const double exact = portable::exp(length) - 1;
    EXPECT_NEAR(integral(length).value, exact, 1e-10 * exact);
    EXPECT_LE(integral(length).error, 1e-10 * exact);
  }
}

TEST(Quadrature, SquareRootSingularitiesAreRemoved) {
  std::vector<QuadratureCell<double>> scratch;
  const auto half_disc = [](double x) { return std::sqrt(std::fmax(0.0, 1 - x * x)); };
  const auto mapped = integrate<double>(half_disc, {{-1, 1, true, true}}, 1e-12, 0, scratch);
  EXPECT_NEAR(mapped.value, kPi / 2, 1e-12);
  const auto plain = integrate<double>(half_disc, {{-1, 1}}, 1e-12, 0, scratch);
  EXPECT_LT(3 * mapped.evaluations, plain.evaluations);
}

TEST(Quadrature, KinksAreResolvedByBisection) {
  std::vector<QuadratureCell<double>> scratch;
  for (const NestedRule* rule : {&kronrod_rule(), &patterson_rule()}) {
    const auto result =
        integrate<double>([](double x) { return std::fabs(x - 0.3); }, {{0, 1}}, 1e-8, 0, scratch, {.rule = *rule});
    EXPECT_NEAR(result.value, 0.5 * (0.09 + 0.49), 1e-8);
    EXPECT_LE(result.error, 1e-8);
  }
}

TEST(Quadrature, BisectionStopsAtRoundingErrors) {
  std::vector<QuadratureCell<double>> scratch;
  const auto noisy = [](double x) { return ((1e4 + x * x) - 1e4 - x * x) + 1e-9; };  // rounding errors of 1e-12
  const auto endless = integrate<double>(noisy, {{0, 1}}, 1e-8, 0, scratch);
  const auto result = integrate<double>(noisy, {{0, 1}}, 1e-8, 1e-10, scratch);
  EXPECT_EQ(result.evaluations, 15);
  EXPECT_GT(endless.evaluations, 1000 * result.evaluations);
  EXPECT_NEAR(result.value, 1e-9, 1e-11);
}

TEST(Quadrature, EndpointsContributeToDerivatives) {
  using Scalar = Dual<1>;
  const Scalar end = Scalar::variable(0.7, 0);
  std::vector<QuadratureCell<Scalar>> scratch;
  // integral of sqrt(end - x) over [0, end] is (2/3) end^(3/2); its derivative is sqrt(end)
  const auto result = integrate<Scalar>([&](const Scalar& x) { return sqrt_or_zero(Scalar(end - x)); },
                                        {{Scalar(0.0), end, false, true}}, 1e-12, 0, scratch);
  EXPECT_NEAR(result.value.a, 2.0 / 3 * std::pow(0.7, 1.5), 1e-13);
  EXPECT_NEAR(result.value.v[0], std::sqrt(0.7), 1e-12);
  const auto sum = integrate<Scalar>([](const Scalar& x) { return x * x; }, {{Scalar(0.0), end}, {end, Scalar(1.0)}},
                                     1e-12, 0, scratch, {.rule = patterson_rule()});
  EXPECT_NEAR(sum.value.a, 1.0 / 3, 1e-15);
  EXPECT_NEAR(sum.value.v[0], 0, 1e-14);
}

TEST(Statistics, OfWeightedSamplesAndOfNoSamples) {
  EXPECT_EQ(weighted_mean<double>({1, 3}, {2, 6}), 5);
  EXPECT_EQ(minimum<double>({0.3, 0.1, 0.2}), 0.1);
  EXPECT_EQ(weighted_mean<double>({}, {}), 0);
  EXPECT_EQ(minimum<double>({}), 0);
  EXPECT_EQ(soft_min<double>({}, {}, 100), 0);
}

TEST(Statistics, SoftMinimumIsAboveTheMinimumAndConvergesToIt) {
  const std::vector<double> weight = {0.5, 2, 1, 0.1}, field = {0.31, 0.3, 0.8, 0.55};
  double before = weighted_mean(weight, field);
  for (const double sharpness : {1.0, 10.0, 100.0, 1e3, 1e4, 1e5}) {
    const double soft = soft_min(weight, field, sharpness);
    EXPECT_GT(soft, 0.3);
    EXPECT_LT(soft, before);
    // Upper bound: the contribution of the minimum alone, 0.3 - ln(2/3.6) / sharpness; the other samples reduce it.
    EXPECT_LE(soft, 0.3 + std::log(3.6 / 2) / sharpness * (1 + 1e-12)) << sharpness;
    before = soft;
  }
  EXPECT_NEAR(before, 0.3, 1e-5);
  EXPECT_NEAR(soft_min<double>({1, 7}, {0.25, 0.25}, 50), 0.25, 1e-15);                      // all equal
  EXPECT_NEAR(soft_min<double>({1, 1}, {0.1, 1e6}, 200), 0.1 + std::log(2.0) / 200, 1e-15);  // no overflow
}

TEST(Statistics, SoftMinimumDerivativesEqualFiniteDifferences) {
  const std::vector<double> weight = {0.5, 2, 1, 0.1}, field = {0.31, 0.3, 0.32, 0.55};
  const double sharpness = 40;
  for (int i = 0; i < 4; ++i) {
    const auto at = static_cast<std::size_t>(i);
    std::vector<Dual4> w(weight.begin(), weight.end()), f(field.begin(), field.end());
    w[at].v[0] = 1;
    f[at].v[1] = 1;
    const Dual4 soft = soft_min(w, f, sharpness);
    EXPECT_EQ(soft.a, soft_min(weight, field, sharpness));
    constexpr double kStep = 1e-5;
    const auto difference = [&](std::vector<double> low_w, std::vector<double> low_f, double dw, double df) {
      auto high_w = low_w, high_f = low_f;
      low_w[at] -= dw, high_w[at] += dw, low_f[at] -= df, high_f[at] += df;
      return (soft_min(high_w, high_f, sharpness) - soft_min(low_w, low_f, sharpness)) / (2 * kStep);
    };
    EXPECT_NEAR(soft.v[0], difference(weight, field, kStep, 0), 1e-9);
    EXPECT_NEAR(soft.v[1], difference(weight, field, 0, kStep), 1e-7);
  }
}

}  // namespace
}  // namespace pkm::testing
