// Fastest motions: closed forms, dynamic programming, limits along the result, derivatives.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/core/catalogue.hpp"
#include "engine/mechanism/fastest_motion.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/mechanism/with_drive_trains.hpp"
#include "engine/motion/motion_factories.hpp"
#include "objectives/all.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;

const Wrench<double> kNoWrench{};

std::shared_ptr<const Motion> cycle_of(TimeLaw law, double overlap = 0) {
  PickAndPlace cycle;
  cycle.axes = {.x = 0, .y = 1, .z = 2};
  cycle.start = {-0.1525, 0, -0.5};
  cycle.lift_time = 0.08;
  cycle.reach_time = 0.2;
  cycle.overlap = overlap;
  cycle.back = true;
  cycle.law = law;
  return pick_and_place(cycle);
}

/// A planetary gear and a motor of 200 W at each crank.
const DriveTrain kGear = {
    .ratio = 10, .rotor = 1.7e-5, .shaft = 1e-5, .efficiency = 0.95, .coulomb = 0.4, .viscous = 0.05};
const Motor kMotor = {.name = "200 W", .continuous_torque = 0.64, .peak_torque = 1.91, .speed = 524, .rotor = 1.7e-5};

std::shared_ptr<const Mechanism> geared_delta(const Motor& motor) {
  return with_drive_trains(test::described("rotary-delta"), DriveTrains(3, kGear),
                           std::vector<JointLimits>(3, JointLimits{.motor = motor}));
}
Motor motor_without_thermal_limit() {
  Motor motor = kMotor;
  motor.continuous_torque = motor.peak_torque;
  return motor;
}

/// A mechanism with its nominal design and limits.
struct Robot {
  std::shared_ptr<const Mechanism> mechanism;
  MotionLimits limits = {.joints = joint_limits(*mechanism)};
  std::vector<double> design = test::nominal(mechanism->info());

  DesignWithLimits with_limits() const {
    return {*mechanism, design, mechanism->info().modes.front(), limits, kNoWrench};
  }
  Trajectory trajectory(const Motion& motion, std::size_t samples) const {
    return compute_trajectory(*mechanism, design, mechanism->info().modes.front(), no_limits(mechanism->info()), motion,
                              samples);
  }
};

TEST(FastestMotion, ReachesTheClosedFormsForALimitOfTheToolsAcceleration) {
  // bang-bang, and peak accelerations of the laws: 2 (2 sqrt(d1) + sqrt(d2)) sqrt(c / a)
  const auto closed_form = [](double c) { return 2 * (2 * std::sqrt(0.025) + std::sqrt(0.305)) * std::sqrt(c / 165); };
  Robot delta{test::described("rotary-delta")};
  delta.limits.tool_acceleration = 165;
  const auto time = [&](FastestLaw law, TimeLaw time_law) {
    const MovesOfMotion moves(cycle_of(time_law), law, 200);
    const FastestMotion found = find_fastest_motion(moves, delta.with_limits(), 301);
    EXPECT_NEAR(shortest_times(moves, delta.with_limits()).duration, found.duration, 1e-9);
    EXPECT_EQ(found.moves.size(), 6u);
    EXPECT_EQ(found.active.front().limit, (LimitOfMotion{LimitKind::tool_acceleration}));
    return found.duration;
  };
  for (const TimeLaw law : {TimeLaw::quintic, TimeLaw::cycloid, TimeLaw::trapezoid})
    EXPECT_NEAR(time(FastestLaw::optimal, law), closed_form(4), 1e-9);
  EXPECT_NEAR(time(FastestLaw::own, TimeLaw::quintic), closed_form(10 / std::sqrt(3.0)), 1e-9);
  EXPECT_NEAR(time(FastestLaw::own, TimeLaw::cycloid), closed_form(2 * kPi), 1e-9);
  EXPECT_NEAR(time(FastestLaw::own, TimeLaw::trapezoid), closed_form(4.5), 1e-9);
}

