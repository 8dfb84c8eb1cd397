// Drive trains: their law, mechanisms that have them, and studies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "constraints/all.hpp"
#include "engine/config/study.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/dynamics/motor.hpp"
#include "engine/dynamics/simulation.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "objectives/all.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;

const DriveTrain kTrain = {
    .ratio = 50, .rotor = 2e-5, .shaft = 1e-5, .efficiency = 0.8, .coulomb = 3, .viscous = 10, .slow = 1e-3};

TEST(DriveTrain, DrivesWithTheLoadOverTheEfficiencyAndBrakesWithTheLoadTimesIt) {
  const double friction = 3 + 10 * 0.5, fast = 1e-5;  // of 1, by what the direction is off
  EXPECT_NEAR(kTrain.torque(20.0, 0.5, 0.0), (20 + friction) / 0.8 / 50, fast);
  EXPECT_NEAR(kTrain.torque(-20.0, 0.5, 0.0), (-20 + friction) * 0.8 / 50, fast);
  EXPECT_NEAR(kTrain.torque(-20.0, -0.5, 0.0), (-20 - friction) / 0.8 / 50, fast);
  EXPECT_NEAR(kTrain.torque(20.0, 0.5, 4.0) - kTrain.torque(20.0, 0.5, 0.0), 3e-5 * 50 * 4, 1e-15);
  EXPECT_NEAR(kTrain.torque(20.0, 0.0, 0.0), 20 * (1 / 0.8 + 0.8) / 2 / 50, 1e-15);
  EXPECT_EQ(kTrain.friction(0.0), 0);
  EXPECT_NEAR(kTrain.friction(1e-3), 3 / std::sqrt(2.0) + 0.01, 1e-12);
  EXPECT_NEAR(kTrain.reflected(), 3e-5 * 2500, 1e-15);
  EXPECT_NEAR((DriveTrain{.ratio = 4}.torque(20.0, 0.5, 3.0)), 5, 1e-12) << "nothing but a gear";
}

TEST(Motor, FitsByItsWorstLimit) {
  const Motor motor{.name = "M", .continuous_torque = 1, .peak_torque = 3, .speed = 100, .rotor = 0};
  const DriveTrain gear{.ratio = 10};
  const JointLoad still{20, 0, 0}, moving{-10, 4, 0};
  const MotorFit found = fit(motor, gear, std::array{still, moving});
  EXPECT_NEAR(found.peak_torque, 2, 1e-12);
  EXPECT_NEAR(found.rms_torque, std::sqrt((4 + 1) / 2.0), 1e-12);
  EXPECT_NEAR(found.speed, 40, 1e-12);
  EXPECT_NEAR(found.reserve, 1 / std::sqrt(2.5), 1e-12);
  EXPECT_EQ(found.bounded_by, "continuous torque");
  EXPECT_EQ(fit({"M", 10, 3, 100, 0}, gear, std::array{still}).bounded_by, "peak torque");
  EXPECT_EQ(fit({"M", 10, 30, 41, 0}, gear, std::array{moving}).bounded_by, "speed");
}

DriveTrains trains_for(const MechanismInfo& info) {
  DriveTrains trains(info.joints.size(), kTrain);
  if (info.name != "4ppa-2par") trains.back().rotor = 9e-5;
  return trains;
}

std::vector<std::shared_ptr<const Mechanism>> with_dynamics() {
  std::vector<std::shared_ptr<const Mechanism>> all;
  for (const auto& mechanism : all_mechanisms())
    if (mechanism->dynamics()) all.push_back(mechanism);
  for (const char* file : {"rotary-delta", "3crr-r-cru", "3-rpr"}) all.push_back(test::described(file));
  return all;
}

TEST(DrivenMechanism, SurveysTheInertiaThatItsEquationsHave) {
  for (const auto& bare : with_dynamics()) {
    const MechanismInfo& info = bare->info();
    SCOPED_TRACE(info.name);
    const auto driven = with_drive_trains(bare, trains_for(info));
    const std::vector<double> design = test::nominal(info);
    std::vector<WorkspacePlan> plans;
    std::array<std::int64_t, 3> cells{1, 1, 1};
    for (std::size_t i = 0; i < info.sweeps.front().swept.size(); ++i) cells[i] = 7;
    plans.push_back({.method = VoxelOptions{.cells = cells}, .fixed = {}, .limits = no_limits(info)});
    if (bare->columns())
      plans.push_back({.method = ColumnOptions{.nodes = {2, 2}}, .fixed = {}, .limits = no_limits(info)});
    for (const WorkspacePlan& plan : plans) {
      const FieldRequest request{.fields = {&kCouplingIndex, &kInertiaCondition}, .poses = true};
      const WorkspaceResult<double> survey = test::survey(*driven, design, plan, request);
      ASSERT_GT(survey.pose.size(), 3u);
      for (std::size_t k = 0; k < survey.pose.size(); ++k) {
        const MotionState<double> state{survey.pose[k], AxisVector<double>(info.coordinates.size())};
        PoseDynamics<double> with, without;
        driven->dynamics()->equations(std::span<const double>(design), info.modes.front(), {&state, 1}, {&with, 1});
        bare->dynamics()->equations(std::span<const double>(design), info.modes.front(), {&state, 1}, {&without, 1});
        if (is_singular(with.J)) continue;
        AxisMatrix<double> M_q = joint_inertia(without);
        for (std::size_t i = 0; i < M_q.rows(); ++i) M_q(i, i) += trains_for(info)[i].reflected();
        const AxisMatrix<double> found = joint_inertia(with);
        const auto indices = coupling_indices(M_q);
        for (std::size_t i = 0; i < M_q.rows(); ++i) {
          EXPECT_NEAR(found(i, i), M_q(i, i), 1e-10 * M_q(i, i));
          EXPECT_NEAR(survey.field(kCouplingIndex, i)[k], indices[i], 1e-9);
        }
        EXPECT_NEAR(survey.field(kInertiaCondition)[k], inertia_condition(M_q), 1e-9);
      }
    }
  }
}

