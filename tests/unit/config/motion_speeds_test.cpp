// Speeds and accelerations of joints along a motion need no masses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "engine/mechanism/trajectory.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using testing::all_catalogues;
using ::testing::HasSubstr;
using testing::real_complaint;

/// The linear Delta, with its masses or without.
SourceText linear_delta(bool masses) {
  std::istringstream lines(test::text_of_mechanism("linear-delta"));
  std::string text;
  for (std::string line; std::getline(lines, line);)
    if (masses || line.find("mass") == std::string::npos) text += line + '\n';
  return {text, "linear-delta.toml"};
}

const std::string kMotion = R"([[motion]]
name = "across"
type = "points"
points = [{ x = -0.1, y = 0, z = 0 }, { x = 0.1, y = 0.05, speed = 0.5 }]
)";
std::string report(const std::string& type, const std::string& more = "") {
  return "[[output]]\ntype = \"" + type + "\"\nmotion = \"across\"\n" + more;
}

Study delta(bool masses, const std::string& more) {
  return read_study_toml("[mechanism]\nfile = \"linear-delta.toml\"\n[variables]\nl = { min = 0.4, max = 0.6 }\n" +
                             kMotion + more +
                             "[[stage]]\noptimiser = \"ga\"\n[[objective]]\ntype = \"workspace-volume\"\n",
                         "s.toml", all_catalogues(), linear_delta(masses));
}

TEST(MotionSpeeds, AreThoseOfTheTrajectoryWithMassesAndWithout) {
  const std::string entries = "[[drive_train]]\njoint = \"all\"\nlead = \"10 mm\"\n" + report("joint-speed") +
                              report("joint-acceleration") + report("joint-speed", "name = \"of-2\"\njoint = \"2\"\n") +
                              report("motor-speed");
  const Study with = delta(true, entries), without = delta(false, entries);
  const auto values = [](const Study& study) {
    return study.problem->report(study.problem->parts().parameters).reports;
  };
  const ProblemParts& parts = without.problem->parts();
  const Trajectory along = compute_trajectory(*parts.mechanism, parts.parameters, parts.mechanism->info().modes.front(),
                                              parts.plan.limits, *without.motions[0].motion, 201);
  const AxisVector<double>& peaks = along.summary.peak_speed.value();
  double acceleration = 0;
  for (const TrajectoryPoint& point : along.points)
    for (const double value : point.accelerations.value()) acceleration = std::max(acceleration, std::fabs(value));
  const std::vector<double> found = values(without), other = values(with);
  EXPECT_DOUBLE_EQ(found[0], std::ranges::max(peaks));
  EXPECT_DOUBLE_EQ(found[1], acceleration);
  EXPECT_DOUBLE_EQ(found[2], peaks[1]);
  EXPECT_DOUBLE_EQ(found[3], std::ranges::max(peaks) * 2 * kPi / 0.01);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(other[i] / found[i], 1, 1e-9) << i;
  EXPECT_EQ(with.problem->reports()[0].unit, "m/s");
  EXPECT_EQ(with.problem->reports()[1].unit, "m/s^2");
}

TEST(MotionSpeeds, WhatNeedsMassesIsRefusedWithout) {
  const auto complaint = [](const std::string& more) -> std::string {
    try {
      delta(false, more);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(complaint(report("peak-force")), HasSubstr("needs dynamics, and mechanism linear-delta has no masses"));
  EXPECT_THAT(complaint("[[drive_train]]\njoint = \"all\"\nlead = 0.01\n" + report("motor-torque")),
              HasSubstr("needs dynamics, and mechanism linear-delta has no masses"));
  EXPECT_THAT(
      complaint("[[drive_train]]\njoint = \"all\"\nlead = 0.01\nrotor_inertia = 1e-5\n"),
      HasSubstr("drive_train[1].rotor_inertia: inertias and losses of drive trains need dynamics, but mechanism "
                "linear-delta has no masses; gear and lead need none"));
  EXPECT_THAT(complaint(report("joint-speed", "wrench = { Fz = 1 }\n")), HasSubstr("found an unknown key"));
  EXPECT_EQ(complaint("[[constraint]]\ntype = \"joint-speed\"\nmotion = \"across\"\nmax = \"2 m/s\"\n"), "accepted");
}

TEST(MotionSpeeds, APeakSpeedBoundsTheTimeOfAMove) {
  const Study study = delta(false, report("joint-speed"));
  double fastest = 0;
  for (const MotionSample& at : sample(*study.motions[0].motion, 10'001))
    fastest = std::max(fastest, std::hypot(at.velocity[0], at.velocity[1], at.velocity[2]));
  EXPECT_NEAR(fastest, 0.5, 1e-9);
}

}  // namespace
}  // namespace pkm
