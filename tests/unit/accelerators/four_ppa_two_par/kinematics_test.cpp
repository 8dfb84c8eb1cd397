// Kinematics of 4PPa-2PaR: closed-form forward kinematics against the inverse kinematics of the generic engine, the
// paper's Jacobians, singular and unreachable poses, and tests of the design.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/model.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

TEST(FourPpaKinematics, ForwardAfterInverseContainsThePose) {
  Uniform uniform(1);
  int assembled = 0;
  for (int i = 0; i < 10000; ++i) {
    auto p = nominal();
    for (const int k : {kA, kB, kLu, kLd}) p[static_cast<std::size_t>(k)] *= uniform(0.7, 1.4);
    const SchoenfliesPose<double> pose{uniform(0, p[kB]), uniform(0.6, 1.9), uniform(-1.3, 0.4), uniform(-1.5, 1.5)};
    for (const auto& mode : kModes) {
      const PoseReport r = four_ppa().inspect(p, pose, mode, no_limits(four_ppa().info()));
      if (!r.assembles) {
        ASSERT_FALSE(r.reason.empty());
        continue;
      }
      ++assembled;
      double nearest = 1;
      for (const auto& m : four_ppa().forward()->assemblies(p, *r.joints))
        nearest = std::min(nearest, std::fabs(m.pose[0] - pose.x) + std::fabs(m.pose[1] - pose.y) +
                                        std::fabs(m.pose[2] - pose.z) + std::fabs(m.pose[3] - pose.angle));
      // z_c enters q through a square root, so rounding in q grows near z_c = 0 and near concentric circles
      ASSERT_LT(nearest, 1e-7) << mode << " " << pose.x << " " << pose.z << " " << pose.angle;
    }
  }
  EXPECT_GT(assembled, 2500);
}

