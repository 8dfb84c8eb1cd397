// Formulas of time: first and second derivatives against finite differences, values against double.
#include "engine/math/taylor.hpp"

#include <gtest/gtest.h>

#include "engine/expression/formula.hpp"

namespace pkm {
namespace {

Taylor at(const Formula& formula, double t) {
  const Taylor variable = Taylor::variable(t);
  return formula.value(std::span<const Taylor>(&variable, 1));
}
double plain(const Formula& formula, double t) { return formula.value(std::span<const double>(&t, 1)); }

const std::vector<std::string>& texts() {
  static const std::vector<std::string> list = {
      "0.3 - 0.010*t",
      "0.2 + 0.05*sin(2*pi*t)*cos(t)",
      "t^3 - 2*t^2 + 1/t",
      "t^-2",
      "t^t",
      "2^t + t^2.5",
      "t^(2 + 0*t)",
      "exp(-t)*log(1 + t)",
      "sqrt(1 + t^2)/(2 + sin(t))",
      "asin(t/3) + acos(t/4)",
      "atan(t) + atan2(t, 2 - t)",
      "atan2(sin(t), cos(t))",
      "sinh(t/4) + cosh(t) - tanh(t) + sinh(2*t)",
      "log10(t) + tan(t/3)",
      "abs(1 - 3*t) + max(t, t^2) + min(t, 2)",
      "t < 1 ? t^4 : 4*t - 3",
      "-t",
      "sign(t)*t",
      "5",
  };
  return list;
}

TEST(Taylor, DerivativesOfFormulasEqualFiniteDifferences) {
  for (const std::string& text : texts()) {
    const Formula formula(text, {"t"});
    for (const double t : {0.21, 0.5, 0.83, 1.4}) {
      SCOPED_TRACE(text + " at " + std::to_string(t));
      // Sixth-order finite differences with h = 0.005: truncation error of about h^6, rounding error of about
      // 1e-16/h^2.
      const auto f = [&](double k) { return plain(formula, t + 0.005 * k); };
      const double first = (45 * (f(1) - f(-1)) - 9 * (f(2) - f(-2)) + (f(3) - f(-3))) / (60 * 0.005);
      const double second =
          (270 * (f(1) + f(-1)) - 27 * (f(2) + f(-2)) + 2 * (f(3) + f(-3)) - 490 * f(0)) / (180 * 0.005 * 0.005);
      const Taylor found = at(formula, t);
      EXPECT_EQ(found.a, f(0));
      EXPECT_NEAR(found.d, first, 1e-7 * (1 + std::fabs(first)));
      EXPECT_NEAR(found.dd, second, 1e-5 * (1 + std::fabs(second)));
    }
  }
}

/// Derivatives against closed forms.
TEST(Taylor, DerivativesAreExact) {
  const double t = 0.7, s = portable::sin(3 * t), c = portable::cos(3 * t);
  const auto expect = [&](const std::string& text, double d, double dd) {
    const Taylor found = at(Formula(text, {"t"}), t);
    EXPECT_NEAR(found.d, d, 1e-14 * (1 + std::fabs(d))) << text;
    EXPECT_NEAR(found.dd, dd, 1e-14 * (1 + std::fabs(dd))) << text;
  };
  expect("sin(3*t)", 3 * c, -9 * s);
  expect("t^5", 5 * std::pow(t, 4), 20 * std::pow(t, 3));
  expect("1/t", -1 / (t * t), 2 / (t * t * t));
  expect("sqrt(t)", 0.5 / std::sqrt(t), -0.25 / (t * std::sqrt(t)));
  expect("log(t)", 1 / t, -1 / (t * t));
  expect("atan2(sin(3*t), cos(3*t))", 3, 0);
  expect("asin(sin(t))", 1, 0);
  expect("acos(cos(t))", 1, 0);
  expect("exp(2*log(t))", 2 * t, 2);
  expect("2^t", std::pow(2, t) * std::log(2.0), std::pow(2, t) * std::log(2.0) * std::log(2.0));
  expect("t^t", std::pow(t, t) * (1 + std::log(t)), std::pow(t, t) * ((1 + std::log(t)) * (1 + std::log(t)) + 1 / t));
}

/// A varying exponent whose value is an integer at this time.
TEST(Taylor, VaryingExponentsWithIntegerValue) {
  const Taylor found = at(Formula("3^(2*t)", {"t"}), 1.0);
  const double rate = 2 * std::log(3.0);
  EXPECT_EQ(found.a, 9);
  EXPECT_NEAR(found.d, 9 * rate, 1e-13);
  EXPECT_NEAR(found.dd, 9 * rate * rate, 1e-12);
}

}  // namespace
}  // namespace pkm
