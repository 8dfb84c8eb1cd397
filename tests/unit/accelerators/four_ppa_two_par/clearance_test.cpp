// Clearance of 4PPa-2PaR: distances known by hand, and the accelerator's bounds and tests, which replace the minimum
// over all pairs of links.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/clear_volume.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/clear_designs.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/plain_pose.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

PoseReport report(const std::vector<double>& p, const SchoenfliesPose<double>& pose, const LimitSpec& limits,
                  const std::string& mode = "lower,lower") {
  return four_ppa().inspect(p, pose, mode, limits);
}

double clearance_at(const std::vector<double>& p, const SchoenfliesPose<double>& pose,
                    const std::string& mode = "lower,lower") {
  return named(report(p, pose, no_limits_of_four_ppa(), mode).angles, "clearance");
}

/// The pose in the middle at theta = 0 at which both limbs have this half spacing of sliders.
SchoenfliesPose<double> middle_pose(const std::vector<double>& p, double h) {
  const double x = (p[kB] - p[kA]) / 2;
  return {p[kB] / 2, p[kL0] / 2, -std::sqrt(p[kLu] * p[kLu] - h * h) - std::sqrt(p[kLd] * p[kLd] - x * x) - p[kD], 0};
}

TEST(FourPpaClearance, SlidersOfOneRail) {
  const auto p = nominal();
  for (const double gap : {0.005, 0.01, 0.03}) {  // 2 h - 2 d_0 - d_u
    const auto pose = middle_pose(p, p[kD0] + p[kDu] / 2 + gap / 2);
    EXPECT_NEAR(clearance_at(p, pose), gap, kRoundoff);
    const PoseReport r = report(p, pose, clearance(gap + 1e-9));
    EXPECT_FALSE(r.feasible);
    EXPECT_EQ(r.reason, "clearance_min is violated: slider 1 and slider 2 are too near");
    EXPECT_EQ(r.margins.back().first, "clearance_min");
    EXPECT_NEAR(r.margins.back().second, -1e-9, kRoundoff);
    EXPECT_TRUE(report(p, pose, clearance(gap - 1e-9)).feasible);
  }
  EXPECT_NEAR(clearance_at(p, middle_pose(p, p[kD0] + p[kDu] / 2 - 0.005)), -0.01, kRoundoff);
  EXPECT_EQ(report(p, middle_pose(p, p[kD0] + p[kDu] / 2 - 0.005), clearance(0)).reason,
            "clearance_min is violated: slider 1 and slider 2 overlap");
  // Sliders thicker than long are balls.
  EXPECT_NEAR(clearance_at(with({{kRs, 0.1}}), middle_pose(p, 0.105)), 0.01, kRoundoff);
}

TEST(FourPpaClearance, WithoutALimitThereIsNoMargin) {
  const PoseReport r = report(nominal(), middle_pose(nominal(), 0.01), no_limits_of_four_ppa());
  EXPECT_TRUE(r.feasible);
  for (const auto& margin : r.margins) EXPECT_NE(margin.first, "clearance_min");
}

TEST(FourPpaClearance, PairsWhoseDistanceIsTheSameAtEveryPose) {
  const SchoenfliesPose<double> pose{0.37, 1.25, -0.9, 0.4};
  // lower bars over the platform: d - d_d - R_d - R_p
  EXPECT_NEAR(clearance_at(nominal(), pose), 0.15 - 0.08 - 0.01 - 0.02, kRoundoff);
  EXPECT_THAT(report(nominal(), pose, clearance(0.05)).reason,
              AllOf(HasSubstr("lower bar 2 of limb"), HasSubstr("and platform are too near")));
  // ends of the lower bars: a - 2 R_d
  EXPECT_NEAR(clearance_at(with({{kRd, 0.07}, {kD, 0.3}}), {0.37, 1.25, -1, 0.4}), 0.2 - 2 * 0.07, kRoundoff);
  EXPECT_THAT(report(with({{kRd, 0.12}, {kD, 0.5}}), {0.37, 1.25, -1.3, 0.4}, clearance(0)).reason,
              HasSubstr("limb 1 and lower"));
}

