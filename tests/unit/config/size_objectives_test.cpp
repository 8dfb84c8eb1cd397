// Installation space, footprint, height, link length and mass, against hand calculations for the five-bar and the
// linear Delta.
#include <array>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/team.hpp"
#include "engine/workspace/installation_space.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

using testing::all_catalogues;
using ::testing::HasSubstr;

/// The text of a mechanism file with replacements.
SourceText file_with(const std::string& name, const std::vector<std::array<std::string, 2>>& changes = {}) {
  std::string text = test::text_of_mechanism(name);
  for (const auto& [from, to] : changes)
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  return {text, name + ".toml"};
}

Study study_of(const SourceText& file, const std::string& more) {
  return read_study_toml("[mechanism]\nfile = \"" + file.file_name + "\"\n" + more + "[[stage]]\noptimiser = \"ga\"\n",
                         "s.toml", all_catalogues(), file);
}

std::string complaint(const SourceText& file, const std::string& more) {
  try {
    study_of(file, more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

std::string output(const std::string& type, const std::string& more = "") {
  return "[[output]]\ntype = \"" + type + "\"\n" + more;
}

const std::string kOutputs =
    output("installation-space") + output("footprint") + output("height") + output("mass") + output("link-length");
const std::string kCranks = "[variables]\nl_a = { min = 0.2, max = 0.3 }\n";
const std::string kFiveBar = kCranks + "[[objective]]\ntype = \"mass\"\n";
const std::string kDelta = "[variables]\nl = { min = 0.4, max = 0.6 }\n[[objective]]\ntype = \"mass\"\n";

std::string cells(const std::string& x, int number, const std::string& y) {
  return "[workspace]\nmethod = \"voxels\"\ncells = { x = " + std::to_string(number) + ", y = 1 }\nbox = { x = [" + x +
         "], y = [" + y + "] }\n";
}

DesignReport report_of(const Study& study) { return study.problem->report(study.problem->parts().parameters); }
std::vector<double> values_of(const Study& study) { return report_of(study).reports; }

/// The end C of the left crank of the five-bar, for the platform at (x, y): the intersection of two circles on the far
/// side of the line from the pivot A to the platform.
std::array<double, 2> left_elbow(double x, double y) {
  const double d = 0.15, l_a = 0.25, l_b = 0.35;
  const double distance = std::hypot(x + d, y);
  const double along = (l_a * l_a + distance * distance - l_b * l_b) / (2 * distance);
  const double across = std::sqrt(l_a * l_a - along * along);
  const double u = (x + d) / distance, v = y / distance;
  return {-d + along * u - across * v, along * v + across * u};
}

TEST(SizeObjectives, BoxOfTheFiveBarAtOnePoseAndAtTwo) {
  const SourceText file = file_with("five-bar");
  const double r = 0.01;
  const auto [x, y] = left_elbow(0, 0.4);
  ASSERT_LT(x, -0.15);
  ASSERT_LT(y, 0.4);
  const std::vector<double> one =
      values_of(study_of(file, cells("-0.01, 0.01", 1, "0.39, 0.41") + kFiveBar + kOutputs));
  const double width = 2 * (-x + r), depth = 0.4 + 2 * r;  // from the pivots at y = 0 to the platform
  EXPECT_NEAR(one[0], width * depth * 2 * r, 1e-14);
  EXPECT_NEAR(one[1], width * depth, 1e-13);
  EXPECT_NEAR(one[2], 2 * r, 1e-15);
  EXPECT_NEAR(one[4], 2 * (0.25 + 0.35), 1e-14);

  // Cells with centres at x = -0.1 and 0.1: the leftmost elbow is that of the left pose, by symmetry also rightmost.
  const double left = std::min(left_elbow(-0.1, 0.4)[0], left_elbow(0.1, 0.4)[0]);
  const std::string motion =
      "[[motion]]\nname = \"across\"\ntype = \"points\"\ntime = 1\npoints = [{ x = -0.1, y = 0.4 }, { x = 0.1 }]\n";
  const std::string along = "motion = \"across\"\nsamples = 2\n";
  const std::vector<double> two = values_of(
      study_of(file, cells("-0.2, 0.2", 2, "0.39, 0.41") + kFiveBar + motion + output("footprint") +
                         output("footprint", "name = \"along\"\n" + along) + output("installation-space", along)));
  EXPECT_NEAR(two[0], 2 * (-left + r) * depth, 1e-13);
  EXPECT_NEAR(two[1], two[0], 1e-14);
  EXPECT_NEAR(two[2], two[0] * 2 * r, 1e-14);
}

TEST(SizeObjectives, BoxOfTheLinearDeltaIsThatOfItsRailsAndItsPlatform) {
  const std::vector<double> found = values_of(study_of(file_with("linear-delta"),
                                                       "[workspace]\nmethod = \"voxels\"\ncells = { x = 1, y = 1, z = "
                                                       "1 }\nbox = { x = [-0.01, 0.01], y = [-0.01, 0.01], "
                                                       "z = [-0.21, -0.19] }\n" +
                                                           kDelta + kOutputs));
  const double R = 0.3, r = 0.008, q_max = 0.6, z = -0.2;
  const double width = 1.5 * R + 2 * r, depth = std::sqrt(3) * R + 2 * r, height = q_max - z + 2 * r;
  EXPECT_NEAR(found[0], width * depth * height, 1e-13);
  EXPECT_NEAR(found[1], width * depth, 1e-13);
  EXPECT_NEAR(found[2], height, 1e-14);
  EXPECT_NEAR(found[3], 0.5 + 3 * (0.8 + 0.3 * 0.5), 1e-14);
  EXPECT_NEAR(found[4], 3 * (0.5 + 0.06), 1e-14);  // rods and the platform's arms, but not the rails
}

// A leg of the Gough-Stewart platform is longest at one of two poses.
TEST(SizeObjectives, LengthOfATelescopeIsTheLargestOne) {
  const Mechanism& mechanism = *test::described("gough");
  const std::vector<double> design = test::design_with(mechanism.info(), nlohmann::json::object());
  const std::string mode = mechanism.info().modes.front();
  const auto leg_lengths = [&](const Pose<double>& pose) {
    return mechanism.inspect(design, pose, mode, no_limits(mechanism.info())).joints.value();
  };
  const auto length = [&](const std::vector<Pose<double>>& poses) {
    return installation_space(mechanism, design, mode, poses).value().moving_length;
  };
  const Pose<double> left = {-0.1, 0, 1.4, 0, 0, 0}, right = {0.1, 0, 1.4, 0, 0, 0};
  double longest = 0, at_left = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    longest += std::max(leg_lengths(left)[i], leg_lengths(right)[i]);
    at_left += leg_lengths(left)[i];
  }
  EXPECT_GT(longest, at_left + 1e-3);
  EXPECT_NEAR(length({left, right}) - length({left}), longest - at_left, 1e-14);
}

TEST(SizeObjectives, MassOfRodsFromTheirSection) {
  const SourceText tubes =
      file_with("linear-delta", {{"rod_mass_per_length = \"0.3 kg/m\"",
                                  "rod_section = { density = \"2700 kg/m^3\", outer = \"10 mm\", inner = \"8 mm\" }"}});
  const double rods = 3 * 2 * 2700 * kPi / 4 * (0.01 * 0.01 - 0.008 * 0.008);  // per length; pairs of rods
  const std::string trains = "[[drive_train]]\njoint = \"all\"\nlead = \"10 mm\"\nrotor_inertia = 1e-5\n";
  for (const std::string& more : {std::string(), trains}) {
    const Study study = study_of(tubes, kDelta + more + "[[constraint]]\ntype = \"mass\"\nmax = \"4 kg\"\n");
    const DesignReport found = report_of(study);
    EXPECT_NEAR(found.objectives[0], 0.5 + 3 * 0.8 + rods * 0.5, 1e-14);
    EXPECT_NEAR(found.margins[0], 4 - found.objectives[0], 1e-14);
    EXPECT_EQ(study.problem->objectives()[0].direction, Direction::minimise);
    const std::size_t l = study.problem->parts().varies[0];
    EXPECT_NEAR(study.problem->derivatives(found.parameters, {&l, 1})[1], rods, 1e-14);
  }
}

TEST(SizeObjectives, NumberOfThreadsDoesNotMatter) {
  const Mechanism& mechanism = *test::described("rotary-delta");
  const std::vector<double> design = test::design_with(mechanism.info(), nlohmann::json::object());
  std::vector<Pose<double>> poses;
  for (int k = 0; k < 500; ++k) poses.push_back({0.1 * std::sin(k), 0.1 * std::cos(1.3 * k), -0.4 - 1e-4 * k});
  const auto with_threads = [&](int threads) {
    std::optional<Bounds<double>> box;
    with_team(threads,
              [&] { box = installation_space(mechanism, design, mechanism.info().modes.front(), poses)->box; });
    return box.value();
  };
  const Bounds<double> one = with_threads(1), two = with_threads(2);
  EXPECT_EQ(one.lower, two.lower);
  EXPECT_EQ(one.upper, two.upper);
  poses.push_back({0, 0, 50});
  EXPECT_FALSE(installation_space(mechanism, design, mechanism.info().modes.front(), poses));
  EXPECT_FALSE(installation_space(mechanism, design, mechanism.info().modes.front(), {}));
}

TEST(SizeObjectives, WithoutPosesTheDesignFails) {
  const SourceText file = file_with("five-bar");
  const std::string objective = "[[objective]]\ntype = \"height\"\n";
  const DesignReport empty = report_of(study_of(file, cells("-0.01, 0.01", 1, "0.7, 0.72") + kCranks + objective));
  EXPECT_EQ(empty.status, Status::failed);
  EXPECT_EQ(empty.reason, "height: no pose is feasible");
  const std::string motion =
      "[[motion]]\nname = \"up\"\ntype = \"points\"\ntime = 1\nfollow = false\n"
      "points = [{ x = 0, y = 0.4 }, { y = 0.8 }]\n";
  const DesignReport beyond =
      report_of(study_of(file, kCranks + motion + objective + "motion = \"up\"\nsamples = 2\n"));
  EXPECT_EQ(beyond.status, Status::failed);
  EXPECT_EQ(beyond.reason, "height: the motion up leaves the reach of the mechanism at t = 1 s");
}

TEST(SizeObjectives, AreRefusedWithoutLinksOrMasses) {
  EXPECT_THAT(complaint(file_with("five-bar", {{"radius   = \"10 mm\"\n", ""}}), kFiveBar + output("footprint")),
              HasSubstr("objective footprint needs links, and mechanism five-bar has none; define `radius` in its "
                        "limbs, or [[link]], in the mechanism file"));
  EXPECT_THAT(complaint(file_with("linear-delta", {{"mass = \"0.5 kg\"\n", ""},
                                                   {"slider_mass         = \"0.8 kg\"\n", ""},
                                                   {"rod_mass_per_length = \"0.3 kg/m\"", ""}}),
                        kDelta),
              HasSubstr("objective mass needs masses, and mechanism linear-delta has none"));
  const std::string solver = "[[stage]]\noptimiser = \"ipopt\"\n[[objective]]\ntype = \"height\"\n";
  EXPECT_THAT(complaint(file_with("linear-delta"), "[variables]\nl = { min = 0.4, max = 0.6 }\n" + solver),
              HasSubstr("the optimiser ipopt needs derivatives, but height is an extremum over poses and links, which "
                        "has none; use an optimiser without gradients"));
}

TEST(SizeObjectives, OneAnalysisHasOneWorkingMode) {
  const SourceText file = file_with("five-bar");
  const std::string region = "[[region]]\nname = \"task\"\n",
                    across =
                        "[[motion]]\nname = \"across\"\ntype = \"points\"\ntime = 1\n"
                        "points = [{ x = -0.1, y = 0.4 }, { x = 0.1 }]\n";
  const std::string& other = test::described("five-bar")->info().modes.back();
  EXPECT_THAT(complaint(file, kFiveBar + output("height") + output("footprint", "mode = \"" + other + "\"\n")),
              HasSubstr("the same workspace analysis is requested in two working modes, "));
  EXPECT_EQ(complaint(file, kFiveBar + region + output("height") +
                                output("footprint", "mode = \"" + other + "\"\nregion = \"task\"\n")),
            "accepted");
  EXPECT_THAT(
      complaint(file, kFiveBar + region + across + output("height", "region = \"task\"\nmotion = \"across\"\n")),
      HasSubstr("the objective height is evaluated either along a motion or in a region; give one of them"));
}

}  // namespace
}  // namespace pkm