TEST(DrivenMechanism, ForcesTakeRotorsAlong) {
  for (const auto& bare : with_dynamics()) {
    const MechanismInfo& info = bare->info();
    const auto driven = with_drive_trains(bare, trains_for(info));
    const std::vector<double> design = test::nominal(info);
    const Pose<double> pose = test::reference_pose(*bare);
    AxisVector<double> velocity(pose.size()), acceleration(pose.size());
    for (std::size_t i = 0; i < pose.size(); ++i) {
      velocity[i] = 0.3 + 0.2 * static_cast<double>(i);
      acceleration[i] = 4 - 1.5 * static_cast<double>(i);
    }
    const MotionState<double> state{pose, velocity};
    PoseDynamics<double> with, without;
    driven->dynamics()->equations(std::span<const double>(design), info.modes.front(), {&state, 1}, {&with, 1});
    bare->dynamics()->equations(std::span<const double>(design), info.modes.front(), {&state, 1}, {&without, 1});
    ASSERT_TRUE(with.assembles) << info.name;
    const AxisVector<double> joints = with.J * acceleration + with.J_rate_X;
    const AxisVector<double> mine = drive_forces(with, acceleration, {}),
                             theirs = drive_forces(without, acceleration, {});
    for (std::size_t i = 0; i < mine.size(); ++i) {
      const double expected = theirs[i] + trains_for(info)[i].reflected() * joints[i];
      EXPECT_NEAR(mine[i], expected, 1e-10 * (1 + std::fabs(expected))) << info.name;
    }
  }
}

/// The accelerator of 4PPa-2PaR lets a sample stand for mirrored poses, in which the sliders of a rail change places:
/// drive trains that differ on one rail are left to the generic engine.
TEST(DrivenMechanism, MayHaveDifferentDrivesOnOneRail) {
  const auto paper = std::ranges::find(all_mechanisms(), "4ppa-2par", &MechanismEntry::name);
  DriveTrains trains(4, kTrain);
  trains[1].rotor *= 5;
  const auto driven = with_drive_trains(*paper, trains),
             generic = with_drive_trains(test::described("4ppa-2par"), trains);
  const WorkspacePlan plan{
      .method = VoxelOptions{.cells = {6, 6, 6}}, .fixed = {}, .limits = no_limits(driven->info())};
  const FieldRequest request{.fields = {&kCouplingIndex}};
  const std::vector<double> design = test::nominal(driven->info());
  WorkspaceResult<double> found, expected;
  evaluate_once<double>(*prepare_workspace(*driven, plan, request), design, found);
  evaluate_once<double>(*prepare_workspace(*generic, plan, request), design, expected);
  EXPECT_GT(found.feasible_cells, 10);
  EXPECT_EQ(found.field(kCouplingIndex), expected.field(kCouplingIndex));
}

TEST(DrivenMechanism, FrictionTakesWhatASimulationLoses) {
  const Mechanism& delta = *test::described("rotary-delta");
  const DriveTrain train{.rotor = 0.01, .coulomb = 0.5, .viscous = 0.2, .slow = 0.02};
  const auto driven = with_drive_trains(test::described("rotary-delta"), {train, train, train});
  const std::vector<double> design = test::nominal(delta.info());
  const SimulationSetup setup{.dynamics =
                                  [&](const MotionState<double>& state) {
                                    PoseDynamics<double> d;
                                    driven->dynamics()->equations(std::span<const double>(design),
                                                                  delta.info().modes.front(), {&state, 1}, {&d, 1});
                                    return d;
                                  },
                              .forces =
                                  [](double) {
                                    return AxisVector<double>{-1.5, -1.4, -1.3};
                                  },
                              .friction =
                                  [&](const AxisVector<double>& speeds) {
                                    AxisVector<double> forces = speeds;
                                    for (std::size_t i = 0; i < 3; ++i) forces[i] = train.friction(speeds[i]);
                                    return forces;
                                  },
                              .wrench = {},
                              .refuse = {},
                              .duration = 0.2,
                              .step = 0.0005};
  const Simulation run = simulate(setup, {0, 0, -0.45}, {0.4, -0.2, 0.1});
  EXPECT_EQ(run.stopped, "");
  EXPECT_LE(run.imbalance, 1e-9 * run.turned_over);
  EXPECT_LT(run.states.back().work_of_friction, -0.01);
}