TEST(FourPpaClearance, BetweenTheRails) {
  // Upper connectors lie side by side at theta = 0, as far apart as the rails.
  EXPECT_NEAR(clearance_at(with({{kRu, 0.39}, {kD, 0.5}}), middle_pose(with({{kD, 0.5}}), 0.3)), 0.8 - 2 * 0.39,
              kRoundoff);
  // Sliders facing each other.
  const auto near = with({{kRs, 0.07}, {kB, 0.2}, {kD, 0.5}});
  EXPECT_NEAR(clearance_at(near, middle_pose(near, 0.3)), 0.2 - 2 * 0.07, kRoundoff);
  // Turned by 60 deg the limbs are a sin(60 deg) apart along the rails; the sliders are balls of 0.1 m.
  const auto p = with({{kA, 0.3}, {kB, 0.2}, {kD, 0.5}, {kRs, 0.1}, {kD0, 0.09}, {kDu, 0.02}});
  const double x_j = (p[kB] - p[kA] * 0.5) / 2, h = 0.3, apart = 0.3 * std::sqrt(0.75);
  const SchoenfliesPose<double> pose{0.1, 1.25, -std::sqrt(0.36 - h * h) - std::sqrt(0.55 * 0.55 - x_j * x_j) - 0.5,
                                     kPi / 3};
  EXPECT_NEAR(clearance_at(p, pose), std::hypot(0.2, apart) - 0.2, kRoundoff);
  const std::string broken = "clearance_min is violated: ";  // the two pairs differ by rounding alone
  EXPECT_THAT(report(p, pose, clearance(0.15)).reason,
              AnyOf(broken + "slider 1 and slider 3 are too near", broken + "slider 2 and slider 4 are too near"));
}

// A lower joint below the platform: the lower bar passes P_j at (d_d - d) sin(beta_j).
TEST(FourPpaClearance, LowerBarsBesideThePlatform) {
  const auto p = with({{kD, 0.05}, {kDd, 0.2}, {kRd, 0.001}, {kRp, 0.002}});
  const SchoenfliesPose<double> pose{0.3, 1.25, -0.8, 0.3};
  const NamedValues angles = report(p, pose, no_limits_of_four_ppa()).angles;
  const double sine = std::sin(std::fmin(named(angles, "beta_1"), named(angles, "beta_2")));
  EXPECT_NEAR(clearance_at(p, pose), std::fmin(0.15 * sine, 0.05) - 0.003, kRoundoff);
}

TEST(FourPpaClearance, MirroredPosesHaveEqualClearance) {
  Uniform uniform(2);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    auto p = nominal();
    p[kA] = uniform(0.05, 0.5);
    p[kB] = uniform(0.1, 1);
    p[kRs] = uniform(0, 0.2);
    p[kRu] = uniform(0, 0.3);
    p[kD] = uniform(0, 0.3);
    const SchoenfliesPose<double> pose{uniform(0, p[kB]), uniform(0, 2.5), uniform(-1.2, 0.2), uniform(-1.5, 1.5)};
    const bool first_lower = i & 1, second_lower = i & 2;
    const auto mode = [](bool one, bool two) {
      return std::string(one ? "lower" : "upper") + "," + (two ? "lower" : "upper");
    };
    if (!report(p, pose, no_limits_of_four_ppa(), mode(first_lower, second_lower)).assembles) continue;
    const double here = clearance_at(p, pose, mode(first_lower, second_lower));
    const SchoenfliesPose<double> in_y{pose.x, 2.5 - pose.y, pose.z, -pose.angle};
    const SchoenfliesPose<double> in_x{p[kB] - pose.x, pose.y, pose.z, -pose.angle};
    EXPECT_NEAR(clearance_at(p, in_y, mode(first_lower, second_lower)), here, kRoundoff);
    EXPECT_NEAR(clearance_at(p, in_x, mode(second_lower, first_lower)), here, kRoundoff);
    auto big = p;
    for (double& length : big) length *= 3;
    EXPECT_NEAR(clearance_at(big, {3 * pose.x, 3 * pose.y, 3 * pose.z, pose.angle}, mode(first_lower, second_lower)),
                3 * here, 3 * kRoundoff);
    ++compared;
  }
  EXPECT_GT(compared, 250);
}

struct Sampled {
  double x, z, s, c;
};

Sampled random_sample(const Geometry<double>& g, Uniform& uniform) {
  const auto [s, c] = sincos(uniform(-kPi / 2, kPi / 2));
  return {uniform(0, g.b), uniform(-(g.l_u + g.l_d + g.d), -g.d), s, c};
}

