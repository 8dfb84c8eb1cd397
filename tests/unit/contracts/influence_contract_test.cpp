// Contract of influence coefficients (first and second derivatives of the joints with respect to the pose), for every
// mechanism that provides them, along a motion of its nominal design.
#include <gtest/gtest.h>

#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

class InfluenceContract : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    if (!mechanism().velocities()) GTEST_SKIP() << info().name << " has no influence coefficients";
  }
  const Mechanism& mechanism() const { return *test::test_mechanism(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::size_t joints() const { return info().joints.size(); }
  std::size_t coordinates() const { return info().coordinates.size(); }
  std::vector<double> parameters() const { return test::nominal(info()); }
  PoseReport inspect(const Pose<double>& pose) const {
    return mechanism().inspect(parameters(), pose, info().modes[0], no_limits(info()));
  }
  Influence<double> at(const Pose<double>& pose) const {
    return *mechanism().velocities()->influence(parameters(), pose, info().modes[0]);
  }
  std::shared_ptr<const Motion> motion() const { return test::motions(mechanism())[0].motion; }
  std::vector<MotionSample> samples() const { return sample(*motion(), 21); }
};

TEST_P(InfluenceContract, FirstOrderIsTheJacobianOfThePose) {
  for (const MotionSample& now : samples()) {
    const AxisMatrix<double> J = *inspect(now.pose).J, G = at(now.pose).G;
    ASSERT_EQ(G.rows(), joints());
    ASSERT_EQ(G.cols(), coordinates());
    for (std::size_t i = 0; i < joints(); ++i)
      for (std::size_t j = 0; j < coordinates(); ++j) EXPECT_NEAR(G(i, j), J(i, j), 1e-12 * (1 + std::fabs(J(i, j))));
  }
}

TEST_P(InfluenceContract, SecondOrderIsSymmetricAndEqualsFiniteDifferences) {
  constexpr double kStep = 1e-5;
  for (const MotionSample& now : samples()) {
    const Influence<double> q = at(now.pose);
    for (std::size_t c = 0; c < coordinates(); ++c) {
      const auto moved = [&](double by) {
        Pose<double> there = now.pose;
        there[c] += by;
        return at(there).G;
      };
      const auto expected = (moved(kStep) - moved(-kStep)) * (1 / (2 * kStep));
      for (std::size_t i = 0; i < joints(); ++i)
        for (std::size_t k = 0; k < coordinates(); ++k) {
          EXPECT_EQ(q.H[i](k, c), q.H[i](c, k));
          EXPECT_NEAR(q.H[i](k, c), expected(i, k), 1e-6 * (1 + std::fabs(expected(i, k))));
        }
    }
  }
}

TEST_P(InfluenceContract, PredictJointSpeedsAndAccelerations) {
  constexpr double kStep = 1e-4;  // [s]
  for (const double time : {0.1, 0.35, 0.62, 0.9}) {
    const MotionSample now = motion()->at(time);
    const auto joints_at = [&](double t) { return *inspect(motion()->at(t).pose).joints; };
    const AxisVector<double> before = joints_at(time - kStep), here = joints_at(time), after = joints_at(time + kStep);
    const Influence<double> q = at(now.pose);
    const AxisVector<double> speeds = q.G * now.velocity, drives = accelerations(q, now.velocity, now.acceleration);
    for (std::size_t i = 0; i < joints(); ++i) {
      EXPECT_NEAR(speeds[i], (after[i] - before[i]) / (2 * kStep), 1e-6);
      EXPECT_NEAR(drives[i], (after[i] - here[i] * 2 + before[i]) / (kStep * kStep), 1e-4);
    }
  }
}

TEST_P(InfluenceContract, InverseCoefficientsRecoverThePlatformMotion) {
  if (joints() != coordinates()) GTEST_SKIP() << "redundant drives";
  for (const double time : {0.1, 0.35, 0.62, 0.9}) {
    const MotionSample now = motion()->at(time);
    const Influence<double> q = at(now.pose), back = reversed(q);
    const AxisVector<double> speeds = q.G * now.velocity, drives = accelerations(q, now.velocity, now.acceleration),
                             velocity = back.G * speeds, acceleration = accelerations(back, speeds, drives);
    for (std::size_t i = 0; i < coordinates(); ++i) {
      EXPECT_NEAR(velocity[i], now.velocity[i], 1e-12);
      EXPECT_NEAR(acceleration[i], now.acceleration[i], 1e-11);
    }
  }
}

TEST_P(InfluenceContract, AreAbsentOutOfReach) {
  if (inspect(test::unreachable_pose(info())).assembles) GTEST_SKIP() << "without limits every pose is reachable";
  EXPECT_FALSE(mechanism().velocities()->influence(parameters(), test::unreachable_pose(info()), info().modes[0]));
}

INSTANTIATE_TEST_SUITE_P(All, InfluenceContract, testing::ValuesIn(test::mechanisms_and_all_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