const std::string kStudy = R"(
[mechanism]
type = "3crr-r-cru"
[variables]
l_11 = { min = 0.12, max = 0.35 }
[[motion]]
name = "cycle"
type = "pick-and-place"
x = "30 mm"
y = "170 mm"
z = "190 mm"
phi = 0
lift = "25 mm"
reach = "305 mm"
direction = 0
lift_time = "120 ms"
reach_time = "400 ms"
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "ga"
)";
const std::string kDrives =
    "[[drive_train]]\njoint = \"all\"\nlead = \"20 mm\"\nrotor_inertia = 3e-5\nefficiency = 0.9\ncoulomb = \"2 N\"\n";

Study read_study(const std::string& more) {
  return read_study_toml(kStudy + more, "s.toml",
                         {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

TEST(DriveTrainStudy, ObjectivesAreThoseOfTheTrajectory) {
  std::string text = kDrives;
  for (const char* statistic : {"peak", "rms"})
    text += "[[output]]\ntype = \"motor-torque\"\nname = \"" + std::string(statistic) +
            "\"\nmotion = \"cycle\"\nstatistic = \"" + statistic + "\"\n";
  text += "[[output]]\ntype = \"motor-speed\"\nmotion = \"cycle\"\njoint = \"2\"\n";
  const Study study = read_study(text);
  const DesignReport report = study.problem->report(study.problem->parts().parameters);
  const Mechanism& mechanism = *study.problem->parts().mechanism;
  const Trajectory along =
      compute_trajectory(mechanism, study.problem->parts().parameters, mechanism.info().modes.front(),
                         no_limits(mechanism.info()), *study.motions.front().motion, 201);
  EXPECT_NEAR(report.reports[0], std::ranges::max(along.summary.peak_torque), 1e-12);
  EXPECT_NEAR(report.reports[1], std::ranges::max(along.summary.rms_torque), 1e-12);
  EXPECT_NEAR(report.reports[2], along.summary.peak_motor_speed[1], 1e-12);
  EXPECT_GT(report.reports[0], report.reports[1]);
  EXPECT_THAT(describe(study), HasSubstr("reflected inertia"));
}

TEST(DriveTrainStudy, PeakAndRmsOfMotorTorqueHaveTheirOwnNames) {
  const std::string torque = "type = \"motor-torque\"\nmotion = \"cycle\"\n", rms = "statistic = \"rms\"\n";
  const Study study =
      read_study(kDrives + "[[output]]\n" + torque + "[[output]]\n" + torque + rms + "[[constraint]]\n" + torque +
                 "max = 5\n[[constraint]]\n" + torque + rms + "max = 2\n");
  EXPECT_THAT(names_of(study.problem->reports()), ::testing::ElementsAre("motor-torque", "motor-torque-rms"));
  EXPECT_THAT(names_of(study.problem->margins()),
              ::testing::ElementsAre("motor-torque", "motor-torque-rms", "motion-cycle"));
}

std::string message_of(const std::string& more) {
  try {
    read_study(more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DriveTrainStudy, MistakesAreNamed) {
  EXPECT_EQ(message_of(kDrives), "accepted");
  EXPECT_THAT(message_of("[[drive_train]]\njoint = \"rho5\"\nlead = 0.01\n"), HasSubstr("rho4"));
  EXPECT_THAT(message_of("[[drive_train]]\njoint = \"rho1\"\nlead = 0.01\n"),
              HasSubstr("the joint rho2 has no drive train; give one for every joint, or none"));
  EXPECT_THAT(message_of(kDrives + "[[drive_train]]\njoint = \"rho1\"\nlead = 0.01\n"),
              HasSubstr("the joint rho1 has a drive train already"));
  EXPECT_THAT(message_of("[[drive_train]]\njoint = \"all\"\n"), HasSubstr("per revolution of its screw"));
  EXPECT_THAT(message_of("[[drive_train]]\njoint = \"all\"\nlead = 0\n"), HasSubstr("a number > 0 m"));
  EXPECT_THAT(message_of(kDrives + "gera = 3\n"), HasSubstr("did you mean 'gear'?"));
  EXPECT_THAT(message_of("[[objective]]\ntype = \"motor-torque\"\nmotion = \"cycle\"\n"),
              HasSubstr("objective motor-torque needs drive trains, and mechanism 3crr-r-cru has none"));
}

}  // namespace
}  // namespace pkm
