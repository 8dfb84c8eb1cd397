// Critical values are located by extrapolation in far fewer steps than by bisection; if nothing vanishes, a few more
// are needed.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/generic/columns/critical_value_solver.hpp"

namespace pkm::generic {
namespace {

constexpr double kCriticalValue = 0.3217, kBracketWidth = 1e-15;
const auto nowhere = [](const BoundaryFeature&, const BoundaryFeature&) {
  return std::numeric_limits<double>::infinity();
};

struct Bracketing {
  double low = 0.3, high = 0.35;
  int steps = 0;

  /// @param see  (at, whether it is above the critical value)
  template <class See>
  void run(CriticalValueSolver& solver, const See& add_sample) {
    while (high - low > kBracketWidth && steps < 1000) {
      const double at = solver.next_sample(low, high, kBracketWidth);
      ASSERT_GE(at, low);
      ASSERT_LE(at, high);
      if (at <= low || at >= high) break;
      ++steps;
      const bool is_upper = at > kCriticalValue;
      add_sample(at, is_upper);
      (is_upper ? high : low) = at;
    }
    EXPECT_NEAR(low, kCriticalValue, 2 * kBracketWidth);
    EXPECT_NEAR(high, kCriticalValue, 2 * kBracketWidth);
  }
};

constexpr int kHalvings = 46;  // of 0.05 to 1e-15

/// Two vertices of different surfaces merge linearly, those of one surface like a square root.
TEST(CriticalValueSolver, FollowsAnArcThatVanishes) {
  for (const bool is_root : {false, true})
    for (const bool is_above : {false, true}) {
      SCOPED_TRACE(testing::Message() << is_root << is_above);
      CriticalValueSolver solver;
      solver.reset(false);
      Bracketing closing;
      closing.run(solver, [&](double at, bool is_upper) {
        BoundaryFeatures features = {{.key = 9, .of = 9, .t = at}};
        if (is_upper == is_above) {
          const double distance = std::fabs(at - kCriticalValue), size = distance * (1 + 3 * distance);
          const double half = is_root ? std::sqrt(size) : size;
          features.push_back({.key = 1, .of = 1, .t = 0.5 - half, .s = 0.1});
          features.push_back({.key = is_root ? 1U : 2U, .of = is_root ? 1U : 2U, .t = 0.5 + half, .s = 0.1});
        }
        solver.add_sample(at, is_upper, 1 + (is_upper ? 1U : 0U), features, nowhere);
      });
      EXPECT_LT(closing.steps, kHalvings / 2);
    }
}

/// An interval between two critical values that vanishes linearly or like a square root.
TEST(CriticalValueSolver, FindsWhetherAnIntervalVanishesLikeARoot) {
  for (const bool is_root : {false, true}) {
    CriticalValueSolver solver;
    solver.reset(false);
    Bracketing closing;
    closing.run(solver, [&](double at, bool is_upper) {
      BoundaryFeatures features;
      if (!is_upper) {
        const double distance = kCriticalValue - at, width = is_root ? std::sqrt(distance) : distance;
        features = {{.key = 4, .of = 0, .t = 0.2}, {.key = 5, .of = 1, .t = 0.2 + width * (1 + width)}};
      }
      solver.add_sample(at, is_upper, is_upper ? 0 : 1, features, nowhere);
    });
    EXPECT_LT(closing.steps, kHalvings * 2 / 3);
  }
}

/// One vertex replaces another where a third surface passes through both: its distance from that surface vanishes.
TEST(CriticalValueSolver, FollowsACornerToTheSurfaceThatCutsIt) {
  CriticalValueSolver solver;
  solver.reset(false);
  Bracketing closing;
  closing.run(solver, [&](double at, bool is_upper) {
    const std::uint64_t key = is_upper ? 2 : 1;
    const BoundaryFeatures features = {{.key = key, .of = key, .t = 0.4, .s = 0.2}};
    solver.add_sample(at, is_upper, key, features, [&](const BoundaryFeature&, const BoundaryFeature&) {
      return std::sin(std::fabs(at - kCriticalValue));
    });
  });
  EXPECT_LT(closing.steps, kHalvings / 2);
}

/// Endpoints of columns persist beyond the point at which they coincide: their distance changes its sign.
TEST(CriticalValueSolver, FollowsEndsThatPassEachOther) {
  CriticalValueSolver solver;
  solver.reset(true);
  Bracketing closing;
  const auto add_sample = [&](double at, bool is_upper) {
    const double d = at - kCriticalValue;
    const BoundaryFeatures features = {{.key = 2, .of = 1, .t = 0.7, .bounds = !is_upper},
                                       {.key = 4, .of = 2, .t = 0.7 + std::sin(d) + 2 * d * d, .bounds = is_upper}};
    solver.add_sample(at, is_upper, is_upper ? 2 : 1, features, nowhere);
  };
  add_sample(closing.low, false);
  add_sample(closing.high, true);
  closing.run(solver, add_sample);
  EXPECT_LT(closing.steps, kHalvings / 3);
}

TEST(CriticalValueSolver, FollowsAConditionThatChangesItsSign) {
  CriticalValueSolver solver;
  solver.reset(false);
  Bracketing closing;
  closing.run(solver, [&](double at, bool is_upper) {
    solver.add_size(at, is_upper, std::exp(kCriticalValue) - std::exp(at));
  });
  EXPECT_LT(closing.steps, kHalvings / 3);
}

/// Features that do not vanish at the critical value, and misleading ones.
TEST(CriticalValueSolver, HalvesWhereNothingVanishes) {
  for (const double slope : {0.0, 1.0, -1.0}) {
    CriticalValueSolver solver;
    solver.reset(false);
    Bracketing closing;
    closing.run(solver, [&](double at, bool is_upper) {
      const std::uint64_t key = is_upper ? 10 : 0;
      const BoundaryFeatures features = {{.key = key + 1, .of = key + 1, .t = 0.1},
                                         {.key = key + 2, .of = key + 2, .t = 0.9 + slope * (at - kCriticalValue)}};
      solver.add_sample(at, is_upper, key + 1, features, nowhere);
    });
    EXPECT_LT(closing.steps, kHalvings * 3 / 2);
  }
}

/// Close to the critical value, rounding produces other types: earlier extrapolations remain valid.
TEST(CriticalValueSolver, KeepsItsGuessWhereStructuresFlicker) {
  CriticalValueSolver solver;
  solver.reset(false);
  Bracketing closing;
  closing.run(solver, [&](double at, bool is_upper) {
    const double distance = std::fabs(at - kCriticalValue);
    BoundaryFeatures features;
    if (is_upper && distance > 1e-12)
      features = {{.key = 1, .of = 1, .t = 0.5}, {.key = 2, .of = 2, .t = 0.5 + distance * (1 + distance)}};
    solver.add_sample(at, is_upper, !is_upper ? 1 : distance > 1e-12 ? 2 : 3, features, nowhere);
  });
  EXPECT_LT(closing.steps, kHalvings * 2 / 3);
}

}  // namespace
}  // namespace pkm::generic
