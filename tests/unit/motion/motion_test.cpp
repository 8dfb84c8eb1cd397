// All kinds of motions: derivatives, end points, durations, interval enclosures.
#include "engine/motion/motion_factories.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace pkm {
namespace {

using X = Pose<double>;

const std::vector<AxisInfo> kCoordinates = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"phi", "rad"}};
const X kStart{0.03, 0.17, 0.2, -0.5};

PickAndPlace pick_and_place_cycle(double overlap, TimeLaw law = TimeLaw::quintic) {
  PickAndPlace cycle;
  cycle.axes = space_axes(kCoordinates);
  cycle.start = kStart;
  cycle.lift_time = 0.12;
  cycle.reach_time = 0.4;
  cycle.overlap = overlap;
  cycle.direction = 0.6;
  cycle.turn = 1.0;
  cycle.law = law;
  return cycle;
}

std::vector<NamedMotion> every_kind() {
  const auto formula = [](const char* text) { return Formula(text, time_name()); };
  PickAndPlace whole = pick_and_place_cycle(0.06);
  whole.back = true;
  whole.wait = 0.1;
  const std::vector<Move> moves = {{0.2, {{0.1, 0.2, 0.2, 0.3}}, 0.4}, {0, {{0.1, 0.2, 0.25, 0.3}}, 0.1}};
  return {{"quintic", point_to_point(kStart, moves, 0.05, TimeLaw::quintic)},
          {"cycloid", point_to_point(kStart, moves, 0.05, TimeLaw::cycloid)},
          {"trapezoid", point_to_point(kStart, moves, 0.05, TimeLaw::trapezoid)},
          {"oscillation", oscillation(space_axes(kCoordinates), kStart, 0.01, 1.0, 2.0)},
          {"half", pick_and_place(pick_and_place_cycle(0))},
          {"half, cycloid", pick_and_place(pick_and_place_cycle(0.05, TimeLaw::cycloid))},
          {"whole", pick_and_place(whole)},
          {"formulas",
           motion_from_formulas({formula("0.2 - 0.010*t"), formula("0.1*sin(t)"), formula("0.2"), formula("t^2")}, 2)}};
}

TEST(Motions, VelocityAndAccelerationAreTheDerivatives) {
  for (const auto& [name, motion] : every_kind()) {
    SCOPED_TRACE(name);
    const double T = motion->duration(), h = 1e-5;
    for (int k = 1; k < 40; ++k) {
      const double t = T * k / 40 + 1e-3 * T;  // not where the acceleration is discontinuous
      const MotionSample at = motion->at(t), before = motion->at(t - h), after = motion->at(t + h);
      EXPECT_EQ(at.time, t);
      for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(at.velocity[i], (after.pose[i] - before.pose[i]) / (2 * h), 1e-5);
        EXPECT_NEAR(at.acceleration[i], (after.velocity[i] - before.velocity[i]) / (2 * h), 2e-3);
      }
    }
  }
}

/// The graph evaluated over a time interval encloses every sample in it, and the width of the enclosure is proportional
/// to that of the interval.
TEST(Motions, GraphEnclosesEverySample) {
  for (const auto& [name, motion] : every_kind()) {
    SCOPED_TRACE(name);
    expression::Graph graph;
    std::vector<Interval> inputs = {Interval(7.0)};
    TimeGraph to(graph, inputs);
    const std::vector<expression::Node> pose = motion->write(to);
    ASSERT_EQ(pose.size(), 4u);
    const expression::Program program(graph, pose);
    const double T = motion->duration();
    std::vector<Interval> registers;
    for (const int intervals : {7, 1000}) {
      for (int k = 0; k < intervals; ++k) {
        const double from = T * k / intervals, end = T * (k + 1) / intervals;
        inputs[to.position] = {from, end};
        program.run_all<Interval>(inputs, registers);
        for (const double t : {from, 0.7 * from + 0.3 * end, end})
          for (std::size_t i = 0; i < 4; ++i) {
            const Interval at = registers[program.outputs()[i]];
            const double sample = motion->at(std::min(t, T)).pose[i];
            EXPECT_LE(at.lower, sample + 1e-12) << t;
            EXPECT_GE(at.upper, sample - 1e-12) << t;
            EXPECT_LE(at.width(), 40.0 / intervals) << t;
            EXPECT_TRUE(at.is_defined());
          }
      }
    }
  }
}

TEST(Motions, SamplesIncludeBothEnds) {
  for (const auto& [name, motion] : every_kind()) {
    SCOPED_TRACE(name);
    const auto samples = sample(*motion, 7);
    ASSERT_EQ(samples.size(), 7u);
    EXPECT_EQ(samples.front().time, 0);
    EXPECT_EQ(samples.back().time, motion->duration());
    EXPECT_NEAR(samples[3].time, motion->duration() / 2, 1e-15);
  }
}

TEST(Motions, PointToPointRestsAtItsPoints) {
  const auto motion = every_kind()[0].motion;  // waits 0.2, moves 0.4, moves 0.1, waits 0.05
  EXPECT_DOUBLE_EQ(motion->duration(), 0.75);
  const auto expect_rest = [&](double t, const X& pose) {
    const MotionSample at = motion->at(t);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(at.pose[i], pose[i], 1e-15) << t;
      EXPECT_NEAR(at.velocity[i], 0, 1e-12) << t;
      EXPECT_NEAR(at.acceleration[i], 0, 1e-9) << t;
    }
  };
  expect_rest(0, kStart);
  expect_rest(0.1, kStart);
  expect_rest(0.2 + 0.4, {{0.1, 0.2, 0.2, 0.3}});
  expect_rest(0.72, {{0.1, 0.2, 0.25, 0.3}});
  EXPECT_EQ(motion->at(motion->duration()).pose, (X{0.1, 0.2, 0.25, 0.3}));
}

