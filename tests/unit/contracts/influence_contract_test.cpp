// Laws of the influence coefficients of every mechanism that has them, along a motion of its nominal design.
#include <gtest/gtest.h>

#include "tests/unit/contracts/nominal.hpp"

namespace pkm {
namespace {

class InfluenceContract : public testing::TestWithParam<std::shared_ptr<const Mechanism>> {
 protected:
  void SetUp() override {
    if (!info().has_influence) GTEST_SKIP() << info().name << " has no influence coefficients";
  }
  const Mechanism& mechanism() const { return *GetParam(); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::vector<double> parameters() const { return test::nominal(info()); }
  Vector<double, 4> joints_at(const Pose<double>& pose) const {
    return {{*mechanism().inspect(parameters(), pose, info().modes[0], no_limits(info())).joints}};
  }
  Influence<double> at(const Pose<double>& pose) const {
    return *mechanism().influence(parameters(), pose, info().modes[0]);
  }
  std::vector<MotionSample> samples() const { return sample(*test::motions(info())[0].motion, 21); }
};

TEST_P(InfluenceContract, FirstOrderIsTheJacobianOfThePose) {
  for (const MotionSample& now : samples()) {
    const PoseReport report = mechanism().inspect(parameters(), now.as_pose(), info().modes[0], no_limits(info()));
    const Influence<double> q = at(now.as_pose());
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) EXPECT_NEAR(q.G(i, j), (*report.J)(i, j), 1e-12);
  }
}

TEST_P(InfluenceContract, SecondOrderIsSymmetricAndEqualsDifferences) {
  constexpr double kStep = 1e-5;
  for (const MotionSample& now : samples()) {
    const Influence<double> q = at(now.as_pose());
    for (std::size_t c = 0; c < 4; ++c) {
      const auto moved = [&](double by) {
        MotionSample there = now;
        there.pose[c] += by;
        return at(there.as_pose()).G;
      };
      const auto slope = (moved(kStep) - moved(-kStep)) * (1 / (2 * kStep));
      for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 4; ++k) {
          EXPECT_EQ(q.H[i](k, c), q.H[i](c, k));
          EXPECT_NEAR(q.H[i](k, c), slope(i, k), 1e-6 * (1 + std::fabs(slope(i, k))));
        }
    }
  }
}

TEST_P(InfluenceContract, JointsMoveAsTheySayAndThePlatformBack) {
  constexpr double kStep = 1e-4;  // [s]
  const auto motion = test::motions(info())[0].motion;
  for (const double time : {0.1, 0.35, 0.62, 0.9}) {
    const MotionSample now = motion->at(time);
    const auto joints = [&](double t) { return joints_at(motion->at(t).as_pose()); };
    const Vector<double, 4> before = joints(time - kStep), here = joints(time), after = joints(time + kStep);
    const Influence<double> q = at(now.as_pose()), back = reversed(q);
    const Vector<double, 4> speeds = q.G * now.velocity, drives = accelerations(q, now.velocity, now.acceleration),
                            velocity = back.G * speeds, acceleration = accelerations(back, speeds, drives);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(speeds[i], (after[i] - before[i]) / (2 * kStep), 1e-6);
      EXPECT_NEAR(drives[i], (after[i] - here[i] * 2 + before[i]) / (kStep * kStep), 1e-4);
      EXPECT_NEAR(velocity[i], now.velocity[i], 1e-12);
      EXPECT_NEAR(acceleration[i], now.acceleration[i], 1e-11);
    }
  }
}

TEST_P(InfluenceContract, AreAbsentOutOfReach) {
  EXPECT_FALSE(mechanism().influence(parameters(), {50, 50, 50, 0}, info().modes[0]));
}

INSTANTIATE_TEST_SUITE_P(All, InfluenceContract, testing::ValuesIn(all_mechanisms()),
                         [](const auto& mechanism) { return test::test_name(mechanism.param->info().name); });

}  // namespace
}  // namespace pkm
