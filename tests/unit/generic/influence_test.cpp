// Influence coefficients of the catalogue's mechanisms against differences of the inverse kinematics along a motion.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/accelerators/crr_cru/golden.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

/// The pose at time t of a motion with constant acceleration.
Pose<double> pose_at(const MotionSample& start, double t) {
  return start.pose + start.velocity * t + start.acceleration * (t * t / 2);
}

TEST(Influence, GivesTheRatesOfTheJointsInEveryMode) {
  constexpr double kStep = 1e-4;                           // [s]
  constexpr double kSpeeds = 1e-6, kAccelerations = 1e-5;  // truncation, and rounding over the step and its square
  const std::map<std::string, Pose<double>> centres = {{"4ppa-2par", {0.3, 0.85, -0.8, 0.1}},
                                                       {"3crr-r-cru", {0.2, 0.17, 0.22, 0.1}},
                                                       {"quadrupteron", {0.2, 0.17, 0.22, 0.1}},
                                                       {"2t1r-p-hybrid", {0.02, 0.03, 0.22, 0.1}}};
  testing::crr::Uniform uniform(1);
  for (const auto& [name, centre] : centres) {
    const Mechanism& mechanism = **std::ranges::find(all_mechanisms(), name, &MechanismEntry::name);
    const std::vector<double> p = test::nominal(mechanism.info());
    const LimitSpec none = no_limits(mechanism.info());
    int compared = 0;
    for (int k = 0; k < 50; ++k) {
      MotionSample at;
      at.pose = centre;
      at.velocity = at.acceleration = AxisVector<double>(4);
      for (std::size_t i = 0; i < 4; ++i) {
        at.pose[i] += uniform(-0.02, 0.02);
        at.velocity[i] = uniform(-0.3, 0.3);
        at.acceleration[i] = uniform(-0.3, 0.3);
      }
      for (const std::string& mode : mechanism.info().modes) {
        const auto found = mechanism.velocities()->influence(p, at.pose, mode);
        const auto joints = [&](double t) { return mechanism.inspect(p, pose_at(at, t), mode, none).joints; };
        const auto before = joints(-kStep), now = joints(0), after = joints(kStep);
        if (!found || !mechanism.inspect(p, at.pose, mode, none).assembles) continue;
        ++compared;
        const AxisVector<double> speeds = found->G * at.velocity,
                                 changes = accelerations(*found, at.velocity, at.acceleration);
        for (std::size_t i = 0; i < 4; ++i) {
          EXPECT_NEAR(speeds[i], ((*after)[i] - (*before)[i]) / (2 * kStep), kSpeeds * (1 + std::fabs(speeds[i])));
          EXPECT_NEAR(changes[i], ((*after)[i] - 2 * (*now)[i] + (*before)[i]) / (kStep * kStep),
                      kAccelerations * (1 + std::fabs(changes[i])));
        }
      }
    }
    EXPECT_GE(compared, 50) << name;
  }
}

}  // namespace
}  // namespace pkm