TEST(Motions, DurationFollowsFromPeakRates) {
  for (const TimeLaw law : {TimeLaw::quintic, TimeLaw::cycloid, TimeLaw::trapezoid}) {
    const X to = kStart + X{0.03, -0.04, 0, 0.2};
    const double T = min_move_duration(law, kCoordinates, kStart, to, {.acceleration = 3});
    const auto motion = point_to_point(kStart, {{0, to, T}}, 0, law);
    double peak = 0, speed = 0;
    for (const MotionSample& at : sample(*motion, 100'001)) {
      peak = std::fmax(peak, std::hypot(at.acceleration[0], at.acceleration[1]));
      speed = std::fmax(speed, std::hypot(at.velocity[0], at.velocity[1]));
    }
    EXPECT_NEAR(peak, 3, 1e-8);
    EXPECT_NEAR(speed, (law == TimeLaw::quintic ? 1.875 : law == TimeLaw::cycloid ? 2.0 : 1.5) * 0.05 / T, 1e-12);
    EXPECT_NEAR(min_move_duration(law, kCoordinates, kStart, to, {.acceleration = 3, .speed = speed / 2}), 2 * T,
                1e-12);
    EXPECT_NEAR(min_move_duration(law, kCoordinates, kStart, to, {.angular_speed = 0.1}), peak_speed(law) * 2, 1e-12);
    // the rotation needs more time than the translation
    EXPECT_NEAR(min_move_duration(law, kCoordinates, kStart, to, {.acceleration = 3, .angular_acceleration = 0.1}),
                std::sqrt(peak_acceleration(law) * 0.2 / 0.1), 1e-12);
  }
  // T = sqrt(10 S/(sqrt(3) a)).
  EXPECT_NEAR(move_duration(TimeLaw::quintic, 0.0906, 3), std::sqrt(10 * 0.0906 / (std::sqrt(3.0) * 3)), 1e-15);
}

TEST(Motions, PickAndPlaceCycle) {
  const auto half = pick_and_place(pick_and_place_cycle(0.06));
  EXPECT_NEAR(half->duration(), 0.12 - 0.06 + 0.4 - 0.06 + 0.12, 1e-15);
  const MotionSample end = half->at(half->duration());
  const auto [s, c] = sincos(0.6);
  EXPECT_NEAR(end.pose[0], kStart[0] + 0.305 * c, 1e-15);
  EXPECT_NEAR(end.pose[1], kStart[1] + 0.305 * s, 1e-15);
  EXPECT_NEAR(end.pose[2], kStart[2], 1e-15);
  EXPECT_NEAR(end.pose[3], kStart[3] + 1, 1e-15);
  EXPECT_NEAR(half->at(half->duration() / 2).pose[2], kStart[2] + 0.025, 1e-15);
  // without overlap it stops at the corners
  const auto stops = pick_and_place(pick_and_place_cycle(0));
  for (const double corner : {0.12, 0.52})
    for (const double v : stops->at(corner).velocity) EXPECT_NEAR(v, 0, 1e-12);
  // the way back follows the same path in reverse
  PickAndPlace cycle = pick_and_place_cycle(0.06);
  cycle.back = true;
  const auto whole = pick_and_place(cycle);
  EXPECT_DOUBLE_EQ(whole->duration(), 2 * half->duration());
  for (double t = 0; t < half->duration(); t += 0.013)
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(whole->at(whole->duration() - t).pose[i], whole->at(t).pose[i], 1e-14);
}

TEST(Motions, WorkWithOtherCoordinates) {
  // a planar platform whose rotation is the first coordinate: axes are found by name and unit
  const std::vector<AxisInfo> planar = {{"phi", "rad"}, {"y", "m"}, {"x", "m"}};
  const SpaceAxes axes = space_axes(planar);
  EXPECT_EQ(axes.turn, 0u);
  EXPECT_EQ(axes.x, 2u);
  EXPECT_EQ(axes.y, 1u);
  EXPECT_EQ(axes.z, std::nullopt);
  PickAndPlace cycle = pick_and_place_cycle(0.06);
  cycle.axes = axes;
  cycle.start = {0.1, 0.2, 0.3};
  cycle.lift = 0;
  const auto motion = pick_and_place(cycle);
  const MotionSample end = motion->at(motion->duration());
  const auto [s, c] = sincos(0.6);
  EXPECT_NEAR(end.pose[0], 1.1, 1e-15);
  EXPECT_NEAR(end.pose[1], 0.2 + 0.305 * s, 1e-15);
  EXPECT_NEAR(end.pose[2], 0.3 + 0.305 * c, 1e-15);
  // two angles: the limits apply to each of them
  const std::vector<AxisInfo> angles = {{"alpha", "rad"}, {"beta", "rad"}};
  EXPECT_EQ(
      min_move_duration(TimeLaw::quintic, angles, {0, 0}, {0.1, -0.3}, {.acceleration = 1, .angular_acceleration = 2}),
      std::fmax(move_duration(TimeLaw::quintic, 0.1, 2), move_duration(TimeLaw::quintic, -0.3, 2)));
}

TEST(Motions, PeriodicMotionsAreRecognised) {
  for (const auto& [name, motion] : every_kind())
    EXPECT_EQ(is_periodic(*motion, kCoordinates), name == "oscillation" || name == "whole") << name;
  const auto formula = [](const char* text) { return Formula(text, time_name()); };
  const auto turn = motion_from_formulas({formula("0"), formula("cos(2*pi*t)"), formula("0"), formula("2*pi*t")}, 1);
  EXPECT_TRUE(is_periodic(*turn, kCoordinates)) << "a full turn";
}

}  // namespace
}  // namespace pkm
