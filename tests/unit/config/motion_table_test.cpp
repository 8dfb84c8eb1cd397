// MOTION.toml and [[motion]]: what is read, and the messages verbatim.
#include "engine/config/motion_table.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/motion/motion_factories.hpp"
#include "tests/unit/config/wrong_studies.hpp"

namespace pkm::testing {
namespace {

const MotionNames kNames = {{{"x", "m"}, {"y", "m"}, {"z", "m"}, {"phi", "rad"}}};

std::shared_ptr<const Motion> read(const std::string& text, const MotionNames& names = kNames) {
  return read_motion_toml(text, "m.toml", names);
}

std::string complaint(const std::string& text, const MotionNames& names = kNames) {
  try {
    read(text, names);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string kPose = "x = 0.03\ny = 0.17\nz = \"200 mm\"\nphi = \"-30 deg\"\n";

TEST(MotionSection, PointsWithTimesAndAccelerations) {
  const auto motion = read(R"(
type = "points"
acceleration = "3 m/s^2"
angular_acceleration = 20
points = [{ x = 0.1, y = 0, z = "200 mm", phi = 0, wait = "100 ms" },
          { x = 0.2 },
          { phi = "90 deg", wait = 0.2 },
          { z = 0.25, time = 0.3 }]
back = true
)");
  const double first = move_duration(TimeLaw::quintic, 0.1, 3), turn = move_duration(TimeLaw::quintic, kPi / 2, 20);
  EXPECT_NEAR(motion->duration(), 2 * (first + turn + 0.2 + 0.3) + 0.1, 1e-14);
  EXPECT_TRUE(is_periodic(*motion, kNames.coordinates));
  const MotionSample turned = motion->at(0.1 + first + turn + 0.1);
  EXPECT_NEAR(turned.pose[0], 0.2, 1e-15);
  EXPECT_NEAR(turned.pose[3], kPi / 2, 1e-15);
  EXPECT_NEAR(motion->at(0.1 + first + turn + 0.2 + 0.3).pose[2], 0.25, 1e-15);
  EXPECT_NEAR(motion->at(0.1 + first + turn + 0.2 + 0.6).pose[2], 0.2, 1e-15) << "on the way back";
}

TEST(MotionSection, PickAndPlace) {
  const std::string text = "type = \"pick-and-place\"\n" + kPose +
                           "lift = \"25 mm\"\nreach = \"305 mm\"\nlift_time = 0.12\nreach_time = \"400 ms\"\n"
                           "overlap = 0.06\ndirection = \"90 deg\"\nturn = 1\nwait = 0.1\n";
  const auto half = read(text), whole = read(text + "cycle = \"whole\"\nlaw = \"cycloid\"");
  EXPECT_NEAR(half->duration(), 0.62, 1e-15);
  EXPECT_NEAR(whole->duration(), 1.24, 1e-15);
  const MotionSample end = half->at(half->duration());
  EXPECT_NEAR(end.pose[1], 0.17 + 0.305, 1e-15);
  EXPECT_NEAR(end.pose[3], 1 - kPi / 6, 1e-15);
  EXPECT_FALSE(is_periodic(*half, kNames.coordinates));
  EXPECT_TRUE(is_periodic(*whole, kNames.coordinates));
}

TEST(MotionSection, OscillationAndFormulas) {
  const auto swing = read("type = \"oscillation\"\n" + kPose + "amplitude = \"10 mm\"\nperiod = 1\ncycles = 3");
  EXPECT_EQ(swing->duration(), 3);
  EXPECT_NEAR(swing->at(0.25).pose[0], 0.04, 1e-15);
  const auto formulas =
      read("type = \"formulas\"\nduration = \"2 s\"\nx = \"0.2 - 0.010*t\"\ny = 0.17\nz = \"220 mm\"\nphi = \"t^2\"");
  const MotionSample at = formulas->at(1.5);
  EXPECT_DOUBLE_EQ(at.pose[0], 0.185);
  EXPECT_DOUBLE_EQ(at.velocity[0], -0.01);
  EXPECT_DOUBLE_EQ(at.pose[2], 0.22);
  EXPECT_DOUBLE_EQ(at.velocity[3], 3);
  EXPECT_DOUBLE_EQ(at.acceleration[3], 2);
}

TEST(MotionSection, Messages) {
  const std::string pick = "type = \"pick-and-place\"\n" + kPose + "lift = 0.025\nreach = 0.305\nlift_time = 0.12\n";
  const std::string points = "type = \"points\"\npoints = [{ x = 0, y = 0, z = 0, phi = 0 }, ";
  const std::vector<WrongStudy> cases = {
      {"typ = \"points\"",
       "m.toml:1: typ: found an unknown key; expected type = one of points, pick-and-place, oscillation, formulas; did "
       "you mean 'type'?"},
      {"type = \"pick-and-plaice\"",
       "m.toml:1: type: found \"pick-and-plaice\"; expected one of points, pick-and-place, oscillation, formulas; did "
       "you mean 'pick-and-place'?"},
      {pick + "reach_tim = 0.4",
       "m.toml:9: reach_tim: found an unknown key; expected one of type, x, y, z, phi, lift, reach, lift_time, "
       "reach_time, overlap, direction, turn, wait, cycle, law; did you mean 'reach_time'?"},
      {pick,
       "m.toml:1: reach_time: found nothing; expected a number or a formula > 0 s (duration of the move sideways)"},
      {pick + "reach_time = 0", "m.toml:9: reach_time: found 0; expected a number or a formula > 0 s"},
      {pick + "reach_time = \"40 mm\"",
       "m.toml:9: reach_time: found \"40 mm\"; expected a number in s, or text with a unit made of us, ms, s, min, h"},
      {pick + "reach_time = 0.4\noverlap = 0.2", "m.toml:10: overlap: found 0.2; expected a number in [0, 0.12] s"},
      {pick + "reach_time = 0.4\ncycle = \"hole\"",
       "m.toml:10: cycle: found \"hole\"; expected one of half, whole; did you mean 'whole'?"},
      {pick + "reach_time = 0.4\nlaw = \"cubic\"",
       "m.toml:10: law: found \"cubic\"; expected one of quintic, cycloid, trapezoid"},
      {"type = \"oscillation\"\nx = 0\ny = 0\nz = 0\ntheta = 0\namplitude = 0.01\nperiod = 1",
       "m.toml:5: theta: found an unknown key; expected one of type, x, y, z, phi, amplitude, period, cycles"},
      {"type = \"oscillation\"\n" + kPose + "amplitude = -1\nperiod = 1",
       "m.toml:6: amplitude: found -1; expected a number or a formula > 0 m"},
      {"type = \"points\"",
       "m.toml:1: points: found nothing; expected a list of points, [{ x = .., y = .., ... }, ...]"},
      {"type = \"points\"\npoints = [{ x = 0, y = 0, z = 0, phi = 0 }]",
       "m.toml:2: points: found [{ x = 0, y = 0, z = 0, phi = 0 }]; expected at least two points"},
      {"type = \"points\"\npoints = [{ x = 0, y = 0, z = 0 }, { x = 1 }]",
       "m.toml:2: points[1].phi: found nothing; expected a number in rad, or text with a unit made of mrad, rad, deg, "
       "°"},
      {points + "{ x = 1 }]",
       "m.toml:2: points[2]: the duration of the move to this point is not determined; give time = .., "
       "acceleration = .. or speed = .."},
      {points + "{ phi = 1 }]\nacceleration = 3",
       "m.toml:2: points[2]: the duration of the rotation to this point is not determined; give time = .., "
       "angular_acceleration = .. or angular_speed = .."},
      {points + "{ x = 0 }]\nacceleration = 3",
       "m.toml:2: points[2]: this point equals the previous one; to stay there, give the previous point a "
       "wait = .."},
      {points + "{ x = 1, time = 1, acceleration = 3 }]",
       "m.toml:2: points[2].time: the time of the move also follows from the peak acceleration; give one of them"},
      {points + "{ xx = 1, time = 1 }]",
       "m.toml:2: points[2].xx: found an unknown key; expected one of wait, time, acceleration, "
       "angular_acceleration, speed, angular_speed, x, y, z, phi; did you mean 'x'?"},
      {"type = \"formulas\"\nx = 1",
       "m.toml:1: duration: found nothing; expected a number or a formula > 0 s (duration of the motion)"},
      {"type = \"formulas\"\nduration = 1\nx = 1\ny = 1\nz = 1",
       "m.toml:1: phi: found nothing; expected a formula of the time t [s], such as \"0.1*sin(2*pi*t)\", or a number "
       "in "
       "rad"},
      {"type = \"formulas\"\nduration = 1\nx = \"0.1*T\"\ny = 1\nz = 1\nphi = 0",
       "m.toml:3: x: the formula \"0.1*T\" has the unknown name 'T' at character 5; expected one of t, pi; did you "
       "mean 't'?"},
  };
  for (const auto& wrong : cases) EXPECT_EQ(complaint(wrong.text), wrong.message) << wrong.text;
}

TEST(MotionSection, AsATableOfAStudy) {
  const std::string motion =
      "[[motion]]\nname = \"pick\"\ntype = \"oscillation\"\nx = 0\ny = 0\nz = 0\ntheta = 0\n"
      "amplitude = 0.1\nperiod = 2\n";
  const Study study = read_study_toml(kVolume + motion + kStage, "s.toml", fake_catalogues());
  ASSERT_EQ(study.motions.size(), 1u);
  EXPECT_EQ(study.motions[0].name, "pick");
  EXPECT_EQ(study.motions[0].motion->duration(), 2);
  expect_messages(kVolume,
                  {{"[motion]\ntype = \"points\"",
                    "s.toml:7: motion: found a table; expected a list of tables, each written [[motion]]"},
                   {"[[motion]]\ntype = \"points\"",
                    "s.toml:7: motion[1].name: found nothing; expected a name for objectives to refer to"},
                   {motion + motion, "s.toml:17: motion[2].name: there is already a motion called 'pick'"},
                   {"[[motion]]\nname = \"m\"\ntype = \"swing\"",
                    "s.toml:9: motion[1].type: found \"swing\"; expected one of points, pick-and-place, oscillation, "
                    "formulas"}},
                  kStage);
}

TEST(MotionSection, InputsOfTheMechanismAreFormulasOfTheTime) {
  const MotionNames with_input = {kNames.coordinates, {{"theta", "rad", ""}}};
  const std::string swing = "type = \"oscillation\"\n" + kPose + "amplitude = 0.01\nperiod = 1\n";
  const auto motion = read(swing + "theta = \"0.3 + t^2\"\n", with_input);
  const MotionSample at = motion->at(0.5), still = read(swing, with_input)->at(0.5);
  EXPECT_NEAR(at.inputs[0].value, 0.55, 1e-15);
  EXPECT_NEAR(at.inputs[0].rate, 1, 1e-15);
  EXPECT_NEAR(at.inputs[0].acceleration, 2, 1e-15);
  EXPECT_EQ(at.pose, still.pose);
  EXPECT_TRUE(still.inputs.empty());
  EXPECT_EQ(read(swing + "theta = \"90 deg\"\n", with_input)->at(1).inputs[0].value, kPi / 2);
  EXPECT_FALSE(is_periodic(*motion, kNames.coordinates));
  EXPECT_TRUE(is_periodic(*read(swing + "theta = \"sin(2*pi*t)\"\n", with_input), kNames.coordinates));
  EXPECT_EQ(complaint(swing + "theta = 1\n"),
            "m.toml:8: theta: found an unknown key; expected one of type, x, y, z, phi, amplitude, period, cycles");
  EXPECT_EQ(complaint(swing + "theta = [1]\n", with_input),
            "m.toml:8: theta: found [1]; expected a number in rad, or text with a unit made of mrad, rad, deg, °");
}

TEST(MotionSection, AMotionEnds) {
  EXPECT_EQ(complaint("type = \"oscillation\"\n" + kPose + "amplitude = 0.01\nperiod = 1e300\ncycles = 1e300\n"),
            "m.toml:1: the motion takes inf s; expected at most 1e+09 s");
}

TEST(MotionSection, FilesThatCannotBeRead) {
  try {
    load_motion("/no/such/motion.toml", kNames);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "/no/such/motion.toml: found no readable file (No such file or directory); expected a motion in TOML");
  }
}

}  // namespace
}  // namespace pkm::testing