/// The shortest time of a straight move by dynamic programming: the minimum over all sequences of speeds on a grid,
/// with torques from the inverse dynamics at the first point of every interval.
double time_by_dynamic_programming(const Robot& robot, const MovesOfMotion::Move& move, double fastest,
                                   std::size_t speeds) {
  const std::size_t n = move.steps.size();
  // speeds, accelerations and forces of the joints are linear in the acceleration u and in v^2
  const auto state = [&](const MotionSample& at) {
    InverseDynamicsScratch<double> scratch;
    ActuatorState<double> found;
    inverse_dynamics_along<double>(*robot.mechanism->dynamics(), robot.design, robot.mechanism->info().modes.front(),
                                   {&at, 1}, kNoWrench, scratch,
                                   [&](std::size_t, const ActuatorState<double>& drive) { found = drive; });
    return found;
  };
  std::vector<std::array<ActuatorState<double>, 3>> states;  // at rest, for u = 1, and for v = 1
  for (const MotionSample& at : move.samples) {
    const AxisVector<double> zero(3);
    MotionSample rest = at, accelerated = at;
    rest.velocity = rest.acceleration = accelerated.velocity = zero;
    accelerated.acceleration = at.velocity;
    states.push_back({state(rest), state(accelerated), state(at)});
  }
  const auto is_allowed = [&](std::size_t i, double v, double u) {
    const auto& [rest, accelerated, moving] = states[i];
    ActuatorState<double> at = rest;
    at.speeds = moving.speeds * v;
    at.accelerations = accelerated.accelerations * u + moving.accelerations * (v * v);
    at.forces = rest.forces + (accelerated.forces - rest.forces) * u + (moving.forces - rest.forces) * (v * v);
    for (std::size_t k = 0; k < 3; ++k)
      if (std::fabs(at.torque(kGear, k)) > kMotor.peak_torque) return false;
    return true;
  };
  constexpr double kNever = 1e9;
  const auto speed = [&](std::size_t j) { return fastest * static_cast<double>(j) / static_cast<double>(speeds - 1); };
  std::vector<double> to_go(speeds, kNever);
  to_go[0] = 0;
  for (std::size_t i = n; i-- > 0;) {
    std::vector<double> here(speeds, kNever);
    for (std::size_t j = 0; j < speeds; ++j) {
      // the feasible next speeds are neighbours: search upwards and downwards from the same speed
      const auto visit = [&](std::size_t k) {
        const double u = (speed(k) * speed(k) - speed(j) * speed(j)) / (2 * move.steps[i]);
        if (!is_allowed(i, speed(j), u)) return false;
        if (j + k > 0) here[j] = std::min(here[j], to_go[k] + 2 * move.steps[i] / (speed(j) + speed(k)));
        return true;
      };
      for (std::size_t k = j; k < speeds && visit(k); ++k) {
      }
      for (std::size_t k = j; k-- > 0 && visit(k);) {
      }
    }
    to_go = here;
  }
  return to_go[0];
}

TEST(FastestMotion, IsThatOfDynamicProgrammingOnAFineGrid) {
  const Robot delta{geared_delta(motor_without_thermal_limit())};
  const std::vector<Move> across = {{0, {0.1525, 0.05, -0.45}, 0.2}};
  const auto motion = point_to_point({-0.1525, 0, -0.5}, across, 0, TimeLaw::quintic);
  const MovesOfMotion moves(motion, FastestLaw::optimal, 60);
  const ShortestTimes found = shortest_times(moves, delta.with_limits());
  const SpeedProfile& profile = *found.moves[0].profile;
  const double fastest = std::sqrt(*std::ranges::max_element(profile.squares));
  const double searched = time_by_dynamic_programming(delta, moves.moves()[0], 1.05 * fastest, 1000);
  EXPECT_LE(found.duration, searched * (1 + 1e-9));
  EXPECT_NEAR(found.duration / searched, 1, 0.01);
  const MovesOfMotion fine(motion, FastestLaw::optimal, 2000);
  EXPECT_NEAR(found.duration / shortest_times(fine, delta.with_limits()).duration, 1, 0.02);
}

