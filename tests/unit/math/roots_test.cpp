// Root finding: accuracy, order of convergence and number of evaluations, also for multiple roots, discontinuities,
// undefined values, roots at endpoints and wide exponents.
#include "engine/math/roots.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/math/uniform.hpp"

namespace pkm {
namespace {

using Function = std::function<double(double)>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kLargest = std::numeric_limits<double>::max();

/// Refines the root in [a, b]. @param points  receives the points at which f was evaluated, without a and b
double root(const Function& f, double a, double b, double width, std::vector<double>& points) {
  points.clear();
  const auto recorded = [&](double x) {
    EXPECT_TRUE((x > a && x < b) || (x > b && x < a)) << x << " is outside the bracket";
    points.push_back(x);
    return f(x);
  };
  return refine_root(recorded, a, f(a), b, f(b), width);
}

/// Number of evaluations of the Illinois algorithm with a bisection wherever three steps have not halved the bracket,
/// which refine_root() has replaced.
int evaluations_by_illinois(const Function& f, double a, double b, double width) {
  double at_a = f(a), at_b = f(b), before = std::fabs(b - a);
  int last_replaced = 0, calls = 0;
  for (int step = 1; std::fabs(b - a) > width; ++step) {
    double x = b - at_b * (b - a) / (at_b - at_a);
    if (!((x > a && x < b) || (x > b && x < a))) x = 0.5 * (a + b);
    if (step % 3 == 0) {
      if (std::fabs(b - a) > 0.5 * before) x = 0.5 * (a + b);
      before = std::fabs(b - a);
    }
    if (x == a || x == b) break;
    const double here = f(x);
    ++calls;
    if ((here >= 0) == (at_a >= 0)) {
      a = x;
      at_a = here;
      if (last_replaced == -1) at_b *= 0.5;
      last_replaced = -1;
    } else {
      b = x;
      at_b = here;
      if (last_replaced == 1) at_a *= 0.5;
      last_replaced = 1;
    }
  }
  return calls;
}

struct Case {
  const char* name;
  std::function<double(double, double)> f;  ///< f(x, r) increases, and has the root r
  std::size_t max_evaluations;              ///< for the bracket [0, 1]
  double by_illinois;                       ///< maximum ratio of the evaluations to those of the Illinois algorithm
};

constexpr std::size_t kBisections = 51;  // from the width 1 to 1e-15, and one secant step

const Case kSmooth[] = {
    {"line", [](double x, double r) { return x - r; }, 3, 0.2},
    {"parabola", [](double x, double r) { return (x - r) * (x + r); }, 13, 0.6},
    {"sine", [](double x, double r) { return std::sin(x - r); }, 7, 0.3},
    {"square root", [](double x, double r) { return std::sqrt(x) - std::sqrt(r); }, 7, 0.2},
    {"hyperbola", [](double x, double r) { return 1 / r - 1 / x; }, 13, 0.4},
    {"exponential", [](double x, double r) { return std::exp(8 * x) - std::exp(8 * r); }, 12, 0.6},
    {"sigmoid", [](double x, double r) { return std::tanh(30 * (x - r)); }, 13, 0.5},
};
const Case kDifficult[] = {
    {"kink", [](double x, double r) { return x < r ? x - r : 5 * (x - r); }, 2 * kBisections, 1.2},
    {"cubic root", [](double x, double r) { return std::cbrt(x - r); }, kBisections, 1.3},
    {"triple root", [](double x, double r) { return (x - r) * (x - r) * (x - r); }, 2 * kBisections, 0.3},
    {"ninefold root", [](double x, double r) { return std::pow(x - r, 9); }, 2 * kBisections, 0.3},
    {"jump", [](double x, double r) { return x < r ? -7 : 1; }, kBisections, 0.8},
    {"uneven jump", [](double x, double r) { return x < r ? -1e-9 : x + 100; }, kBisections, 0.4},
    {"jump from NaN", [](double x, double r) { return x < r ? kNaN : x; }, kBisections, 1.1},
    {"jump from -infinity", [](double x, double r) { return x < r ? -kInf : x; }, kBisections, 1.1},
    {"jump to infinity", [](double x, double r) { return x < r ? -1 : kInf; }, kBisections, 1.1},
    {"jump between the largest numbers", [](double x, double r) { return x < r ? -kLargest : kLargest; }, kBisections,
     1.1},
};

void expect_roots(std::span<const Case> cases) {
  testing::Uniform random(1);
  std::vector<double> points;
  for (const Case& each : cases) {
    double sum = 0, sum_by_illinois = 0;
    for (int i = 0; i < 200; ++i) {
      const double r = random(0.05, 0.95);
      const auto f = [&](double x) { return each.f(x, r); };
      EXPECT_NEAR(root(f, 0, 1, 1e-15, points), r, 1e-15) << each.name;
      EXPECT_LE(points.size(), each.max_evaluations) << each.name << ' ' << r;
      EXPECT_NEAR(root(f, 1, 0, 1e-15, points), r, 1e-15) << each.name << ", from above";
      EXPECT_LE(points.size(), each.max_evaluations) << each.name << ", from above, " << r;
      sum += static_cast<double>(points.size());
      sum_by_illinois += evaluations_by_illinois(f, 1, 0, 1e-15);
    }
    EXPECT_LE(sum, each.by_illinois * sum_by_illinois) << each.name;
  }
}

TEST(RefineRoot, FindsRootsOfSmoothFunctions) { expect_roots(kSmooth); }
TEST(RefineRoot, FindsMultipleRootsAndDiscontinuities) { expect_roots(kDifficult); }

TEST(RefineRoot, ConvergesSuperlinearly) {
  // Inverse quadratic interpolation has the order 1.84. The width of the bracket is squared by about one further step.
  testing::Uniform random(2);
  std::vector<double> points;
  for (const Case& each : kSmooth)
    for (int i = 0; i < 50; ++i) {
      const double r = random(0.05, 0.95), a = 0.9 * r, b = 1.1 * r;
      const auto f = [&](double x) { return each.f(x, r); };
      root(f, a, b, 1e-7, points);
      const std::size_t half = points.size();
      root(f, a, b, 1e-14, points);
      EXPECT_LE(points.size(), half + 2) << each.name << ' ' << r;
      EXPECT_LE(points.size(), 8) << each.name << ' ' << r;
    }
}

TEST(RefineRoot, EndsAtTheGivenWidth) {
  std::vector<double> points;
  const Function f = [](double x) { return std::tanh(30 * (x - 0.3)); };
  EXPECT_NEAR(root(f, 0, 1, 1e-2, points), 0.3, 5e-3);
  EXPECT_LE(points.size(), 8);
  EXPECT_EQ(root(f, 0, 1, 2, points), 0.5);
  EXPECT_TRUE(points.empty());
  EXPECT_NEAR(root([](double x) { return x - 1e6 - 0.3; }, 0, 1e7, 0, points), 1e6 + 0.3, 3e-10) << "adjacent doubles";
  EXPECT_LE(points.size(), 6);
}

TEST(RefineRoot, ZeroCountsAsPositive) {
  std::vector<double> points;
  EXPECT_NEAR(root([](double x) { return x < 0.3 ? -1 : 0; }, 0, 1, 1e-14, points), 0.3, 1e-14);
  EXPECT_NEAR(root([](double x) { return x < 0.3 ? 0 : -1; }, 0, 1, 1e-14, points), 0.3, 1e-14);
}

TEST(RefineRoot, FindsRootsAtEndpoints) {
  std::vector<double> points;
  const Function falling = [](double x) { return -x * (x + 1); }, rising = [](double x) { return x * (x + 1); };
  EXPECT_NEAR(root(falling, 0, 1, 1e-15, points), 0, 1e-15);
  EXPECT_LE(points.size(), 2);
  EXPECT_NEAR(root(falling, 1, 0, 1e-15, points), 0, 1e-15);
  EXPECT_LE(points.size(), 2);
  EXPECT_NEAR(root(rising, -0.5, 0, 1e-15, points), 0, 1e-15);
  EXPECT_LE(points.size(), 2);
  EXPECT_NEAR(root(rising, 0, -0.5, 1e-15, points), 0, 1e-15);
  EXPECT_LE(points.size(), 2);
  const Function jump = [](double x) { return x > 0 ? 1 : -1; };
  EXPECT_NEAR(root(jump, 0, 1, 1e-15, points), 0, 1e-15);
  EXPECT_LE(points.size(), kBisections);
}

TEST(RefineRoot, IsInvariantUnderScaling) {
  std::vector<double> plain, points;
  const Function f = [](double x) { return std::exp(3 * x) - 2; };
  const double r = root(f, 0, 1, 0x1p-50, plain);
  for (const double scale : {0x1p-900, 0x1p900}) {
    EXPECT_EQ(root([&](double x) { return scale * f(x); }, 0, 1, 0x1p-50, points), r) << "values times " << scale;
    EXPECT_EQ(points, plain);
    EXPECT_EQ(root([&](double x) { return f(x / scale); }, 0, scale, 0x1p-50 * scale, points), r * scale)
        << "arguments times " << scale;
    EXPECT_EQ(points.size(), plain.size());
  }
}

TEST(RefineRoot, FindsRootsOverWideExponents) {
  std::vector<double> points;
  for (const double r : {1e-310, 1e-300, 1e-200, 1e-10, 1.0, 1e10, 1e200, 1e300}) {
    const double ulp = std::nextafter(r, kLargest) - r;
    EXPECT_NEAR(root([&](double x) { return std::log(x / r); }, 1e-320, 1e305, 0, points), r, 4 * ulp);
    EXPECT_LE(points.size(), 2500) << r;
    EXPECT_NEAR(root([&](double x) { return x < r ? -1 : 1; }, -8e307, 8e307, 0, points), r, ulp);
    EXPECT_LE(points.size(), 2200) << "bisections from 1e308 to 1e-323, " << r;
  }
}

/// Newton's method to rounding accuracy. @param points  receives the points at which f was evaluated
template <class F>
double newton(const F& f, double low, double high, bool positive_at_low, std::vector<double>& points) {
  points.clear();
  const auto recorded = [&](double x) {
    EXPECT_GT(x, low);
    EXPECT_LT(x, high);
    points.push_back(x);
    return f(x);
  };
  return refine_root_newton(
      recorded, low, high, positive_at_low, 0.5 * (low + high),
      [](const ValueAndDerivative&, double x, double next) { return std::fabs(next - x) <= 1e-15; });
}

TEST(RefineRootNewton, ConvergesQuadratically) {
  testing::Uniform random(2);
  std::vector<double> points;
  for (int i = 0; i < 200; ++i) {
    const double r = random(0.05, 0.95);
    const auto cubic = [&](double x) { return ValueAndDerivative{x * x * x - r * r * r, 3 * x * x}; };
    EXPECT_NEAR(newton(cubic, 0, 1, false, points), r, 1e-15);
    EXPECT_LE(points.size(), 12) << r;
    for (std::size_t k = 1; k < points.size(); ++k) {  // the error is multiplied by itself and f''/(2 f') = 1/r
      const double error = std::fabs(points[k - 1] - r);
      if (error > 0.1 * r) continue;
      EXPECT_LE(std::fabs(points[k] - r), 1.2 / r * error * error + 1e-15) << r;
    }
    const auto falling = [&](double x) { return ValueAndDerivative{std::cos(x) - std::cos(r), -std::sin(x)}; };
    EXPECT_NEAR(newton(falling, 0, 1, true, points), r, 1e-14);
    EXPECT_LE(points.size(), 9) << r;
  }
}

TEST(RefineRootNewton, StaysInTheBracket) {
  std::vector<double> points;
  // without a bracket, Newton's method for atan diverges from |x| > 1.39
  const auto arctangent = [](double x) { return ValueAndDerivative{std::atan(x), 1 / (1 + x * x)}; };
  EXPECT_NEAR(newton(arctangent, -5, 80, false, points), 0, 1e-15);
  EXPECT_LE(points.size(), 15);
  // the step from an extremum is infinite, that from a vertical tangent is 0
  const auto parabola = [](double x) { return ValueAndDerivative{x * x - 0.49, 2 * x}; };
  EXPECT_NEAR(newton(parabola, -1, 1, true, points), -0.7, 1e-15);
  const auto square_root = [](double x) {
    return ValueAndDerivative{std::copysign(std::sqrt(std::fabs(x)), x) + 0.4, 0.5 / std::sqrt(std::fabs(x))};
  };
  EXPECT_NEAR(newton(square_root, -1, 1, false, points), -0.16, 1e-15);
}

TEST(RefineRootNewton, BisectsIfConvergenceIsSlow) {
  std::vector<double> points;
  for (const int multiplicity : {3, 9, 15}) {
    const auto power = [&](double x) {
      return ValueAndDerivative{std::pow(x - 0.3, multiplicity), multiplicity * std::pow(x - 0.3, multiplicity - 1)};
    };
    EXPECT_NEAR(newton(power, 0, 1, false, points), 0.3, 1e-14) << multiplicity;
    EXPECT_LE(points.size(), 120) << multiplicity;
  }
}

TEST(RefineRootNewton, FindsDiscontinuitiesAndRootsAtEndpoints) {
  std::vector<double> points;
  const auto undefined = [&](double x) { return ValueAndDerivative{x < 0.3 ? kNaN : x, x < 0.3 ? kNaN : 1}; };
  EXPECT_NEAR(newton(undefined, 0, 1, false, points), 0.3, 1e-15);
  const auto infinite = [&](double x) { return ValueAndDerivative{x < 0.3 ? kInf : x, x < 0.3 ? kInf : 1}; };
  EXPECT_NEAR(newton(infinite, 0, 1, false, points), 0.3, 1e-15);
  const auto jump = [&](double x) { return ValueAndDerivative{x < 0.3 ? -7.0 : 1.0, 0}; };
  EXPECT_NEAR(newton(jump, 0, 1, false, points), 0.3, 1e-15);
  EXPECT_LE(points.size(), 55);
  const auto line = [&](double x) { return ValueAndDerivative{-x, -1}; };
  EXPECT_NEAR(newton(line, 0, 1, true, points), 0, 1e-15);
  EXPECT_LE(points.size(), 55);
}

TEST(IterateNewton, EndsIfItConvergesOrLeavesTheInterval) {
  const auto is_small = [](double, double step) { return std::fabs(step) < 1e-12; };
  int calls = 0;
  const auto square_root_of_2 = [&](double x) { return ++calls, -(x * x - 2) / (2 * x); };
  const NewtonResult found = iterate_newton(square_root_of_2, 1, 0, kInf, 10, is_small);
  EXPECT_TRUE(found.has_converged);
  EXPECT_NEAR(found.x, std::sqrt(2), 1e-15);
  EXPECT_LE(calls, 6);
  EXPECT_FALSE(iterate_newton(square_root_of_2, 1, 0, kInf, 3, is_small).has_converged);
  EXPECT_FALSE(iterate_newton(square_root_of_2, 1, 0, 1.3, 10, is_small).has_converged);
  EXPECT_FALSE(iterate_newton([](double) { return kNaN; }, 1, 0, 2, 10, is_small).has_converged);
}

TEST(Bisect, NarrowsTheBracketOfAProperty) {
  int calls = 0;
  const auto is_below = [&](double x) { return ++calls, x * x < 2; };
  const Bracket found = bisect(is_below, {.with = 0, .without = 2}, 1e-9);
  EXPECT_LT(found.with, std::sqrt(2));
  EXPECT_GT(found.without, std::sqrt(2));
  EXPECT_LE(found.without - found.with, 1e-9);
  EXPECT_EQ(calls, 31);  // 2/2^31 < 1e-9 < 2/2^30
  const Bracket exact = bisect([](double x) { return x > 0.1; }, {.with = 1, .without = 0}, 0);
  EXPECT_EQ(std::nextafter(exact.without, 1), exact.with) << "adjacent doubles";
  EXPECT_EQ(exact.without, 0.1);
}

TEST(Bisect, EndsWhereThePropertyIsUnknown) {
  const auto is_above = [](double x) { return std::fabs(x - 0.3) < 0.1 ? std::nullopt : std::optional(x > 0.3); };
  const Bracket found = bisect(is_above, {.with = 1, .without = 0}, 0);
  EXPECT_EQ(found.with, 0.5);
  EXPECT_EQ(found.without, 0);
}

}  // namespace
}  // namespace pkm
