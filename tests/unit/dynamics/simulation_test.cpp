// Simulation: energy balance, time reversal, order of convergence, agreement with inverse dynamics, reasons to stop.
#include "engine/dynamics/simulation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/mechanism/inverse_dynamics.hpp"
#include "engine/motion/motion_factories.hpp"
#include "tests/unit/accelerators/crr_cru/golden.hpp"

namespace pkm::testing::crr {
namespace {

using X = AxisVector<double>;
using ::testing::HasSubstr;

SimulationSetup setup_of(const std::string& name, const X& forces, double duration, double step) {
  SimulationSetup setup;
  setup.dynamics = [&m = mechanism(name), p = nominal()](const MotionState<double>& state) {
    PoseDynamics<double> d;
    m.dynamics()->equations(std::span<const double>(p), m.info().modes[0], {&state, 1}, {&d, 1});
    return d;
  };
  setup.forces = [forces](double) { return forces; };
  setup.duration = duration;
  setup.step = step;
  return setup;
}

const X kPose{0.2, 0.17, 0.22, 0.3}, kVelocity{0.3, -0.2, 0.4, 2}, kAtRest(4), kNone(4);

TEST(Simulation, ConservesEnergy) {
  for (const std::string& name : both()) {
    SimulationSetup setup = setup_of(name, {0.5, 0, 8, -0.2}, 0.2, 1e-3);
    setup.wrench = {{0.2, -0.1, 0.3, 0, 0, 0.01}};
    const Simulation run = simulate(setup, kPose, kVelocity);
    ASSERT_EQ(run.stopped, "");
    ASSERT_EQ(run.states.size(), 201u);
    EXPECT_EQ(run.states.back().time, 0.2);
    EXPECT_LT(run.imbalance, 1e-10 * run.turned_over);
    EXPECT_GT(run.turned_over, 0.05);
  }
}

/// The work of gravity depends on the end points only: it equals the integral along the straight line between them.
TEST(Simulation, WorkOfGravityIsIndependentOfThePath) {
  for (const std::string& name : both()) {
    const SimulationSetup setup = setup_of(name, {0.5, 0, 8, -0.2}, 0.2, 1e-3);
    const SimulationState last = simulate(setup, kPose, kVelocity).states.back();
    const X way = last.pose - kPose;
    double work = 0;
    constexpr int kSubintervals = 200;
    for (int k = 0; k < kSubintervals; ++k)
      for (const double root : {-1.0, 1.0}) {  // two-point Gauss quadrature
        const X x = kPose + way * ((k + 0.5 + root / (2 * std::sqrt(3.0))) / kSubintervals);
        work -= dot(setup.dynamics({x, kAtRest}).G_X, way) / (2 * kSubintervals);
      }
    EXPECT_NEAR(last.work_of_weight, work, 1e-9 * std::fabs(work));
  }
}

TEST(Simulation, ReturnsToTheInitialStateBackwardsInTime) {
  for (const std::string& name : both()) {
    const SimulationSetup setup = setup_of(name, {0.5, 0, 8, -0.2}, 0.2, 1e-3);
    const SimulationState there = simulate(setup, kPose, kVelocity).states.back();
    const SimulationState back = simulate(setup, there.pose, there.velocity * -1.0).states.back();
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(back.pose[i], kPose[i], 1e-10);
      EXPECT_NEAR(back.velocity[i], -kVelocity[i], 1e-9);
    }
  }
}

TEST(Simulation, HasOrderSix) {
  const auto end = [](double step) {
    SimulationSetup setup = setup_of("3crr-r-cru", {0.5, 0, 8, -0.2}, 0.16, step);
    setup.tolerance = 1;
    return simulate(setup, kPose, kVelocity).states.back().pose;
  };
  const X exact = end(1e-3), coarse = end(0.016), fine = end(0.008);
  double coarse_error = 0, fine_error = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    coarse_error = std::fmax(coarse_error, std::fabs(coarse[i] - exact[i]));
    fine_error = std::fmax(fine_error, std::fabs(fine[i] - exact[i]));
  }
  EXPECT_NEAR(std::log2(coarse_error / fine_error), 6, 0.7);
}

/// With the forces that inverse dynamics computes for a motion, the simulation reproduces the motion.
TEST(Simulation, ReproducesTheMotionOfInverseDynamics) {
  PickAndPlace cycle;
  cycle.start = {0.06, 0.17, 0.2, -0.4};
  cycle.axes = space_axes(mechanism("3crr-r-cru").info().coordinates);
  cycle.reach = 0.1;
  cycle.turn = 0.5;
  cycle.overlap = 0.05;
  const auto motion = pick_and_place(cycle);
  for (const std::string& name : both()) {
    const Mechanism& m = mechanism(name);
    SimulationSetup setup = setup_of(name, kNone, motion->duration(), 1e-3);
    const std::vector<double> p = nominal();
    setup.tolerance = 1e-6;  // the forces are not smooth where parts of the motion begin
    setup.forces = [&](double time) {
      const MotionSample at = motion->at(time);
      X tau;
      InverseDynamicsScratch<double> scratch;
      inverse_dynamics_along<double>(*m.dynamics(), p, m.info().modes[0], {&at, 1}, {}, scratch,
                                     [&](std::size_t, const ActuatorState<double>& drive) { tau = drive.forces; });
      return tau;
    };
    const Simulation run = simulate(setup, cycle.start, kAtRest);
    ASSERT_EQ(run.stopped, "");
    for (std::size_t k = 0; k < run.states.size(); k += 25)
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(run.states[k].pose[i], motion->at(run.states[k].time).pose[i], 1e-7) << k;
  }
}

TEST(Simulation, RestsIfTheForcesBalanceGravity) {
  SimulationSetup setup = setup_of("3crr-r-cru", kNone, 0.05, 1e-2);
  const MotionSample at{0, kPose, kAtRest, kAtRest, {}};
  InverseDynamicsScratch<double> scratch;
  inverse_dynamics_along<double>(*mechanism("3crr-r-cru").dynamics(), nominal(),
                                 mechanism("3crr-r-cru").info().modes[0], {&at, 1}, {}, scratch,
                                 [&](std::size_t, const ActuatorState<double>& drive) {
                                   setup.forces = [tau = drive.forces](double) { return tau; };
                                 });
  const Simulation run = simulate(setup, kPose, kAtRest);
  ASSERT_EQ(run.stopped, "");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(run.states.back().pose[i], kPose[i], 1e-12);
}

TEST(Simulation, ReportsWhyItStops) {
  const SimulationSetup falls = setup_of("3crr-r-cru", kNone, 2, 1e-3);
  const Simulation run = simulate(falls, kPose, kAtRest);
  EXPECT_THAT(run.stopped, HasSubstr("at t = 0."));
  EXPECT_LT(run.states.back().time, 0.5);
  EXPECT_GT(run.states.size(), 50u);
  SimulationSetup limited = falls;
  limited.refuse = [](const pkm::Pose<double>& pose) { return pose[2] < 0.2 ? std::string("the floor is hit") : ""; };
  EXPECT_THAT(simulate(limited, kPose, kAtRest).stopped, HasSubstr("s the floor is hit"));
  EXPECT_EQ(simulate(falls, {2, 2, 2, 0}, kAtRest).stopped, "at t = 0 s the pose is out of reach");
  const Simulation coarse = simulate(setup_of("3crr-r-cru", {20, 20, 20, 20}, 2, 0.5), kPose, kVelocity);
  EXPECT_NE(coarse.stopped, "");
}

}  // namespace
}  // namespace pkm::testing::crr
