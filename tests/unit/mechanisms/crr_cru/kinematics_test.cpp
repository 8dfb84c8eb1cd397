// Laws of the kinematics of (3CRR/R)&CRU and the Quadrupteron on random designs and poses: closure of the limbs,
// forward after inverse, Jacobian and its rate, singular poses, messages.
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "engine/math/dual.hpp"
#include "engine/mechanisms/crr_cru/forward.hpp"
#include "tests/unit/mechanisms/crr_cru/golden.hpp"

namespace pkm::testing::crr {
namespace {

using crr_cru::Influence;

WorkingMode mode_number(int bits) {
  return {bits & 8 ? 1 : -1, bits & 4 ? 1 : -1, bits & 2 ? 1 : -1, bits & 1 ? 1 : -1};
}

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

TEST(CrrCruKinematics, LimbsCloseInAllWorkingModes) {
  int assembled = 0;
  for_random_poses(3000, 1, [&](const std::string& name, const auto& p, const Pose<double>& pose) {
    const auto g = geometry_of(name, p);
    for (int bits = 0; bits < 16; ++bits) {
      const WorkingMode mode = mode_number(bits);
      const Limbs<double> limbs = inverse(g, pose, mode);
      if (!limbs.assembles) continue;
      ++assembled;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto& limb = limbs.limb[i];
        ASSERT_NEAR(length(limb.A, limb.B), g.l_1[i], 1e-13);
        ASSERT_NEAR(length(limb.B, limb.C), g.l_2[i], 1e-12);
        ASSERT_EQ(limb.B[kLimbs[i].e], limb.rho);
        ASSERT_GE(limb.sin_2 * mode[i], 0);
        ASSERT_NEAR(limb.u1[0] * limb.u2[1] - limb.u1[1] * limb.u2[0], limb.sin_2, 1e-11);
        ASSERT_NEAR(limb.u1[0] * limb.u2[0] + limb.u1[1] * limb.u2[1], limb.cos_2, 1e-11);
      }
    }
  });
  EXPECT_GT(assembled, 5000);
}

TEST(CrrCruKinematics, ForwardAfterInverseIsThePoseInAllWorkingModes) {
  int compared = 0;
  for_random_poses(3000, 2, [&](const std::string& name, const auto& p, const Pose<double>& pose) {
    for (const std::string& mode : mechanism(name).info().modes) {
      const PoseReport r = mechanism(name).inspect(p, pose, mode, limit_spec(0, 0));
      ASSERT_EQ(r.assembles, r.joints.has_value());
      if (!r.assembles) {
        ASSERT_FALSE(r.reason.empty());
        break;  // reach does not depend on the mode
      }
      const double kappa = r.indices[1].second;
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
      const Limbs<double> limbs = inverse(geometry_of(name, p), schoenflies(other.pose), {1, 1, 1, 1});
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(limbs.limb[i].rho, (*r.joints)[i], 1e-12);
    }
  });
  EXPECT_GT(compared, 5000);
}

Eigen::Matrix4d jacobian(const std::array<Arm<double>, 4>& arm) {
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(influence(arm).G.m.data());
}

TEST(CrrCruKinematics, JacobianIsTheDerivativeOfTheSlides) {
  for_random_poses(500, 3, [](const std::string& name, const auto& p, const Pose<double>& pose) {
    std::vector<Dual4> fixed(p.begin(), p.end());
    const auto g = geometry(platform(name), std::span<const Dual4>(fixed));
    const Pose<Dual4> moving = {Dual4::variable(pose.x, 0), Dual4::variable(pose.y, 1), Dual4::variable(pose.z, 2),
                                Dual4::variable(pose.angle, 3)};
    const Limbs<Dual4> limbs = inverse(g, moving, {1, -1, 1, -1});
    const Limbs<double> plain = inverse(geometry_of(name, p), pose, {1, -1, 1, -1});
    const Eigen::Matrix4d J = jacobian(plain.arm);
    for (std::size_t i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) EXPECT_NEAR(limbs.limb[i].rho.v[k], J(static_cast<Eigen::Index>(i), k), 1e-14);
    const auto [s, c] = sincos(pose.angle);
    const Yaw<double> y = yaw(geometry_of(name, p));
    EXPECT_NEAR(J.determinant(), y.R * parallel_index(y, s, c), 1e-14);
    EXPECT_NEAR(parallel_index(y, s, c), std::cos(pose.angle + offset(y)), 1e-13);
  });
}

TEST(CrrCruKinematics, JacobianRateIsItsDifference) {
  constexpr double kStep = 1e-6;
  for_random_poses(300, 4, [](const std::string& name, const auto& p, const Pose<double>& pose) {
    const auto g = geometry_of(name, p);
    const double rate = 1.7;
    const auto at = [&](double t) {
      const auto [s, c] = sincos(pose.angle + rate * t);
      return arms(g, s, c);
    };
    const Eigen::Matrix4d difference = (jacobian(at(kStep)) - jacobian(at(-kStep))) / (2 * kStep);
    const Influence<double> q = influence(at(0));
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR(q.H[i](k, 3) * rate, difference(static_cast<int>(i), static_cast<int>(k)), 1e-10);
  });
}

TEST(CrrCruKinematics, RodRatesAreDerivativesOfTheAngles) {
  // Along a motion X(t) = pose + V t + W t^2 / 2 through the pose, by differences of the angles.
  int compared = 0;
  constexpr double kStep = 1e-4;
  const Pose<double> V = {0.3, -0.2, 0.1, 1}, W = {5, -4, 3, 20};
  for_random_poses(400, 5, [&](const std::string& name, const auto& p, const Pose<double>& pose) {
    const auto g = geometry_of(name, p);
    const WorkingMode mode = {-1, -1, 1, -1};
    const auto at = [&](double t) {
      const auto along = [t](double x, double v, double w) { return x + v * t + w * t * t / 2; };
      return inverse(g,
                     Pose<double>{along(pose.x, V.x, W.x), along(pose.y, V.y, W.y), along(pose.z, V.z, W.z),
                                  along(pose.angle, V.angle, W.angle)},
                     mode);
    };
    const auto here = at(0), before = at(-kStep), after = at(kStep);
    for (std::size_t i = 0; i < 4; ++i) {
      if (!here.assembles || std::fabs(here.limb[i].sin_2) < 0.4) continue;
      const auto psi = [i](const Limbs<double>& limbs, bool second) {
        const auto& u = second ? limbs.limb[i].u2 : limbs.limb[i].u1;
        return std::atan2(u[1], u[0]);
      };
      const auto& arm = here.arm[i];
      const double turn = arm.turns ? V.angle : 0, spin = arm.turns ? W.angle : 0;
      const double x = arm.to_joint[0], y = arm.to_joint[1];
      const auto rates = rod_rates(g, i, here.limb[i], {V.x - turn * y, V.y + turn * x, V.z},
                                   {W.x - spin * y - turn * turn * x, W.y + spin * x - turn * turn * y, W.z});
      for (const bool second : {false, true}) {
        const double middle = psi(here, second);
        const double up = std::remainder(psi(after, second) - middle, 2 * kPi);
        const double down = std::remainder(middle - psi(before, second), 2 * kPi);
        const double scale = 1 + std::fabs(rates.acceleration[second]);
        EXPECT_NEAR((up + down) / (2 * kStep), rates.velocity[second], 2e-4 * scale);
        EXPECT_NEAR((up - down) / (kStep * kStep), rates.acceleration[second], 2e-4 * scale);
        ++compared;
      }
    }
  });
  EXPECT_GT(compared, 500);
}

TEST(CrrCruKinematics, ConditioningEqualsTheFullJacobians) {
  for_random_poses(300, 6, [](const std::string& name, const auto& p, const Pose<double>& pose) {
    const auto g = geometry_of(name, p);
    const auto [s, c] = sincos(pose.angle);
    const auto arm = arms(g, s, c);
    for (const double length : {characteristic_length(g), 0.5}) {
      Eigen::Matrix4d J = jacobian(arm);
      J.col(3) /= length;
      const Eigen::Vector4d values = J.jacobiSvd().singularValues();
      EXPECT_NEAR(conditioning(arm, length), values[3] / values[0], 1e-12);
    }
  });
}

TEST(CrrCruKinematics, SingularAndCollinearPoses) {
  auto p = nominal();
  for (const std::string& name : both()) {
    const PoseReport turned = mechanism(name).inspect(p, {0.2, 0.17, 0.22, kPi / 2}, "-,-,+,-", limit_spec(0, 0));
    ASSERT_TRUE(turned.assembles) << turned.reason;
    EXPECT_NEAR(turned.indices[1].second, 0, 1e-15);
    EXPECT_NEAR(*turned.conditioning, 0, 1e-15);
    // limb 3 stretched out: |C_3 - A_3| = l_31 + l_32
    const auto arm = arms(geometry_of(name, p), 0.0, 1.0);
    const double x = 0.6 * (p[kL31] + p[kL32]), y = 0.8 * (p[kL31] + p[kL32]);
    p[kL31] = std::nextafter(p[kL31], 1);  // so that rounding does not open the limb
    const PoseReport straight = mechanism(name).inspect(p, {x - arm[2].to_joint[0], y - arm[2].to_joint[1], 0.22, 0},
                                                        "+,+,+,+", limit_spec(0, 0));
    ASSERT_TRUE(straight.assembles) << straight.reason;
    EXPECT_EQ(straight.indices[4].first, "sin_theta_32");
    EXPECT_NEAR(straight.indices[4].second, 0, 1e-7);
    for (const auto& [margin, value] : straight.margins) EXPECT_FALSE(std::isnan(value)) << margin;
  }
  // equal rods folded back on themselves: any direction will do, none may be NaN
  p = nominal();
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
  EXPECT_EQ(m.inspect(p, {0.2, 0.17, 1.2, 0}, "-,-,+,-", none).reason,
            "limb 1: out of reach of its rods (|C - A| > l_11 + l_12)");
  EXPECT_EQ(m.inspect(p, {-0.02, 0.04, 0.22, 0}, "-,-,+,-", none).reason,
            "limb 3: out of reach of its rods (|C - A| < |l_31 - l_32|)");
  const PoseReport off_rail = m.inspect(p, {-0.03, 0.17, 0.3, 0}, "-,-,+,-", none);
  EXPECT_TRUE(off_rail.assembles);
  EXPECT_FALSE(off_rail.feasible);
  EXPECT_EQ(off_rail.reason, "limit stroke_1 is broken");
  EXPECT_EQ(m.inspect(p, {0.2, 0.17, 0.22, 1.5}, "-,-,+,-", limit_spec(0, 0.1)).reason, "limit c_min is broken");
  EXPECT_EQ(m.inspect(p, {0.2, 0.17, 0.22, 0}, "-,-,+,-", limit_spec(0.99, 0)).reason, "limit s_min is broken");
  EXPECT_THROW(m.inspect(p, {0, 0, 0, 0}, "lower,lower", none), std::invalid_argument);

  auto q = p;
  q[kRhoMin] = 0.5;
  EXPECT_EQ(m.refuse(q), "rho_min = 0.5 m leaves the slides no range below rho_max = 0.4 m");
  q = p;
  q[kR] = q[kL];
  q[kBeta2] = 0;
  EXPECT_EQ(mechanism("quadrupteron").refuse(q), "with r = l and beta_2 = 0 no slide controls the yaw");
  EXPECT_EQ(m.refuse(q), std::nullopt);
}

}  // namespace
}  // namespace pkm::testing::crr
