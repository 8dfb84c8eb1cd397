// Laws of the kinematics of (3CRR/R)&CRU and the Quadrupteron on random designs and poses: limbs, yaw and forward
// kinematics of the accelerators against the generic engine, singular poses, messages.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/accelerators/crr_cru/forward.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "tests/unit/accelerators/crr_cru/states.hpp"

namespace pkm::testing::crr {
namespace {

using ::testing::HasSubstr;

double length(const Vector3<double>& a, const Vector3<double>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Calls check(name, parameters, pose) for random poses, assembling or not, of random designs of both mechanisms.
template <class Check>
void for_random_poses(int count, int seed, const Check& check) {
  for (const std::string& name : both()) {
    Uniform uniform(seed);
    for (int i = 0; i < count; ++i) {
      const auto p = random_design(uniform, 0.2);
      check(name, p, Pose<double>{uniform(0, 0.4), uniform(0, 0.4), uniform(0, 0.4), uniform(-3.1, 3.1)});
    }
  }
}

TEST(CrrCruKinematics, LimbsCloseInAllWorkingModesAsTheGenericEngineHasThem) {
  int assembled = 0;
  for_random_poses(400, 1, [&](const std::string& name, const auto& p, const Pose<double>& pose) {
    const auto g = geometry_of(name, p);
    const auto [s, c] = sincos(pose.angle);
    const auto arm = arms(g, s, c);
    for (int number = 0; number < 16; ++number) {
      const WorkingMode mode = mode_number(number);
      std::array<Limb<double>, 4> limb;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& to = arm[i].to_joint;
        limb[i] = limb_at(g, i, {pose.x + to[0], pose.y + to[1], pose.z + to[2]}, mode[i]);
      }
      const auto link = links(name, p, pose, mode_name(mode));
      const bool assembles = std::ranges::all_of(limb, &Limb<double>::reaches);
      ASSERT_EQ(!link.empty(), assembles);
      if (!assembles) break;  // reach does not depend on the mode
      ++assembled;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& [rho, A, B, C, d, u1, u2, sin_2, cos_2, reaches] = limb[i];
        ASSERT_NEAR(length(A, B), g.l_1[i], 1e-13);
        ASSERT_NEAR(length(B, C), g.l_2[i], 1e-12);
        ASSERT_EQ(B[kLimbs[i].e], rho);
        ASSERT_GE(sin_2 * mode[i], 0);
        ASSERT_NEAR(u1[0] * u2[1] - u1[1] * u2[0], sin_2, 1e-11);
        ASSERT_NEAR(u1[0] * u2[0] + u1[1] * u2[1], cos_2, 1e-11);
        if (std::fabs(sin_2) < 1e-3) continue;  // elbows of stretched and folded limbs lose half of the digits
        const std::string rod = "rod " + std::to_string(i + 1);
        ASSERT_LE(length(link.at(rod + "1").axis.from, A), 1e-12);
        ASSERT_LE(length(link.at(rod + "1").axis.to, B), 1e-11);
        ASSERT_LE(length(link.at(rod + "2").axis.to, C), 1e-12);
      }
    }
  });
  EXPECT_GT(assembled, 2000);
}

TEST(CrrCruKinematics, ForwardAfterInverseIsThePoseInAllWorkingModes) {
  int compared = 0;
  for_random_poses(1000, 2, [&](const std::string& name, const auto& p, const Pose<double>& pose) {
    for (const std::string& mode : mechanism(name).info().modes) {
      const PoseReport r = mechanism(name).inspect(p, pose, mode, limit_spec(0, 0));
      if (!r.assembles) {
        ASSERT_FALSE(r.reason.empty());
        break;  // reach does not depend on the mode
      }
      const double kappa = by_name(r.indices).at("kappa_p");
      if (std::fabs(kappa) < 1e-3) continue;  // the two branches meet: phi follows from an arc sine near 1
      ++compared;
      const auto branches = mechanism(name).forward()->assemblies(p, *r.joints);
      ASSERT_EQ(branches.size(), 2u);
      const AssemblyMode& own = branches[kappa > 0 ? 0 : 1];
      EXPECT_EQ(own.mode, kappa > 0 ? "+" : "-");
      const Pose<double> found = schoenflies(own.pose);
      EXPECT_NEAR(found.x, pose.x, 1e-12);
      EXPECT_NEAR(found.y, pose.y, 1e-12);
      EXPECT_NEAR(found.z, pose.z, 1e-12);
      EXPECT_NEAR(found.angle, pose.angle, 1e-12);
      // the other branch has the same slides
      const AssemblyMode& other = branches[kappa > 0 ? 1 : 0];
      const AxisVector<double> slides = *mechanism(name).inspect(p, other.pose, mode, limit_spec(0, 0)).joints;
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(slides[i], (*r.joints)[i], 1e-12);
    }
  });
  EXPECT_GT(compared, 5000);
}

TEST(CrrCruKinematics, TheYawDeterminesTheJacobianAndItsConditioning) {
  int compared = 0;
  for_random_poses(500, 3, [&](const std::string& name, const auto& p, const Pose<double>& pose) {
    const auto g = geometry_of(name, p);
    const auto [s, c] = sincos(pose.angle);
    const Yaw<double> y = yaw(g);
    const auto values = quantities(name, p, pose, "-,-,+,-");
    EXPECT_NEAR(values.at("R"), y.R, 1e-14);
    EXPECT_NEAR(values.at("delta"), offset(y), 1e-14);
    EXPECT_NEAR(values.at("kappa_p"), parallel_index(y, s, c), 1e-14);
    EXPECT_NEAR(values.at("det_J"), y.R * parallel_index(y, s, c), 1e-14);
    EXPECT_NEAR(parallel_index(y, s, c), std::cos(pose.angle + offset(y)), 1e-13);
    const PoseReport r = mechanism(name).inspect(p, pose, "-,-,+,-", limit_spec(0, 0));
    if (!r.assembles) return;
    ++compared;
    Eigen::Matrix4d J;
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) J(i, k) = (*r.J)(static_cast<std::size_t>(i), static_cast<std::size_t>(k));
    EXPECT_NEAR(J.determinant(), y.R * parallel_index(y, s, c), 1e-14);
    EXPECT_NEAR(conditioning(arms(g, s, c), characteristic_length(g)), r.conditioning.value(), 1e-12);
    J.col(3) /= 0.5;
    const Eigen::Vector4d singular = Eigen::MatrixXd(J).jacobiSvd().singularValues();
    EXPECT_NEAR(conditioning(arms(g, s, c), 0.5), singular[3] / singular[0], 1e-12);
  });
  EXPECT_GT(compared, 200);
}

