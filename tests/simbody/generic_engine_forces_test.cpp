// The generic engine against Simbody: drive forces of the rotary Delta and the Gough platform of
// experiments/mechanisms, and forces in the joints at their platforms, along a cycle and at random states under
// wrenches.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "engine/core/catalogue.hpp"
#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/math/random.hpp"
#include "engine/motion/motion_factories.hpp"
#include "tests/simbody/delta_and_gough.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::simbody {
namespace {

constexpr double kAccuracy = 1e-9;  // relative to the largest force of a state

std::vector<double> defaults(const MechanismInfo& info) {
  std::vector<double> design;
  for (const Parameter& p : info.parameters) design.push_back(p.nominal);
  return design;
}
double parameter(const MechanismInfo& info, const std::string& name) {
  return find_named(info.parameters, name)->nominal;
}

/// The parameters of the mechanism files, with masses and inertias derived by hand.
DeltaParameters delta() {
  const MechanismInfo& info = test::described("rotary-delta")->info();
  const double l_a = parameter(info, "l_a"), l_b = parameter(info, "l_b");
  const double crank = 2700 * kPi / 4 * (0.03 * 0.03 - 0.026 * 0.026) * l_a, rod = 0.12 * l_b;
  return {.R = parameter(info, "R"),
          .r = parameter(info, "r"),
          .l_a = l_a,
          .l_b = l_b,
          .crank_mass = crank,
          .crank_inertia = crank * (l_a * l_a / 12 + (0.03 * 0.03 + 0.026 * 0.026) / 16),
          .rod_mass = rod,
          .rod_inertia = rod * l_b * l_b / 12,
          .platform_mass = 0.25};
}
GoughParameters gough() {
  const MechanismInfo& info = test::described("gough")->info();
  const double r = parameter(info, "r");
  return {.R = parameter(info, "R"),
          .r = r,
          .a_b = parameter(info, "a_b"),
          .a_p = parameter(info, "a_p"),
          .cylinder_mass = 12,
          .cylinder_centre = 0.45,
          .cylinder_inertia = 1,
          .piston_mass = 6,
          .piston_centre = 0.4,
          .piston_inertia = 0.5,
          .platform_mass = 40,
          .platform_inertia = {10 * r * r, 10 * r * r, 20 * r * r}};
}

/// Compares the generic engine with Simbody at states of one mechanism.
class Comparison {
 public:
  template <class Parameters>
  Comparison(const std::string& name, const Parameters& parameters)
      : mechanism_(*test::described(name)), design_(defaults(mechanism_.info())), loops_(parameters) {}

  void check(const Pose<double>& pose, const AxisVector<double>& velocity, const AxisVector<double>& acceleration,
             const Wrench<double>& wrench) {
    const auto list = [](const AxisVector<double>& v) { return std::vector<double>(v.begin(), v.end()); };
    const LoopSolution theirs = loops_.solve({list(pose), list(velocity), list(acceleration), wrench.m});
    const MotionState<double> state{pose, velocity};
    PoseDynamics<double> d;
    mechanism_.dynamics()->equations(std::span<const double>(design_), mechanism_.info().modes.front(), {&state, 1},
                                     {&d, 1});
    ASSERT_TRUE(d.assembles);
    const AxisVector<double> ours = drive_forces(d, acceleration, wrench);
    double largest = 0, error = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      largest = std::max(largest, std::fabs(theirs.drive_forces[i]));
      error = std::max(error, std::fabs(ours[i] - theirs.drive_forces[i]));
    }
    EXPECT_LE(error, kAccuracy * largest) << "at " << pose[0] << ", " << pose[1] << ", " << pose[2];
    check_joints(theirs,
                 mechanism_.reactions()->find(design_, mechanism_.info().modes.front(), state, acceleration, wrench));
    EXPECT_LE(theirs.closure_error, 1e-9);
    EXPECT_LE(theirs.force_error, 1e-9 * largest);
    ++compared_;
  }
  /// Compares `count` random states of motion at feasible poses in a box with half sizes `reach`.
  void check_random(const Pose<double>& centre, const Pose<double>& reach, int count) {
    Stream random(17, 0, 0, Stream::Use::start);
    const std::size_t n = centre.size();
    const auto random_vector = [&](double scale) {
      AxisVector<double> v(n);
      for (double& x : v) x = scale * (2 * random.u01() - 1);
      return v;
    };
    while (compared_ < count) {
      Pose<double> pose = centre;
      for (std::size_t i = 0; i < n; ++i) pose[i] += reach[i] * (2 * random.u01() - 1);
      const PoseReport report =
          mechanism_.inspect(design_, pose, mechanism_.info().modes.front(), no_limits(mechanism_.info()));
      if (!report.feasible || report.conditioning.value_or(1) < 0.02) continue;
      Wrench<double> wrench;
      for (std::size_t i = 0; i < 6; ++i) wrench[i] = (i < 3 ? 50 : n < 6 ? 0 : 10) * (2 * random.u01() - 1);
      check(pose, random_vector(2), random_vector(20), wrench);
    }
  }

 private:
  /// Compares the forces on the limbs at the platform; those of a pair of rods are added.
  void check_joints(const LoopSolution& theirs, const Reactions& ours) {
    ASSERT_EQ(ours.reason, "");
    ASSERT_EQ(theirs.at_platform.size(), 3 * theirs.drive_forces.size());
    std::map<std::string, Vector<double, 3>> sum;
    std::vector<std::string> limbs;
    for (const JointReaction& joint : ours.joints) {
      const auto end = joint.name.find(".B");
      if (end == std::string::npos) continue;
      const std::string limb = joint.name.substr(0, end);
      if (!sum.contains(limb)) limbs.push_back(limb);
      for (std::size_t k = 0; k < 3; ++k) sum[limb][k] += joint.force[k].value();
    }
    ASSERT_EQ(limbs.size(), theirs.drive_forces.size());
    double largest = 0;
    for (const double force : theirs.at_platform) largest = std::max(largest, std::fabs(force));
    for (std::size_t i = 0; i < limbs.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(sum[limbs[i]][k], theirs.at_platform[3 * i + k], kAccuracy * largest) << limbs[i];
  }

  const Mechanism& mechanism_;
  std::vector<double> design_;
  DeltaOrGough loops_;
  int compared_ = 0;
};

TEST(GenericEngineForces, DeltaAlongACycle) {
  Comparison comparison("rotary-delta", delta());
  const auto cycle = pick_and_place({.axes = {.x = 0, .y = 1, .z = 2, .turn = {}},
                                     .start = {-0.1, 0.05, -0.45},
                                     .reach = 0.2,
                                     .overlap = 0.02,
                                     .direction = 0.4,
                                     .back = true});
  for (const MotionSample& at : sample(*cycle, 101)) comparison.check(at.pose, at.velocity, at.acceleration, {});
}

TEST(GenericEngineForces, DeltaAtRandomStates) {
  Comparison("rotary-delta", delta()).check_random({0, 0, -0.45}, {0.25, 0.25, 0.15}, 1000);
}

TEST(GenericEngineForces, GoughPlatformAtRandomStates) {
  Comparison("gough", gough()).check_random({0, 0, 1.3, 0, 0, 0}, {0.3, 0.3, 0.2, 0.4, 0.4, 0.4}, 1000);
}

}  // namespace
}  // namespace pkm::simbody
