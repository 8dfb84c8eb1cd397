// Theta = 90 degrees, where the platform turns without a slider: J is singular, and no forces give a motion. What
// divides by J has no number there, rather than one of 1e16 N.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/coupling.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/dynamics/simulation.hpp"
#include "engine/math/portable.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/motion/motion_factories.hpp"
#include "engine/problem/design_problem.hpp"
#include "objectives/all.hpp"
#include "tests/own_mechanisms/three_ropes.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

const pkm::Pose<double> kRegular = {0.35, 0.8, -0.8, 0}, kSingularPose = {0.35, 0.8, -0.8, kPi / 2};

pkm::PoseDynamics<double> dynamics_at(const pkm::Pose<double>& pose) {
  const std::vector<double> p = nominal();
  const pkm::MotionState<double> state{pose, AxisVector<double>(4)};
  pkm::PoseDynamics<double> found;
  four_ppa().dynamics()->equations(std::span<const double>(p), "lower,lower", {&state, 1}, {&found, 1});
  return found;
}

TEST(SingularPose, HasNoForcesAndNoInertiaOfTheJoints) {
  for (const double force : drive_forces(dynamics_at(kRegular), {0, 0, 0, 1}, {})) EXPECT_TRUE(std::isfinite(force));
  const pkm::PoseDynamics<double> d = dynamics_at(kSingularPose);
  ASSERT_TRUE(d.assembles);
  for (const double force : drive_forces(d, AxisVector<double>(4), {})) EXPECT_TRUE(std::isnan(force));
  for (const double element : joint_inertia(d)) EXPECT_TRUE(std::isnan(element));
}

/// The closed form of surveys has none either: such a cell counts as one without a coupling index.
TEST(SingularPose, HasNoInertiaInASurvey) {
  using namespace four_ppa_two_par;
  const std::vector<double> p = nominal();
  const std::span<const double> design = p;
  const auto inertia = [&](double cosine) {
    return joint_inertia<double>(geometry(design), masses(design), 1, cosine, {0.35, p[kB] - 0.35}, {0.4, 0.3},
                                 {-0.2, -0.3});
  };
  for (const double element : inertia(std::cos(kPi / 2))) EXPECT_TRUE(std::isnan(element));
  for (const double element : inertia(1e-3)) EXPECT_TRUE(std::isfinite(element));
}

/// To the singular pose, where it ends.
std::shared_ptr<const Motion> turn() { return point_to_point(kRegular, {{0, kSingularPose, 1}}, 0, TimeLaw::quintic); }

TEST(SingularPose, IsMarkedInATrajectory) {
  const Trajectory found =
      compute_trajectory(four_ppa(), nominal(), "lower,lower", no_limits(four_ppa().info()), *turn(), 11);
  for (std::size_t k = 0; k < 10; ++k) {
    EXPECT_TRUE(found.points[k].feasible) << found.points[k].reason;
    EXPECT_TRUE(found.points[k].forces) << k;
  }
  const TrajectoryPoint& last = found.points.back();
  EXPECT_FALSE(last.feasible);
  EXPECT_EQ(last.reason, "the Jacobian is singular to working precision");
  EXPECT_FALSE(last.forces || last.power);
  EXPECT_TRUE(last.speeds) << "J is finite: the speeds of the joints are known";
  EXPECT_EQ(found.summary.infeasible, 1u);
  EXPECT_FALSE(found.summary.has_forces);
}

TEST(SingularPose, FailsADesignWhosePeakForceIsLookedFor) {
  const ObjectiveEntry& entry = *find_named(all_objectives(), std::string("peak-force"));
  const DesignMotion named{{"turn", turn()}};
  Options options = default_options(entry.options);
  options.set("motion", std::string("turn"));
  options.set("samples", std::int64_t{11});
  ProblemParts parts;
  parts.mechanism = all_mechanisms().front();
  parts.parameters = nominal();
  parts.plan.limits = no_limits(four_ppa().info());
  parts.plan.method = ColumnOptions{.nodes = {1, 1}};
  const EntryContext context{*parts.mechanism, parts.plan, options, {}, {&named, 1}};
  parts.objectives.push_back({.name = entry.name, .unit = entry.unit(context), .quantity = entry.make(context)});
  const DesignProblem problem(parts);
  const DesignReport report = problem.report(nominal());
  EXPECT_EQ(report.status, Status::failed);
  EXPECT_TRUE(std::isnan(report.objectives[0]));
  EXPECT_THAT(report.reason, HasSubstr("the motion turn passes through a singularity at t = 1 s, sample 11 of 11"));
  EXPECT_TRUE(std::isnan(problem.derivatives(nominal(), {})[0]));
}

TEST(SingularPose, IsNoBeginningOfASimulation) {
  SimulationSetup setup;
  setup.dynamics = [](const pkm::MotionState<double>& state) { return dynamics_at(state.pose); };
  setup.forces = [](double) { return AxisVector<double>(4); };
  setup.duration = setup.step = 1e-3;
  EXPECT_EQ(simulate(setup, kSingularPose, AxisVector<double>(4)).stopped,
            "at t = 0 s the mechanism is at a singularity");
}

TEST(TrajectorySummary, HasPeakSpeedsOfRedundantDrives) {
  const test::ThreeRopes ropes;
  const auto swing = point_to_point({0, -1}, {{0, {0.5, -2}, 1}}, 0, TimeLaw::quintic);
  const Trajectory found =
      compute_trajectory(ropes, std::vector<double>{2}, "hanging", no_limits(ropes.info()), *swing, 5);
  EXPECT_EQ(found.summary.infeasible, 0u);
  EXPECT_TRUE(found.summary.peak_speed);
}

}  // namespace
}  // namespace pkm::testing
