#include "engine/math/nonnegative_intervals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace pkm {
namespace {

using Function = std::function<double(double)>;

std::vector<ClosedInterval> intervals_of(const Function& f, double lipschitz, double lower, double upper,
                                         int* calls = nullptr) {
  std::vector<ClosedInterval> intervals = {{-1, -1}};  // must be discarded
  NonNegativeIntervals finder;
  const auto counted = [&](double x) {
    if (calls) ++*calls;
    return f(x);
  };
  finder.find(
      counted, [&](double, double) { return lipschitz; }, lower, upper, intervals);
  return intervals;
}

void expect_intervals(const std::vector<ClosedInterval>& found, const std::vector<ClosedInterval>& expected,
                      double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].lower, expected[i].lower, tolerance) << i;
    EXPECT_NEAR(found[i].upper, expected[i].upper, tolerance) << i;
  }
}

constexpr double kRoot = 1e-12;

TEST(NonNegativeIntervals, WholeIntervalOrEmpty) {
  expect_intervals(intervals_of([](double) { return 1; }, 0, 2, 5), {{2, 5}}, 0);
  expect_intervals(intervals_of([](double) { return 0; }, 0, 2, 5), {{2, 5}}, 0);
  expect_intervals(intervals_of([](double) { return -1; }, 0, 2, 5), {}, 0);
  expect_intervals(intervals_of([](double) { return 1; }, 0, 5, 2), {}, 0);
  expect_intervals(intervals_of([](double) { return 1; }, 0, 2, 2), {}, 0);
  int calls = 0;
  intervals_of([](double x) { return 10 + x; }, 1, 0, 1, &calls);
  EXPECT_EQ(calls, 2) << "the Lipschitz constant decides immediately";
  calls = 0;
  intervals_of([](double x) { return x - 10; }, 1, 0, 1, &calls);
  EXPECT_EQ(calls, 2);
}

TEST(NonNegativeIntervals, EndpointsAreRoots) {
  expect_intervals(intervals_of([](double x) { return std::sin(x); }, 1, 1, 10),
                   {{1, std::numbers::pi}, {2 * std::numbers::pi, 3 * std::numbers::pi}}, 10 * kRoot);
  expect_intervals(intervals_of([](double x) { return x - 0.3; }, 1, 0, 1), {{0.3, 1}}, kRoot);
  expect_intervals(intervals_of([](double x) { return 0.3 - x; }, 1, 0, 1), {{0, 0.3}}, kRoot);
  expect_intervals(intervals_of([](double x) { return std::fabs(x - 0.5) - 0.2; }, 1, 0, 1), {{0, 0.3}, {0.7, 1}},
                   kRoot);
}

TEST(NonNegativeIntervals, NarrowComponentsAndGapsAreFound) {
  for (const double half : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5})
    for (const double centre : {0.123456, 0.5, 0.77}) {
      const auto peak = [&](double x) { return half - std::fabs(x - centre); };
      expect_intervals(intervals_of(peak, 1, 0, 1), {{centre - half, centre + half}}, kRoot);
      expect_intervals(intervals_of([&](double x) { return -peak(x); }, 1, 0, 1),
                       {{0, centre - half}, {centre + half, 1}}, kRoot);
      const auto hill = [&](double x) { return half * half - (x - centre) * (x - centre); };
      expect_intervals(intervals_of(hill, 2, 0, 1), {{centre - half, centre + half}}, 1e-9);
      // likewise without a Lipschitz constant
      expect_intervals(intervals_of(peak, std::numeric_limits<double>::infinity(), 0, 1),
                       {{centre - half, centre + half}}, kRoot);
    }
}

TEST(NonNegativeIntervals, PeaksNearTheEndpointsAreFound) {
  for (const double centre : {0.001, 0.02, 0.98, 0.9995}) {
    const auto peak = [&](double x) { return 1e-4 - std::fabs(x - centre); };
    expect_intervals(intervals_of(peak, 1, 0, 1), {{centre - 1e-4, centre + 1e-4}}, kRoot);
  }
}

TEST(NonNegativeIntervals, ALowerBoundIsSufficientWherePositive) {
  // The actual function is 0.3 - x; far from its root, only a weak lower bound of it is given.
  const auto bound = [](double x) { return x < 0.2 ? 1e-3 : 0.3 - x; };
  expect_intervals(intervals_of(bound, 1, 0, 1), {{0, 0.3}}, kRoot);
}

TEST(NonNegativeIntervals, NeedsFewEvaluationsFarFromZero) {
  int calls = 0;
  intervals_of([](double x) { return 0.2 + 0.1 * std::sin(20 * x); }, 2, 0, 1, &calls);
  EXPECT_LE(calls, 40);
}

}  // namespace
}  // namespace pkm