/// The largest ratios of demand and limit along a trajectory.
struct MotorLoads {
  double torque = 0, rms = 0, speed = 0;
};
MotorLoads motor_loads_of(const Trajectory& along, const Motor& motor) {
  MotorLoads loads;
  for (std::size_t i = 0; i < 3; ++i)
    loads.rms = std::max(loads.rms, along.summary.rms_torque[i] / motor.continuous_torque);
  for (const TrajectoryPoint& point : along.points)
    for (std::size_t i = 0; i < 3; ++i) {
      const double speed = (*point.motor_speeds)[i];
      loads.speed = std::max(loads.speed, std::fabs(speed) / motor.speed);
      loads.torque = std::max(loads.torque, std::fabs((*point.torques)[i]) / motor.torque_at(speed));
    }
  return loads;
}

TEST(FastestMotion, KeepsTheLimitsOfTheMotorsAndReachesThem) {
  Motor weak = motor_without_thermal_limit();
  weak.curve = {{0, 1.91}, {60, 1.91}, {160, 0.5}};
  weak.speed = 150;
  for (const Motor& motor : {kMotor, motor_without_thermal_limit(), weak})
    for (const FastestLaw law : {FastestLaw::optimal, FastestLaw::own}) {
      SCOPED_TRACE(motor.continuous_torque);
      SCOPED_TRACE(motor.speed);
      SCOPED_TRACE(law == FastestLaw::own ? "own" : "optimal");
      const Robot delta{geared_delta(motor)};
      const MovesOfMotion moves(cycle_of(TimeLaw::quintic, 0.02), law, 1000);
      const FastestMotion found = find_fastest_motion(moves, delta.with_limits(), 501);
      const MotorLoads loads = motor_loads_of(delta.trajectory(*found.motion, 501), motor);
      EXPECT_LE(loads.torque, 1 + 1e-9);
      EXPECT_LE(loads.rms, 1 + 1e-9);
      EXPECT_LE(loads.speed, 1 + 1e-9);
      EXPECT_GE(std::max({loads.torque, loads.rms, loads.speed}), 1 - 0.03);
      EXPECT_GE(found.duration, 2 * 0.05);
    }
}

// reference: the trapezoidal rule over the samples of the fastest motion, by the inverse dynamics of a trajectory
TEST(FastestMotion, HasTheEnergyOfItsTrajectory) {
  for (const bool has_motors : {true, false}) {
    Robot delta{has_motors ? geared_delta(kMotor) : test::described("rotary-delta")};
    if (!has_motors) delta.limits.tool_acceleration = 100;
    for (const FastestLaw law : {FastestLaw::optimal, FastestLaw::own}) {
      const MovesOfMotion moves(cycle_of(TimeLaw::quintic, 0.02), law, 400);
      const ShortestTimes times = shortest_times(moves, delta.with_limits());
      const FastestMotion found = find_fastest_motion(moves, delta.with_limits(), 201);
      const Trajectory trajectory = delta.trajectory(*found.motion, 4001);
      double drawn = 0, all = 0;
      const double step = found.duration / 4000;
      for (const TrajectoryPoint& at : trajectory.points)
        for (std::size_t i = 0; i < 3; ++i) {
          const double power = has_motors ? (*at.torques)[i] * (*at.motor_speeds)[i] : (*at.power)[i];
          drawn += std::fmax(power, 0) * step;
          all += power * step;
        }
      // With the law `optimal`, the motion keeps the limits also between the nodes, and is slower by about 2 %.
      const double accuracy = (law == FastestLaw::optimal ? 0.06 : 0.005) * drawn;
      EXPECT_NEAR(energy_of(moves, times, delta.with_limits(), false), drawn, accuracy);
      EXPECT_NEAR(energy_of(moves, times, delta.with_limits(), true), all, accuracy);
    }
  }
}

