// Multibody models of mechanisms in Simbody: joint positions where the loops are closed, and drive forces in motion
// under gravity and a wrench, compared with the inverse kinematics and the equations of motion.
#include "tests/simbody/multibody.hpp"
#include "tests/multibody/cases.hpp"

namespace pkm::simbody {
namespace {

constexpr double kAccuracy = 1e-9;  // of positions; of forces relative to the largest one of a state

class SimbodyMultibody : public testing::TestWithParam<test::MultibodyCase> {};

/// Motion of the platform frame. @param T  of PoseReport
PlatformState platform_state(const generic::RigidPose& at, const AxisMatrix<double>& T,
                             const AxisVector<double>& velocity, const AxisVector<double>& acceleration) {
  PlatformState state{at.origin, at.rotation, {}, Eigen::VectorXd(6), Eigen::VectorXd(6)};
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    double v = 0, a = 0;
    bool moves = false;
    for (std::size_t j = 0; j < T.cols(); ++j) {
      v += T(i, j) * velocity[j];
      a += T(i, j) * acceleration[j];
      moves = moves || T(i, j) != 0;
    }
    if (!moves) continue;
    state.rows.push_back(static_cast<int>((i + 3) % 6));
    state.velocity[count] = v;
    state.acceleration[count++] = a;
  }
  state.velocity.conservativeResize(count);
  state.acceleration.conservativeResize(count);
  return state;
}

TEST_P(SimbodyMultibody, FindsJointPositionsAndDriveForces) {
  const auto& [name, has_orientation] = GetParam();
  const test::NominalDesign mechanism(name);
  MultibodySystem simbody(mechanism.model());
  const std::vector<Pose<double>> poses = mechanism.poses(20);
  ASSERT_EQ(poses.size(), 20U);
  Stream random(37, 0, 0, Stream::Use::start);
  for (const Pose<double>& pose : poses) {
    const std::size_t n = pose.size();
    const auto random_vector = [&](double scale) {
      AxisVector<double> v(n);
      for (double& x : v) x = scale * (2 * random.u01() - 1);
      return v;
    };
    // with three rotations the twist of the platform is not constant for constant rates: at rest only
    const AxisVector<double> velocity = random_vector(n == 6 ? 0 : 2), acceleration = random_vector(20);
    const PoseReport report = mechanism.inspect(pose);
    simbody.reset();
    double residual = 1;
    PlatformState platform;
    for (const double fraction : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      platform =
          platform_state(mechanism.platform(mechanism.between(pose, fraction)), *report.T, velocity, acceleration);
      residual = simbody.assemble(platform, has_orientation);
    }
    ASSERT_LE(residual, 1e-12);
    Wrench<double> wrench;
    for (std::size_t i = 0; i < (has_orientation ? 6U : 3U); ++i) wrench[i] = (i < 3 ? 50 : 5) * (2 * random.u01() - 1);
    const MultibodySolution theirs = simbody.solve(platform, mechanism.wrench_point(pose), wrench.m);
    const AxisVector<double> ours = mechanism.forces({pose, velocity}, acceleration, wrench);
    ASSERT_EQ(theirs.forces.size(), ours.size());
    double largest = 0;
    for (const double force : theirs.forces) largest = std::max(largest, std::fabs(force));
    EXPECT_LE(theirs.closure_error, 1e-9);
    EXPECT_LE(theirs.force_error, 1e-9 * largest);
    for (std::size_t i = 0; i < ours.size(); ++i) {
      const double error = theirs.positions[i] - (*report.joints)[i];
      EXPECT_NEAR(mechanism.info().joints[i].turns() ? std::remainder(error, 2 * kPi) : error, 0, kAccuracy);
      EXPECT_NEAR(theirs.forces[i], ours[i], kAccuracy * largest);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, SimbodyMultibody, testing::ValuesIn(test::multibody_cases()), test::name_of_case);

}  // namespace
}  // namespace pkm::simbody
