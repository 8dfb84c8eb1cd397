// Influence coefficients of 4PPa-2PaR, (3CRR/R)&CRU and the Quadrupteron against the inverse kinematics with the scalar
// that carries two derivatives by time. The hybrid robot's are in hybrid_kinematics_test.cpp.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/math/taylor.hpp"
#include "engine/mechanisms/four_ppa_two_par/dynamics.hpp"
#include "tests/unit/contracts/nominal.hpp"
#include "tests/unit/mechanisms/crr_cru/golden.hpp"

namespace pkm::testing {
namespace {

constexpr double kRoundoff = 1e-12;

/// A pose on its way, at random around one inside the nominal design's workspace.
MotionSample random_sample(crr::Uniform& uniform, const Pose<double>& centre) {
  MotionSample at;
  at.pose = centre;
  at.velocity = at.acceleration = AxisVector<double>(4);
  for (std::size_t i = 0; i < 4; ++i) {
    at.pose[i] += uniform(-0.03, 0.03);
    at.velocity[i] = uniform(-1, 1);
    at.acceleration[i] = uniform(-1, 1);
  }
  return at;
}

SchoenfliesPose<Taylor> moving(const MotionSample& at) {
  const auto coordinate = [&](std::size_t i) { return Taylor(at.pose[i], at.velocity[i], at.acceleration[i]); };
  return {coordinate(0), coordinate(1), coordinate(2), coordinate(3)};
}

void expect_motion(const Influence<double>& q, const MotionSample& at, const std::array<Taylor, 4>& joints) {
  const AxisVector<double> speeds = q.G * at.velocity, drives = accelerations(q, at.velocity, at.acceleration);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(speeds[i], joints[i].d, kRoundoff * (1 + std::fabs(joints[i].d)));
    EXPECT_NEAR(drives[i], joints[i].dd, kRoundoff * (1 + std::fabs(joints[i].dd)));
  }
}

TEST(Influence, OfFourPpaTwoParInEveryMode) {
  using namespace four_ppa_two_par;
  const Mechanism& mechanism = *all_mechanisms()[0];
  ASSERT_EQ(mechanism.info().name, "4ppa-2par");
  const std::vector<double> p = test::nominal(mechanism.info());
  const std::vector<Taylor> constant(p.begin(), p.end());
  crr::Uniform uniform(1);
  int compared = 0;
  for (int k = 0; k < 400; ++k) {
    const MotionSample at = random_sample(uniform, {0.3, 0.85, -0.8, 0.1});
    for (const Branch first : {Branch::lower, Branch::upper})
      for (const Branch second : {Branch::lower, Branch::upper}) {
        const WorkingMode mode = {first, second};
        const auto found = influence(geometry(std::span<const double>(p)), schoenflies(at.pose), mode);
        const auto limbs = inverse(geometry(std::span<const Taylor>(constant)), moving(at), mode);
        ASSERT_EQ(found.has_value(), limbs.assembles);
        if (!found) continue;
        ++compared;
        expect_motion(*found, at, limbs.q);
      }
  }
  EXPECT_GE(compared, 400);
}

TEST(Influence, OfTheOthersInEveryAssembly) {
  crr::Uniform uniform(2);
  for (const std::string& name : crr::both()) {
    const Mechanism& mechanism = crr::mechanism(name);
    const std::vector<double> p = crr::nominal();
    const std::vector<Taylor> constant(p.begin(), p.end());
    for (int k = 0; k < 400; ++k) {
      const MotionSample at = random_sample(uniform, {0.2, 0.17, 0.22, 0.1});
      const auto found = mechanism.velocities()->influence(p, at.pose, mechanism.info().modes[0]);
      ASSERT_TRUE(found);
      const auto limbs = crr_cru::inverse(crr_cru::geometry(crr::platform(name), std::span<const Taylor>(constant)),
                                          moving(at), {-1, -1, 1, -1});
      expect_motion(*found, at, {limbs.limb[0].rho, limbs.limb[1].rho, limbs.limb[2].rho, limbs.limb[3].rho});
    }
  }
}

}  // namespace
}  // namespace pkm::testing