TEST(FastestMotion, OfTheOwnLawHasItsPeakAtTheLimit) {
  const Robot delta{geared_delta(motor_without_thermal_limit())};
  const MovesOfMotion moves(cycle_of(TimeLaw::cycloid), FastestLaw::own, 100);
  const FastestMotion found = find_fastest_motion(moves, delta.with_limits(), 101);
  const double peak = motor_loads_of(delta.trajectory(*found.motion, 20001), motor_without_thermal_limit()).torque;
  EXPECT_LE(peak, 1 + 1e-9);
  EXPECT_GE(peak, 1 - 1e-5);
}

TEST(FastestMotion, OfTheOptimalLawIsNotSlowerThanThatOfTheOwnLaw) {
  const Robot delta{geared_delta(motor_without_thermal_limit())};
  for (const double overlap : {0.0, 0.02}) {
    const auto motion = cycle_of(TimeLaw::quintic, overlap);
    const auto time = [&](FastestLaw law) {
      return find_fastest_motion(MovesOfMotion(motion, law, 1000), delta.with_limits(), 201).duration;
    };
    EXPECT_LT(time(FastestLaw::optimal), time(FastestLaw::own));
  }
}

TEST(FastestMotion, IsConsistentWithItsVelocitiesAndKeepsPauses) {
  Robot delta{test::described("rotary-delta")};
  delta.limits.tool_acceleration = 50;
  const std::vector<Move> there_and_back = {{0.1, {0.1, 0, -0.5}, 0.3}, {0.2, {-0.1, 0.05, -0.48}, 0.3}};
  const auto motion = point_to_point({-0.1, 0, -0.5}, there_and_back, 0.05, TimeLaw::cycloid);
  for (const FastestLaw law : {FastestLaw::optimal, FastestLaw::own}) {
    const FastestMotion found = find_fastest_motion(MovesOfMotion(motion, law, 100), delta.with_limits(), 201);
    ASSERT_EQ(found.moves.size(), 2u);
    EXPECT_NEAR(found.moves[0].begin, 0.1, 1e-8);
    EXPECT_NEAR(found.moves[1].begin - found.moves[0].end, 0.2, 1e-8);
    EXPECT_NEAR(found.duration - found.moves[1].end, 0.05, 1e-8);
    EXPECT_NEAR(found.motion->at(found.moves[0].end).pose[0], 0.1, 1e-9);
    for (const double t : {0.13, 0.14, found.moves[1].begin + 0.03}) {
      const double h = 1e-6;
      const MotionSample a = found.motion->at(t - h), b = found.motion->at(t + h), at = found.motion->at(t);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(at.velocity[i], (b.pose[i] - a.pose[i]) / (2 * h), 1e-6);
        EXPECT_NEAR(at.acceleration[i], (b.velocity[i] - a.velocity[i]) / (2 * h), 1e-3);
      }
    }
  }
}

TEST(FastestMotion, FollowsCurvedPathsWithinTheToolsAcceleration) {
  // With v = 1 m/s, r = 0.1 m, a = 100 m/s^2, the tangential acceleration is sqrt(a^2 - (v^2/r)^2). A ramp takes
  // (1 + 0.001)/a and (1/2 + 0.005/6)/a of the way: 0.0050017 s more than at full speed.
  Robot delta{test::described("rotary-delta")};
  delta.limits.tool_speed = 1;
  delta.limits.tool_acceleration = 100;
  const auto formula = [](const char* text) { return Formula(text, time_name()); };
  const auto circle =
      motion_from_formulas({formula("0.1*cos(2*pi*t)"), formula("0.1*sin(2*pi*t)"), formula("-0.5")}, 1);
  const MovesOfMotion moves(circle, FastestLaw::optimal, 2000);
  ASSERT_EQ(moves.moves().size(), 1u);
  EXPECT_NEAR(moves.moves()[0].path->length(), 0.2 * kPi, 1e-12);
  const double time = find_fastest_motion(moves, delta.with_limits(), 201).duration;
  EXPECT_NEAR(time, 0.2 * kPi + 2 * 0.0050017, 4e-5);
}

