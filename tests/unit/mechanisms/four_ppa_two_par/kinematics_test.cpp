// Laws of 4PPa-2PaR's kinematics: forward after inverse, Jacobian against differences, singular and degenerate poses.
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "engine/mechanisms/four_ppa_two_par/model.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/golden.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

Eigen::Matrix4d eigen(const AxisMatrix<double>& a) {
  Eigen::Matrix4d same;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) same(i, j) = a(i, j);
  return same;
}

TEST(FourPpaKinematics, ForwardAfterInverseContainsThePose) {
  Uniform uniform(1);
  int assembled = 0;
  for (int i = 0; i < 20000; ++i) {
    auto p = nominal();
    for (const int k : {kA, kB, kLu, kLd}) p[static_cast<std::size_t>(k)] *= uniform(0.7, 1.4);
    const SchoenfliesPose<double> pose{uniform(0, p[kB]), uniform(0.6, 1.9), uniform(-1.3, 0.4), uniform(-1.5, 1.5)};
    for (const auto& mode : kModes) {
      const PoseReport r = four_ppa().inspect(p, pose, mode, no_limits(four_ppa().info()));
      ASSERT_EQ(r.assembles, r.joints.has_value());
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
  EXPECT_GT(assembled, 5000);
}

TEST(FourPpaKinematics, JacobianMapsPoseRatesToJointRates) {
  Uniform uniform(2);
  const auto p = nominal();
  const auto g = geometry(std::span<const double>(p));
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::array<double, 4> at = {uniform(0.2, 0.6), uniform(0.8, 1.7), uniform(-1.2, 0.3), uniform(-1.4, 1.4)};
    for (int m = 0; m < 4; ++m) {
      const WorkingMode mode = {m & 2 ? Branch::upper : Branch::lower, m & 1 ? Branch::upper : Branch::lower};
      const PoseReport r = four_ppa().inspect(p, {at[0], at[1], at[2], at[3]}, kModes[m], no_limits(four_ppa().info()));
      if (!r.J) continue;
      bool near_edge = std::fabs(*r.det_Jq) > 20 || std::fabs(*r.det_Jq) < 1e-2;
      for (const auto& [name, margin] : r.margins)
        near_edge = near_edge || (name.starts_with("reach") && margin < 0.01) ||
                    (name.starts_with("below_rail") && std::fabs(margin) < 0.01);
      if (near_edge) continue;
      for (int k = 0; k < 4; ++k) {
        constexpr double kStep = 1e-6;
        auto plus = at, minus = at;
        plus[static_cast<std::size_t>(k)] += kStep;
        minus[static_cast<std::size_t>(k)] -= kStep;
        const auto q1 = inverse(g, {plus[0], plus[1], plus[2], plus[3]}, mode).q;
        const auto q0 = inverse(g, {minus[0], minus[1], minus[2], minus[3]}, mode).q;
        for (int j = 0; j < 4; ++j) {
          const auto row = static_cast<std::size_t>(j);
          EXPECT_NEAR((q1[row] - q0[row]) / (2 * kStep), (*r.J)(j, k), 1e-6 * (1 + std::fabs((*r.J)(j, k))));
        }
      }
      ++compared;
      // J_q J = G, and the determinants of eq 15
      EXPECT_LT((eigen(*r.Jq) * eigen(*r.J) - eigen(*r.G)).cwiseAbs().maxCoeff(), 1e-11);
      std::map<std::string, double> angles(r.angles.begin(), r.angles.end());
      EXPECT_NEAR(*r.det_G, -p[kA] * std::cos(at[3]) * std::sin(angles["beta_1"] + angles["beta_2"]), 1e-12);
      EXPECT_NEAR(eigen(*r.Jq).determinant(), *r.det_Jq, 1e-10 * (1 + std::fabs(*r.det_Jq)));
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(FourPpaKinematics, SingularPosesGiveZeroConditioningAndNoNan) {
  auto p = nominal();
  const auto none = no_limits(four_ppa().info());
  // C_1 and C_2 on the rails: z_c = 0, upper bars flat
  const double sigma = std::sqrt(p[kLd] * p[kLd] - 0.3 * 0.3);
  const PoseReport flat = four_ppa().inspect(p, {0.4, 1.25, -p[kD] - sigma, 0}, "lower,lower", none);
  ASSERT_TRUE(flat.assembles) << flat.reason;
  EXPECT_FALSE(flat.J);
  EXPECT_EQ(flat.conditioning, 0.0);
  // cos(theta) = 0
  const PoseReport turned = four_ppa().inspect(p, {0.4, 1.25, -0.9, kPi / 2}, "lower,lower", none);
  ASSERT_TRUE(turned.assembles) << turned.reason;
  EXPECT_NEAR(*turned.conditioning, 0, 1e-15);
  for (const auto& [name, value] : turned.margins) EXPECT_FALSE(std::isnan(value)) << name;
}

TEST(FourPpaKinematics, ReasonsAndUnreachableJoints) {
  const auto p = nominal();
  const auto none = no_limits(four_ppa().info());
  const PoseReport above = four_ppa().inspect(p, {0.4, 1.25, -0.2, 0}, "lower,lower", none);
  EXPECT_TRUE(above.assembles);  // table 2 of the paper lists its q
  EXPECT_FALSE(above.feasible);
  EXPECT_EQ(above.reason, "limit below_rail_1 is broken");
  EXPECT_EQ(four_ppa().inspect(p, {0.4, 1.25, -3, 0}, "lower,lower", none).reason,
            "limb 1: out of reach of the upper bars (|z_c| > l_u)");
  EXPECT_EQ(four_ppa().inspect(p, {0.79, 1.25, -0.5, 0}, "lower,lower", none).reason,
            "limb 1: out of reach of the lower bars (x_1 > l_d)");
  const PoseReport off_rail = four_ppa().inspect(p, {0.4, 0.1, -0.9, 0}, "lower,lower", none);
  EXPECT_TRUE(off_rail.assembles);
  EXPECT_FALSE(off_rail.feasible);
  EXPECT_EQ(off_rail.reason, "limit stroke is broken");
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
  const double wide = survey(p, columns(spec)).volume;
  p[kDu] = 0.04;
  EXPECT_LT(survey(p, columns(spec)).volume, wide);
  p[kRu] = 0.03;  // bars thicker than their spacing: no pose is left
  EXPECT_EQ(survey(p, columns(spec)).volume, 0);
}

}  // namespace
}  // namespace pkm::testing
