// Motions whose times and coordinates are formulas of parameters.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/config/motion_table.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using testing::all_catalogues;
using ::testing::HasSubstr;

const std::string kMotionParameters = R"([parameters]
T = { default = "0.3 s", min = "0.01 s", max = "2 s", unit = "s" }
reach = { default = "305 mm", min = "10 mm", max = "1 m" }
[variables]
T = { min = "0.1 s", max = "1 s" }
reach = { min = "0.2 m", max = "0.4 m" }
l_a = { min = "0.15 m", max = "0.3 m" }
)";
const std::string kAlongTheCycle = R"(
[[objective]]
type = "energy"
motion = "cycle"
[[constraint]]
type = "motor-torque"
motion = "cycle"
statistic = "rms"
max = 2
)";
const std::string kTrains = "[[drive_train]]\njoint = \"all\"\ngear = 10\nrotor_inertia = 6e-5\nviscous = 0.05\n";

std::string table_of_cycle(const std::string& time, const std::string& x, const std::string& reach,
                           const std::string& law = "quintic") {
  return "[[motion]]\nname = \"cycle\"\ntype = \"pick-and-place\"\nx = " + x +
         "\ny = 0\nz = -0.5\nlift = 0.025\nreach = " + reach + "\nlift_time = " + time + "\nreach_time = " + time +
         "\ncycle = \"whole\"\nlaw = \"" + law + "\"\n";
}
Study moving_study(const std::string& more) {
  return read_study_toml(
      "[mechanism]\nfile = \"rotary-delta.toml\"\n[workspace]\nmethod = \"columns\"\nlimits = { clear_z = 0.3 }\n" +
          more,
      "s.toml", all_catalogues(), SourceText{test::text_of_mechanism("rotary-delta"), "rotary-delta.toml"});
}
std::string moving_complaint(const std::string& more) {
  try {
    moving_study(more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MotionWithParameters, IsThatWithTheirValues) {
  const Study with =
      moving_study(kMotionParameters + table_of_cycle("\"T\"", "\"-reach/2\"", "\"reach\"") + kTrains + kAlongTheCycle);
  const Study without = moving_study(table_of_cycle("0.25", "-0.15", "0.3") + kTrains + kAlongTheCycle);
  const std::vector<double>& nominal = without.problem->parts().parameters;
  std::vector<double> design = nominal;
  design.insert(design.end(), {0.25, 0.3});  // T and reach follow the parameters of the mechanism
  const DesignReport a = with.problem->report(design), b = without.problem->report(nominal);
  ASSERT_TRUE(std::isfinite(a.objectives.at(0)));
  EXPECT_EQ(a.objectives, b.objectives);
  EXPECT_EQ(a.margins, b.margins);
  EXPECT_EQ(with.motions[0].at(design)->duration(), without.motions[0].motion->duration());
  EXPECT_EQ(with.motions[0].motion->duration(), 6 * 0.3);
  EXPECT_EQ(with.problem->parts().followed.at(0).motion.at(design)->duration(), 6 * 0.25);
}

TEST(MotionWithParameters, HasDerivatives) {
  const Study study =
      moving_study(kMotionParameters + table_of_cycle("\"T\"", "\"-reach/2\"", "\"reach\"") + kTrains + kAlongTheCycle);
  ASSERT_FALSE(study.problem->why_no_derivatives());
  const std::vector<std::size_t> by = study.problem->parts().varies;
  const std::size_t width = 1 + by.size();
  const std::vector<double> design = study.problem->parameters(std::vector<double>{0.23, 0.29, 0.21});
  const std::vector<double> found = study.problem->derivatives(design, by);
  ASSERT_GE(found.size(), 3 * width);  // energy, motor-torque, the constraint `motion`
  for (std::size_t k = 0; k < by.size(); ++k) {
    constexpr double kStep = 1e-6;
    std::vector<double> more = design, less = design;
    more[by[k]] += kStep;
    less[by[k]] -= kStep;
    const std::vector<double> above = study.problem->derivatives(more, by),
                              below = study.problem->derivatives(less, by);
    for (std::size_t row = 0; row < found.size(); row += width) {
      const double difference = (above[row] - below[row]) / (2 * kStep);
      EXPECT_NEAR(found[row + 1 + k], difference, 1e-5 * std::fmax(1, std::fabs(difference))) << row << ' ' << k;
    }
  }
  EXPECT_LT(found[1], 0);  // a longer time needs less energy
}

TEST(MotionWithParameters, MayBeFormulasOfTime) {
  const Study study = moving_study(kMotionParameters + R"toml([[motion]]
name = "cycle"
type = "formulas"
duration = "T"
x = "reach/2*sin(2*pi*t/T)"
y = "0.05*cos(2*pi*t)"
z = "-500 mm"
)toml");
  std::vector<double> design = study.problem->parts().parameters;
  design[design.size() - 2] = 0.4;
  design.back() = 0.3;
  const MotionSample at = study.motions[0].at(design)->at(0.1);
  EXPECT_NEAR(at.pose[0], 0.15, 1e-15);
  EXPECT_NEAR(at.acceleration[0], -0.15 * std::pow(2 * kPi / 0.4, 2), 1e-11);
  EXPECT_NEAR(at.velocity[1], -0.05 * 2 * kPi * std::sin(0.2 * kPi), 1e-14);
}

// At the fraction s of the duration T, x = reach/2 sin(2 pi s); the velocity is proportional to 1/T, and the
// acceleration to 1/T^2.
TEST(MotionWithParameters, HasSamplesWithDerivativesToElevenDigits) {
  const Study study = moving_study(kMotionParameters + R"toml([[motion]]
name = "cycle"
type = "formulas"
duration = "T"
x = "reach/2*sin(2*pi*t/T)"
y = "0"
z = "-500 mm"
)toml");
  const std::vector<double>& values = study.problem->parts().parameters;
  std::vector<Dual4> design(values.begin(), values.end());
  constexpr double kT = 0.4, kReach = 0.3;
  design[values.size() - 2] = Dual4::variable(kT, 0);
  design.back() = Dual4::variable(kReach, 1);
  constexpr std::size_t kSamples = 8;
  const auto samples = sample_with_derivatives(study.motions[0], design, kSamples);
  for (std::size_t k = 1; k < kSamples - 1; ++k) {
    const DualMotionSample& at = samples[k];
    const double s = at.time.a / kT, omega = 2 * kPi / kT, x = kReach / 2 * std::sin(2 * kPi * s),
                 v = kReach / 2 * omega * std::cos(2 * kPi * s), a = -omega * omega * x;
    const auto expect = [](double found, double expected) {
      EXPECT_NEAR(found, expected, 1e-11 * std::fmax(1, std::fabs(expected)));
    };
    expect(at.time.v[0], s);
    expect(at.pose[0].v[0], 0);
    expect(at.velocity[0].v[0], -v / kT);
    expect(at.acceleration[0].v[0], -2 * a / kT);
    expect(at.pose[0].v[1], x / kReach);
    expect(at.velocity[0].v[1], v / kReach);
    expect(at.acceleration[0].v[1], a / kReach);
  }
}

TEST(MotionWithParameters, MayBeAFile) {
  const Study study = moving_study(kMotionParameters + table_of_cycle("0.2", "0", "0.1"));
  const MotionNames names = motion_names(*study.problem->parts().mechanism, study.problem->parts().parameters);
  const auto motion = read_motion_toml(
      "type = \"points\"\ntime = \"2*T\"\npoints = [{ x = 0, y = 0, z = \"-l_b\" }, { x = \"reach\", wait = \"T\" }]\n",
      "m.toml", names);
  EXPECT_EQ(motion->duration(), 3 * 0.3);
  EXPECT_EQ(motion->at(0).pose[2], -0.5);
  EXPECT_EQ(motion->at(0.8).pose[0], 0.305);
}

TEST(MotionWithParameters, ErrorsSayWhatIsWrong) {
  const auto time = [](const std::string& formula) {
    return kMotionParameters + table_of_cycle(formula, "0", "0.1") + kAlongTheCycle;
  };
  EXPECT_THAT(moving_complaint(time("\"2*Tt\"")), HasSubstr("lift_time"));
  EXPECT_THAT(moving_complaint(time("\"2*Tt\"")), HasSubstr("Tt"));
  EXPECT_THAT(moving_complaint(time("\"T - 1\"")), HasSubstr("T - 1\" = -0.7"));
  EXPECT_THAT(moving_complaint(time("\"t\"")), HasSubstr("t"));
  EXPECT_THAT(moving_complaint(time("\"20 s s\"")), HasSubstr("lift_time"));
  const Study study = moving_study(time("\"T - 0.2\"") + kTrains);
  const DesignReport report = study.problem->report(study.problem->parameters(std::vector<double>{0.1, 0.3, 0.2}));
  EXPECT_EQ(report.status, Status::failed);
  EXPECT_THAT(report.reason, HasSubstr("the design has no motion cycle"));
  EXPECT_THAT(moving_complaint(kMotionParameters + table_of_cycle("\"T\"", "0", "0.1", "trapezoid") + kAlongTheCycle +
                               kTrains + "[[stage]]\noptimiser = \"nlopt\"\n"),
              HasSubstr("use the law quintic or cycloid"));
  EXPECT_THAT(moving_complaint(kMotionParameters + table_of_cycle("\"T\"", "0", "0.1") +
                               "[[objective]]\ntype = \"cycle-time\"\nmotion = \"cycle\"\ntool_acceleration = 100\n" +
                               "[[stage]]\noptimiser = \"nlopt\"\n"),
              HasSubstr("cycle-time has no derivatives by parameters of the motion"));
}

TEST(ParametersOfAStudy, AreParametersOfItsMechanism) {
  EXPECT_THAT(moving_complaint("[parameters]\nl_a = { default = 1, min = 0, max = 2 }\n"), HasSubstr("l_a"));
  const Study study = moving_study(
      "[parameters]\nk = { default = 1, min = 0, max = 2 }\n[variables]\nk = { min = 0, max = 1 }\n"
      "[[objective]]\ntype = \"expression\"\nexpression = \"k*l_a\"\n");
  EXPECT_EQ(study.problem->report(study.problem->parameters(std::vector<double>{0.5})).objectives.at(0), 0.1);
}

}  // namespace
}  // namespace pkm