// The loop closures of the file are the paper's: J_q J = G, and the determinants of eq 15.
TEST(FourPpaKinematics, JacobiansAreThoseOfThePaper) {
  Uniform uniform(2);
  const auto p = nominal();
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const pkm::Pose<double> at = {uniform(0.2, 0.6), uniform(0.8, 1.7), uniform(-1.2, 0.3), uniform(-1.4, 1.4)};
    for (const auto& mode : kModes) {
      const PoseReport r = four_ppa().inspect(p, at, mode, no_limits(four_ppa().info()));
      if (!r.J) continue;
      bool near_edge = std::fabs(*r.det_Jq) > 20 || std::fabs(*r.det_Jq) < 1e-2;
      for (const auto& [name, margin] : r.margins) near_edge = near_edge || (name.ends_with("exists") && margin < 0.01);
      for (const char* height : {"z_c_1", "z_c_2"}) near_edge = near_edge || std::fabs(named(r.angles, height)) < 0.05;
      if (near_edge) continue;
      ++compared;
      const AxisMatrix<double> product = *r.Jq * *r.J;
      for (std::size_t k = 0; k < product.size(); ++k) EXPECT_NEAR(product[k], (*r.G)[k], 1e-11);
      double expected_of_Jq = 0.25;
      for (const std::string n : {"1", "2"})
        expected_of_Jq *= std::cos(named(r.angles, "beta_" + n)) / std::tan(named(r.angles, "alpha_" + n));
      EXPECT_NEAR(*r.det_Jq, expected_of_Jq, 1e-10 * (1 + std::fabs(expected_of_Jq)));
      EXPECT_NEAR(*r.det_G, -p[kA] * std::cos(at[3]) * std::sin(named(r.angles, "beta_1") + named(r.angles, "beta_2")),
                  1e-12);
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(FourPpaKinematics, SingularPoses) {
  // C_1 and C_2 on the rails: z_c = 0, upper bars flat; in numbers without rounding
  auto p = nominal();
  p[kA] = 0.25, p[kB] = 1, p[kLu] = 0.5, p[kLd] = 0.625, p[kD] = 0.125;
  const auto none = no_limits(four_ppa().info());
  const PoseReport flat = four_ppa().inspect(p, pkm::Pose<double>{0.5, 1.25, -0.625, 0}, "lower,lower", none);
  ASSERT_TRUE(flat.assembles) << flat.reason;
  EXPECT_EQ(named(flat.angles, "z_c_1"), 0);
  EXPECT_FALSE(flat.J);
  EXPECT_FALSE(flat.conditioning);
  // cos(theta) = 0
  const PoseReport turned =
      four_ppa().inspect(nominal(), pkm::Pose<double>{0.4, 1.25, -0.9, kPi / 2}, "lower,lower", none);
  ASSERT_TRUE(turned.assembles) << turned.reason;
  EXPECT_NEAR(*turned.conditioning, 0, 1e-15);
  for (const PoseReport& report : {flat, turned})
    for (const auto& [name, value] : report.margins) EXPECT_FALSE(std::isnan(value)) << name;
}

TEST(FourPpaKinematics, ReasonsAndUnreachableJoints) {
  const auto p = nominal();
  const auto none = no_limits(four_ppa().info());
  const auto reason = [&](const pkm::Pose<double>& pose) {
    return four_ppa().inspect(p, pose, "lower,lower", none).reason;
  };
  const PoseReport above = four_ppa().inspect(p, pkm::Pose<double>{0.4, 1.25, -0.2, 0}, "lower,lower", none);
  EXPECT_TRUE(above.assembles);  // table 2 of the paper lists its q
  EXPECT_FALSE(above.feasible);
  EXPECT_EQ(above.reason, "alpha_min is violated");
  EXPECT_EQ(reason({0.4, 1.25, -3, 0}), "h_1 has no real value, so q1 is undefined");
  EXPECT_EQ(reason({0.79, 1.25, -0.5, 0}), "s_1 has no real value, so q1 is undefined");
  EXPECT_EQ(reason({0.05, 1.25, -0.5, 0}), "s_2 has no real value, so q3 is undefined");
  EXPECT_EQ(reason({0.4, 0.1, -0.9, 0}), "q1 min is violated");
  EXPECT_TRUE(four_ppa().forward()->assemblies(p, {0, 2.4, 0, 2.4}).empty());    // wider than the upper bars allow
  EXPECT_TRUE(four_ppa().forward()->assemblies(p, {0, 0.5, 2.0, 2.5}).empty());  // |sin theta| > 1
  EXPECT_THROW(four_ppa().inspect(p, pkm::Pose<double>(4), "sideways", none), std::invalid_argument);
}

TEST(FourPpaDesign, MarginsFollowTheirEquations) {
  auto p = nominal();
  LimitSpec limits = no_limits(four_ppa().info());
  limits.given[kAlphaMin] = 0.1;
  limits.given[kCosThetaMin] = 0.25;
  std::array<double, 2> margins{};
  four_ppa().design_tests()->test(p, limits, margins);
  EXPECT_NEAR(margins[0], 0.55 - std::hypot(0.6, 0.8 - 0.2 * 0.25) / 2, 1e-15);
  EXPECT_NEAR(margins[1], 2.5 - 2 * 0.6 * std::cos(0.1), 1e-15);
  EXPECT_EQ(four_ppa().refuse(p), std::nullopt);
  p[kLu] = -1;
  EXPECT_EQ(four_ppa().refuse(p), "l_u = -1 is outside the model's range 0.001 to 100 m");
}

TEST(FourPpaDesign, DerivedThresholdsMoveWithTheParameters) {
  auto p = nominal();
  LimitSpec spec = no_limits(four_ppa().info());
  spec.derived[kAlphaMin] = spec.derived[kBetaMin] = spec.derived[kHMin] = true;
  const auto g = geometry(std::span<const double>(p));
  const auto l = limits(g, spec);
  EXPECT_NEAR(l.sin_alpha_min, 2 * 0.010 / 0.080, 1e-15);
  EXPECT_NEAR(l.sin_beta_min, 2 * 0.010 / 0.080, 1e-15);
  EXPECT_NEAR(l.h_min, 0.030 + 0.040, 1e-15);
  std::vector<double> thresholds(kLimits);
  four_ppa().thresholds(p, spec, thresholds);
  EXPECT_NEAR(std::sin(thresholds[kAlphaMin]), l.sin_alpha_min, 1e-15);
  EXPECT_NEAR(std::sin(thresholds[kBetaMin]), l.sin_beta_min, 1e-15);
  EXPECT_NEAR(std::sin(thresholds[kBetaMax]), l.sin_beta_max, 1e-15);
  EXPECT_NEAR(thresholds[kHMin], l.h_min, 1e-15);
  const double wide = survey(p, columns(spec)).volume;
  p[kDu] = 0.04;
  EXPECT_LT(survey(p, columns(spec)).volume, wide);
  p[kRu] = 0.03;  // bars thicker than their spacing: no pose is feasible
  EXPECT_EQ(survey(p, columns(spec)).volume, 0);
}

}  // namespace
}  // namespace pkm::testing