/// The objective cycle-time of a mechanism with these options.
std::unique_ptr<const Quantity> cycle_time(const Mechanism& mechanism, const std::vector<DesignMotion>& motions,
                                           const std::string& law) {
  const ObjectiveEntry& entry = *find_named(all_objectives(), "cycle-time");
  Options options = default_options(entry.options);
  options.set("motion", std::string("cycle"));
  options.set("law", law);
  options.set("nodes", std::int64_t{100});
  const WorkspacePlan plan{.method = VoxelOptions{}, .fixed = {}, .limits = no_limits(mechanism.info())};
  return entry.make({mechanism, plan, options, {}, motions});
}

TEST(CycleTime, HasTheDerivativesOfItsDifferences) {
  const std::vector<DesignMotion> motions = {{{"cycle", cycle_of(TimeLaw::quintic)}}};
  for (const Motor& motor : {kMotor, motor_without_thermal_limit()})
    for (const std::string law : {"optimal", "own"}) {
      SCOPED_TRACE(law);
      SCOPED_TRACE(motor.continuous_torque);
      const auto mechanism = geared_delta(motor);
      const auto objective = cycle_time(*mechanism, motions, law);
      ASSERT_FALSE(objective->why_no_derivatives());
      const std::vector<double> design = test::nominal(mechanism->info());
      Scratch scratch;
      const auto value = [&](const std::vector<double>& at) {
        return objective->value({*mechanism, at, nullptr, scratch});
      };
      for (std::size_t first = 0; first < design.size(); first += 4) {
        std::vector<Dual4> dual(design.begin(), design.end());
        for (std::size_t i = first; i < std::min(first + 4, design.size()); ++i)
          dual[i] = Dual4::variable(design[i], static_cast<int>(i - first));
        const Dual4 found = objective->smooth({*mechanism, dual, nullptr, scratch});
        EXPECT_NEAR(found.a, value(design), 1e-12);
        for (std::size_t i = first; i < std::min(first + 4, design.size()); ++i) {
          std::vector<double> more = design, less = design;
          const double h = 1e-6 * std::max(std::fabs(design[i]), 0.01);
          more[i] += h;
          less[i] -= h;
          const double difference = (value(more) - value(less)) / (2 * h);
          EXPECT_NEAR(found.v[static_cast<int>(i - first)], difference, 1e-3 * std::fabs(difference) + 1e-5)
              << mechanism->info().parameters[i].name;
        }
      }
    }
}

TEST(FastestMotion, RefusesWhatHasNoShortestTime) {
  const auto message = [](const Robot& robot, const std::shared_ptr<const Motion>& motion) -> std::string {
    try {
      shortest_times(MovesOfMotion(motion, FastestLaw::optimal, 50), robot.with_limits());
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  Robot delta{test::described("rotary-delta")};
  const auto cycle = cycle_of(TimeLaw::quintic);
  EXPECT_THAT(message(delta, cycle), HasSubstr("no limit of acceleration, force or torque bounds the motion"));
  delta.limits.joints.resize(3);
  delta.limits.joints[0].force = 1e-3;
  EXPECT_THAT(message(delta, cycle), HasSubstr("cannot hold its pose at t = 0 s of the motion: the force is exceeded"));
  delta.limits.joints[0].force = 10;
  const auto formula = [](const char* text) { return Formula(text, time_name()); };
  EXPECT_THAT(message(delta, motion_from_formulas({formula("0"), formula("0"), formula("-0.5")}, 1)),
              HasSubstr("the motion does not move"));
  EXPECT_THAT(
      message(delta, motion_from_formulas({formula("0.1*abs(t - 0.5)"), formula("0.05*t"), formula("-0.5")}, 1)),
      HasSubstr("has a corner"));
  EXPECT_THAT(message(delta, motion_from_formulas({formula("2*t"), formula("0"), formula("-0.5")}, 1)),
              HasSubstr("leaves the reach of the mechanism"));
}

}  // namespace
}  // namespace pkm