TEST(FourPpaClearance, NoPoseIsNearerThanTheBoundsSay) {
  Uniform uniform(3);
  std::vector<double> tightest(kGroups * kGroups, 10.0);
  for (int i = 0; i < 400; ++i) {
    ClearanceCase c = random_clearance_case(uniform);
    for (const ParameterIndex radius : {kRu, kRs, kRd, kRp}) c.p[radius] = 0;
    const auto g = geometry(std::span<const double>(c.p));
    const auto l = limits(g, no_limits_of_four_ppa());
    for (int k = 0; k < 500; ++k) {
      const Sampled at = random_sample(g, uniform);
      if (!feasible(g, l, at.x, g.L0 / 2, at.z, at.s, at.c)) continue;
      const auto all = links(g, lower_placement(g, at.x, at.z, at.s, at.c));
      for (const GroupPair& pair : kPairs) {
        if (pair.first == pair.second) continue;
        double distance = 10;
        visit_links(pair, [&](std::size_t m, std::size_t n) {
          distance = std::fmin(distance, segment_distance(all[m].axis, all[n].axis));
        });
        const double bound = clearance_lower_bound(g, pair);
        ASSERT_GE(distance, bound - kRoundoff) << "groups " << pair.first << ", " << pair.second;
        double& best = tightest[static_cast<std::size_t>(pair.first * kGroups + pair.second)];
        best = std::fmin(best, distance - bound);
      }
    }
  }
  for (const GroupPair& pair : kPairs) {  // and no bound is far below the minimum over the poses
    if (pair.first == pair.second) continue;
    EXPECT_LT(tightest[static_cast<std::size_t>(pair.first * kGroups + pair.second)], 0.3)
        << "groups " << pair.first << ", " << pair.second;
  }
}

TEST(FourPpaClearance, TakenApartItSaysTheSameOfEveryPose) {
  Uniform uniform(4);
  int clear = 0, blocked = 0, tested = 0;
  for (int i = 0; i < 600; ++i) {
    const ClearanceCase c = i % 3 > 0
                                ? random_clearance_case(uniform)
                                : ClearanceCase{with(exotics()[i / 3 % 4].changes), exotics()[i / 3 % 4].min_clearance};
    const auto g = geometry(std::span<const double>(c.p));
    const auto free = limits(g, no_limits_of_four_ppa()), given = limits(g, clearance(c.min_clearance));
    auto folded = given;
    const auto test = reduce_clearance(g, folded);
    EXPECT_FALSE(folded.clearance_min);
    tested += test.has_value();
    for (int k = 0; k < 200; ++k) {
      const Sampled at = random_sample(g, uniform);
      if (!feasible(g, free, at.x, g.L0 / 2, at.z, at.s, at.c)) continue;
      const auto p = lower_placement(g, at.x, at.z, at.s, at.c);
      const double margin = nearest_links(links(g, p)).clearance - c.min_clearance;
      if (std::fabs(margin) < kRoundoff) continue;
      const bool plain = feasible(g, given, at.x, g.L0 / 2, at.z, at.s, at.c);
      EXPECT_EQ(plain, margin >= 0);
      const bool base = feasible(g, folded, at.x, g.L0 / 2, at.z, at.s, at.c);
      ASSERT_EQ(base && (!test || test->excess(p) >= 0), plain) << "design " << i << ", pose " << k;
      if (test && base && !plain) {
        EXPECT_NEAR(test->excess(p), margin, kRoundoff);
      }
      ++(plain ? clear : blocked);
    }
  }
  EXPECT_GT(clear, 2000);
  EXPECT_GT(blocked, 2000);
  EXPECT_GT(tested, 150);
}

TEST(FourPpaClearance, UsualProportionsLeaveNothingToTest) {
  for (const double min_clearance : {0.0, 0.01, 0.03}) {
    const auto p = nominal();
    const auto g = geometry(std::span<const double>(p));
    auto l = limits(g, clearance(min_clearance));
    EXPECT_FALSE(reduce_clearance(g, l));
    EXPECT_EQ(l.h_min, 0.07 + min_clearance / 2);
  }
}

}  // namespace
}  // namespace pkm::testing