TEST(CrrCruKinematics, SingularAndCollinearPoses) {
  auto p = nominal();
  for (const std::string& name : both()) {
    const PoseReport turned = mechanism(name).inspect(p, {0.2, 0.17, 0.22, kPi / 2}, "-,-,+,-", limit_spec(0, 0));
    ASSERT_TRUE(turned.assembles) << turned.reason;
    EXPECT_NEAR(by_name(turned.indices).at("kappa_p"), 0, 1e-15);
    EXPECT_NEAR(*turned.conditioning, 0, 1e-15);
    // limb 3 stretched out: |C_3 - A_3| = l_31 + l_32
    auto stretched = p;
    const auto arm = arms(geometry_of(name, p), 0.0, 1.0);
    const double x = 0.6 * (p[kL31] + p[kL32]), y = 0.8 * (p[kL31] + p[kL32]);
    stretched[kL31] += 1e-15;  // so that rounding does not open the limb
    const PoseReport straight = mechanism(name).inspect(
        stretched, {x - arm[2].to_joint[0], y - arm[2].to_joint[1], 0.22, 0}, "+,+,+,+", limit_spec(0, 0));
    ASSERT_TRUE(straight.assembles) << straight.reason;
    EXPECT_NEAR(by_name(straight.indices).at("sin_theta_32"), 0, 3e-7);
    for (const auto& [margin, value] : straight.margins) EXPECT_FALSE(std::isnan(value)) << margin;
  }
  // equal rods folded back on themselves: any direction will do, none may be NaN
  p[kL32] = p[kL31];
  const auto limb = limb_at(geometry_of("3crr-r-cru", p), 2, {0, 0, 0.2}, 1);
  EXPECT_TRUE(limb.reaches);
  EXPECT_EQ(limb.sin_2, 0);
  for (const double value : {limb.u1[0], limb.u1[1], limb.u2[0], limb.u2[1], limb.B[0]})
    EXPECT_TRUE(std::isfinite(value));
}

TEST(CrrCruKinematics, BranchesMeetAndEnd) {
  const auto p = nominal();
  for (const std::string& name : both()) {
    const auto y = yaw(geometry_of(name, p));
    const double end = 0.1 + y.a_0 + y.R;
    EXPECT_EQ(mechanism(name).forward()->assemblies(p, {0.2, 0.1, 0.2, end - 1e-6}).size(), 2u);
    EXPECT_EQ(mechanism(name).forward()->assemblies(p, {0.2, 0.1, 0.2, end + 1e-6}).size(), 0u);
    const auto meeting = mechanism(name).forward()->assemblies(p, {0.2, 0.1, 0.2, end + 1e-15});
    ASSERT_EQ(meeting.size(), 1u);
    EXPECT_NEAR(schoenflies(meeting[0].pose).angle, kPi / 2 - offset(y), 1e-7);
  }
}

TEST(CrrCruKinematics, ReasonsAndRefusals) {
  const Mechanism& m = mechanism("3crr-r-cru");
  const auto none = limit_spec(0, 0);
  const auto p = nominal();
  const auto reason = [&](const Pose<double>& pose, const LimitSpec& limits) {
    return m.inspect(p, pose, "-,-,+,-", limits).reason;
  };
  EXPECT_EQ(reason({0.2, 0.17, 1.2, 0}, none), "limb1 cannot reach the pose");
  EXPECT_EQ(reason({-0.02, 0.04, 0.22, 0}, none), "limb3 cannot reach the pose");
  const PoseReport off_rail = m.inspect(p, {-0.03, 0.17, 0.3, 0}, "-,-,+,-", none);
  EXPECT_TRUE(off_rail.assembles);
  EXPECT_FALSE(off_rail.feasible);
  EXPECT_EQ(off_rail.reason, "rho1 min is violated");
  EXPECT_EQ(reason({0.2, 0.17, 0.22, 1.5}, limit_spec(0, 0.1)), "c_min is violated");
  EXPECT_EQ(reason({0.2, 0.17, 0.22, 0}, limit_spec(0.99, 0)), "s_min is violated");
  EXPECT_THROW(m.inspect(p, {0, 0, 0, 0}, "lower,lower", none), std::invalid_argument);

  auto q = p;
  q[kRhoMin] = 0.5;
  EXPECT_EQ(m.refuse(q), "the range of joint rho1 is empty: from 0.5 m to 0.4 m");
  q = p;
  q[kR] = q[kL];
  q[kBeta2] = 0;
  EXPECT_THAT(mechanism("quadrupteron").refuse(q).value_or(""), HasSubstr("control of the yaw by the slides"));
  EXPECT_EQ(m.refuse(q), std::nullopt);
}

}  // namespace
}  // namespace pkm::testing::crr
