// Studies with limits of joints and motors, and with the objectives cycle-time and energy.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/mechanism/trajectory.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using testing::all_catalogues;
using ::testing::HasSubstr;

const std::string kMotorTable = R"([[motor]]
name = "small"
continuous_torque = 0.64
peak_torque = 1.91
speed = 524
rotor_inertia = 1.7e-5
)";
const std::string kGearTable = "[[drive_train]]\njoint = \"all\"\ngear = 10\n";
const std::string kCycleTime = "[[output]]\ntype = \"cycle-time\"\nmotion = \"cycle\"\n";

Study delta_study(const std::string& more) {
  const std::string text = R"([mechanism]
file = "rotary-delta.toml"
[variables]
l_a = { min = 0.15, max = 0.3 }
[workspace]
method = "voxels"
cells = { x = 6, y = 6, z = 6 }
[[motion]]
name = "cycle"
type = "pick-and-place"
x = -0.1525
y = 0
z = -0.5
lift = 0.025
reach = 0.305
lift_time = 0.08
reach_time = 0.2
cycle = "whole"
)";
  return read_study_toml(text + more, "s.toml", all_catalogues(),
                         SourceText{test::text_of_mechanism("rotary-delta"), "rotary-delta.toml"});
}
std::string delta_complaint(const std::string& more) {
  try {
    delta_study(more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}
std::vector<double> outputs_of(const Study& study) {
  return study.problem->report(study.problem->parts().parameters).reports;
}

TEST(MotorOfAStudy, GivesInertiaAndLimits) {
  const Study study =
      delta_study(kMotorTable + kGearTable + "motor = \"small\"\npeak_speed = 30\npeak_force = \"25 N m\"\n");
  const Mechanism& mechanism = *study.problem->parts().mechanism;
  EXPECT_EQ(mechanism.drive_trains()->at(1).rotor, 1.7e-5);
  const std::vector<JointLimits> limits = joint_limits(mechanism);
  ASSERT_EQ(limits.size(), 3u);
  EXPECT_EQ(limits[2].motor.value().peak_torque, 1.91);
  EXPECT_EQ(limits[2].speed, 30);
  EXPECT_EQ(limits[2].force, 25);
  EXPECT_FALSE(std::isfinite(limits[2].acceleration));
}

TEST(MotorOfAStudy, CountsInQuantitiesLikeItsRotorInertia) {
  const std::string mass = "[[output]]\ntype = \"quantity\"\nquantity = \"effective_mass\"\nstatistic = \"mean\"\n";
  const double named = outputs_of(delta_study(kMotorTable + kGearTable + "motor = \"small\"\n" + mass))[0];
  const double given = outputs_of(delta_study(kGearTable + "rotor_inertia = 1.7e-5\n" + mass))[0];
  EXPECT_EQ(named, given);
  EXPECT_GT(named, outputs_of(delta_study(kGearTable + mass))[0]);
}

TEST(MotorOfAStudy, ErrorsNameTheKey) {
  const std::string motor = kMotorTable + kGearTable;
  EXPECT_THAT(delta_complaint(motor + "motor = \"smal\"\n"), HasSubstr("did you mean 'small'"));
  EXPECT_THAT(delta_complaint(kGearTable + "motor = \"small\"\n"), HasSubstr("the study has no [[motor]]"));
  EXPECT_THAT(delta_complaint(motor + "motor = \"small\"\nrotor_inertia = 1e-5\n"), HasSubstr("give one of them"));
  const auto curve = [](const std::string& points) { return kMotorTable + "curve = [" + points + "]\n"; };
  EXPECT_THAT(delta_complaint(curve("{ speed = 0, torque = 1 }, { speed = 0, torque = 1 }")),
              HasSubstr("more than that of the previous point"));
  EXPECT_THAT(delta_complaint(curve("{ speed = 0, torque = 2 }, { speed = 9, torque = 1 }")),
              HasSubstr("at most peak_torque"));
  EXPECT_THAT(delta_complaint(curve("{ speed = 0, torque = 1 }")), HasSubstr("at least two points"));
}

TEST(CycleTimeOfAStudy, DependsOnItsLimits) {
  EXPECT_THAT(delta_complaint(kCycleTime), HasSubstr("no limit of acceleration, force or torque bounds the time"));
  EXPECT_THAT(delta_complaint(kCycleTime + "tool_acceleration = 5\nnodes = 7\n"), HasSubstr("expected an even number"));
  EXPECT_THAT(delta_complaint("[[drive_train]]\njoint = \"all\"\npeak_force = \"100*l_a\"\n" + kCycleTime),
              HasSubstr("peak_force of joint arm1 is a formula"));
  const double tool = outputs_of(delta_study(kCycleTime + "tool_acceleration = 165\n"))[0];
  EXPECT_NEAR(tool, 2 * (2 * std::sqrt(0.025) + std::sqrt(0.305)) * std::sqrt(4 / 165.0), 1e-9);
  const std::string slow = "[[drive_train]]\njoint = \"all\"\npeak_acceleration = 100\npeak_speed = 5\n";
  const double accelerations = outputs_of(delta_study(slow + kCycleTime))[0];
  const double both = outputs_of(delta_study(slow + kCycleTime + "tool_acceleration = 165\n"))[0];
  EXPECT_GE(both, std::max(tool, accelerations) * (1 - 1e-12));
  EXPECT_LE(both, tool + accelerations);
}

TEST(EnergyOfAStudy, IsThatOfTheTrajectory) {
  const auto energy = [](bool recuperation) {
    return std::string("[[output]]\ntype = \"energy\"\nmotion = \"cycle\"\nrecuperation = ") +
           (recuperation ? "true\nname = \"net\"\n" : "false\n");
  };
  const Study bare = delta_study(energy(false) + energy(true));
  const auto along = [](const Study& study) {
    const ProblemParts& parts = study.problem->parts();
    return compute_trajectory(*parts.mechanism, parts.parameters, parts.mechanism->info().modes.front(),
                              parts.plan.limits, *study.motions[0].motion, 201);
  };
  const TrajectorySummary summary = along(bare).summary;
  EXPECT_NEAR(outputs_of(bare)[0], summary.energy_drawn, 1e-12);
  EXPECT_NEAR(outputs_of(bare)[1], summary.energy, 1e-12);

  const Study geared = delta_study(kGearTable + "efficiency = 0.8\ncoulomb = 0.4\n" + energy(false));
  double drawn = 0;
  const Trajectory trajectory = along(geared);
  for (std::size_t k = 1; k < trajectory.points.size(); ++k)
    for (const std::size_t end : {k - 1, k}) {
      const TrajectoryPoint& point = trajectory.points[end];
      for (std::size_t i = 0; i < 3; ++i)
        drawn += std::max((*point.torques)[i] * (*point.motor_speeds)[i], 0.0) * 0.5 * trajectory.duration / 200;
    }
  EXPECT_NEAR(outputs_of(geared)[0], drawn, 1e-12);
  EXPECT_GT(drawn, summary.energy_drawn);
}

// A second table of the joint adds to the limits of the first.
TEST(FastestStudy, TablesOfOneJointAddTheirLimits) {
  const std::string speed = "[[drive_train]]\njoint = \"all\"\npeak_speed = 5\n";
  const std::string stiffness = "[[drive_train]]\njoint = \"arm1\"\nstiffness = 1e6\n";
  const std::string acceleration = "[[drive_train]]\njoint = \"all\"\npeak_acceleration = 100\n";
  EXPECT_EQ(outputs_of(delta_study(speed + stiffness + acceleration + kCycleTime)),
            outputs_of(delta_study("[[drive_train]]\njoint = \"all\"\npeak_speed = 5\npeak_acceleration = 100\n" +
                                   kCycleTime)));
}

}  // namespace
}  // namespace pkm
