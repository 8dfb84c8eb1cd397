// `pkmopt workspace --largest-box` and its siblings: closed forms, an independent fine grid, and messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;

const std::string kSolidRobots = PKM_EXPERIMENTS "/mechanisms/";
const std::string kCylinders = PKM_TEST_DATA "/generic/three-cylinders.toml";

class CliLargestSolid : public ::testing::Test {
 protected:
  /// The solid called `name` that `pkmopt workspace` finds.
  json largest(const std::string& name, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"workspace", "--json", "--cells", "24", "--largest-" + option_of(name)});
    const auto result = pkmopt(arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.json()["largest"][name];
  }
  static std::string option_of(const std::string& name) {
    return name == "circle" ? "sphere" : name == "rectangle" ? "box" : name;
  }

  StudyFolder folder_;
};

constexpr double kTolerance = 1e-9;  // of the closed forms

TEST_F(CliLargestSolid, OfThreeEqualCylinders) {
  const std::vector<std::string> design = {kCylinders, "--set", "r1=0.8,r2=0.8,r3=0.8,dx=0,dy=0,dz=0"};
  for (const bool is_cube : {true, false}) {
    std::vector<std::string> arguments = design;
    if (is_cube) arguments.insert(arguments.end(), {"--ratio", "1:1:1"});
    const json box = largest("box", arguments);
    for (const char* axis : {"x", "y", "z"}) {
      EXPECT_NEAR(box["dimensions"][axis], std::sqrt(2) * 0.8, kTolerance);
      EXPECT_NEAR(box["centre"][axis], 0, kTolerance);
    }
  }
  const json sphere = largest("sphere", design);
  EXPECT_NEAR(sphere["dimensions"]["diameter"], 2 * 0.8, kTolerance);
}

/// Symmetrical five-bar: Liu, Wang, Pritschow, Mech. Mach. Theory 41 (2006), the largest circle without stretched or
/// folded limbs and on one side of det G = 0.
TEST_F(CliLargestSolid, CircleOfFiveBar) {
  for (const auto& [r1, r2, r3] : {std::array{0.23, 0.23, 0.1375}, std::array{1.0, 1.4, 0.6}}) {
    const double column = std::sqrt(r1 * r1 - std::pow(r2 - r3, 2)), S = r1 + r2 + column;
    const double y = (S * S - r3 * r3) / (2 * S);
    const json circle =
        largest("circle", {kSolidRobots + "five-bar.toml", "--set",
                           "d=" + std::to_string(r3) + ",l_a=" + std::to_string(r1) + ",l_b=" + std::to_string(r2)});
    EXPECT_NEAR(circle["dimensions"]["diameter"], 2 * (y - column), kTolerance);
    EXPECT_NEAR(circle["centre"]["y"], y, kTolerance);
    EXPECT_NEAR(circle["centre"]["x"], 0, kTolerance);
    EXPECT_TRUE(circle["regular"]);
    const json singular =
        largest("circle", {kSolidRobots + "five-bar.toml", "--singular", "--set",
                           "d=" + std::to_string(r3) + ",l_a=" + std::to_string(r1) + ",l_b=" + std::to_string(r2)});
    EXPECT_GT(singular["dimensions"]["diameter"], circle["dimensions"]["diameter"]);
    EXPECT_FALSE(singular["regular"]);
  }
}

TEST_F(CliLargestSolid, CylinderOfLinearDelta) {
  const std::vector<std::string> design = {kSolidRobots + "linear-delta.toml", "--set",
                                           "R=0.26,r=0.06,l=0.5,q_max=0.6"};
  const json cylinder = largest("cylinder", design);
  EXPECT_NEAR(cylinder["volume"], 0.062862258, 1e-9);  // reference values: maximum of pi rho^2 h(rho)
  const double R = 0.2, L = 0.5, s = 0.6, rho = double(cylinder["dimensions"]["diameter"]) / 2;
  EXPECT_NEAR(rho, 0.258806029, 1e-7);
  const double h = s - std::sqrt(L * L - std::pow(std::max(0.0, R - rho), 2)) + std::sqrt(L * L - std::pow(R + rho, 2));
  EXPECT_NEAR(cylinder["dimensions"]["height"], h, kTolerance);
}

/// Velocity factors between 1/2 and 2: Chablat and Wenger, IEEE Trans. Robotics and Automation 19 (2003).
TEST_F(CliLargestSolid, CubeOfOrthoglide) {
  const std::string study =
      folder_.write("orthoglide.toml", "[mechanism]\nfile = \"" + kSolidRobots + R"(orthoglide.toml"
[variables]
L = { min = 0.3, max = 0.32 }
[workspace]
method = "voxels"
cells = { x = 24, y = 24, z = 24 }
limits = { velocity_transmission = { min = 0.5 }, force_transmission = { min = 0.5 } }
[[objective]]
type = "largest-box"
ratio = "1:1:1"
measure = "size"
[[stage]]
optimiser = "ga"
)");
  const double edge = 0.31058 * (1 / std::sqrt(6) + 1 / std::sqrt(18));
  const std::string design = "L=0.31058,q_min=0,q_max=0.6";
  const json cube = largest("box", {study, "--ratio", "1:1:1", "--set", design});
  EXPECT_NEAR(cube["dimensions"]["x"], edge, kTolerance);
  const auto evaluated = pkmopt({"evaluate", study, "--json", "--set", design}, folder_.path());
  EXPECT_NEAR(evaluated.json()["objectives"]["largest-box"], edge, kTolerance) << evaluated.out;
}

/// Edge length [cells] of the largest cube of feasible cells in a cubic grid, by exhaustive search.
int longest_edge(const std::vector<bool>& feasible, int cells) {
  const auto fits = [&](int i, int j, int k, int edge) {
    for (int a = i; a < i + edge; ++a)
      for (int b = j; b < j + edge; ++b)
        for (int c = k; c < k + edge; ++c)
          if (!feasible.at(static_cast<std::size_t>((a * cells + b) * cells + c))) return false;
    return true;
  };
  int longest = 0;  // a cube that contains a smaller one
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k)
        while (std::max({i, j, k}) + longest < cells && fits(i, j, k, longest + 1)) ++longest;
  return longest;
}

TEST_F(CliLargestSolid, CubeOfRandomDeltasAgreesWithAFineGrid) {
  constexpr int kCells = 48;
  constexpr double kStep = 1.2 / kCells;  // [m]
  std::minstd_rand random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (int design = 0; design < 3; ++design) {
    const std::string set = "R=" + std::to_string(0.15 + 0.1 * share(random)) +
                            ",l_a=" + std::to_string(0.2 + 0.1 * share(random)) +
                            ",l_b=" + std::to_string(0.45 + 0.1 * share(random));
    SCOPED_TRACE(set);
    const auto result = pkmopt({"workspace", kSolidRobots + "rotary-delta.toml", "--set", set, "--json", "--csv",
                                "cells.csv", "--force", "--cells", std::to_string(kCells), "--box",
                                "x=-0.6:0.6,y=-0.6:0.6,z=-1.2:0", "--largest-box", "--ratio", "1:1:1"},
                               folder_.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json cube = result.json()["largest"]["box"];
    std::ifstream in(folder_.path() + "/cells.csv");
    std::string line;
    std::getline(in, line);
    ASSERT_TRUE(line.starts_with("x [m],y [m],z [m],feasible")) << line;
    std::vector<bool> feasible;
    while (std::getline(in, line)) {
      std::istringstream row(line);
      std::array<std::string, 4> words;
      bool is_inside = true;
      for (std::string& word : words) std::getline(row, word, ',');
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const json range = cube["box"][std::string(1, "xyz"[axis])];
        const double at = std::stod(words[axis]);
        is_inside = is_inside && at >= double(range[0]) && at <= double(range[1]);
      }
      feasible.push_back(words[3] == "1");
      EXPECT_TRUE(feasible.back() || !is_inside) << line;
    }
    ASSERT_EQ(feasible.size(), static_cast<std::size_t>(kCells * kCells * kCells));
    // The cells' centres of the largest cube of cells span at most the largest cube, and at least two steps less.
    const double edge = cube["dimensions"]["x"], grid = (longest_edge(feasible, kCells) - 1) * kStep;
    EXPECT_GE(edge, grid - 1e-9);
    EXPECT_LE(edge, grid + 2 * kStep);
  }
}

TEST_F(CliLargestSolid, HasAGivenCentreAndIsReachableInListedOrientations) {
  const std::string cylinder = kSolidRobots + "linear-delta.toml";
  const json given = largest("cylinder", {cylinder, "--ratio", "2:1", "--centre", "x=0.02,z=-50mm"});
  EXPECT_EQ(given["centre"]["x"], 0.02);
  EXPECT_EQ(given["centre"]["z"], -0.05);
  EXPECT_NEAR(double(given["dimensions"]["diameter"]) / double(given["dimensions"]["height"]), 2, 1e-12);
  const json free = largest("cylinder", {cylinder, "--ratio", "2:1"});
  EXPECT_GT(free["volume"], given["volume"]);
  // 3-RRR: a circle that is reachable at both angles is at most as large as at each of them.
  const auto circle = [this](const std::string& phi) {
    const std::string study = folder_.write("rrr.toml", "[mechanism]\nfile = \"" + kSolidRobots + R"(3-rrr.toml"
[variables]
l_a = { min = 0.15, max = 0.2 }
[[region]]
name = "here"
method = "voxels"
sweep = ["x", "y"]
cells = { x = 24, y = 24 }
phi = )" + phi + R"(
[[objective]]
type = "largest-sphere"
region = "here"
[[stage]]
optimiser = "ga"
)");
    const auto result = pkmopt({"evaluate", study, "--json"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return double(result.json()["objectives"]["largest-sphere"]);
  };
  const double both = circle("[0, 0.3]"), first = circle("0"), second = circle("0.3");
  EXPECT_GT(both, 0);
  EXPECT_LE(both, std::min(first, second) + 1e-12);
}

TEST_F(CliLargestSolid, HasDerivativesAsAnObjective) {
  for (const auto& [objective, options] : {std::pair("largest-cylinder", "ratio = \"2:1\""),
                                           {"largest-cylinder", ""},
                                           {"largest-box", "centre = { x = 0.01, y = 0.02 }"},
                                           {"largest-box", ""}}) {
    SCOPED_TRACE(std::string(objective) + ", " + options);
    const std::string study = folder_.write("derivatives.toml", "[mechanism]\nfile = \"" + kSolidRobots +
                                                                    R"(rotary-delta.toml"
[variables]
R = { min = 0.15, max = 0.25 }
l_b = { min = 0.45, max = 0.6 }
[workspace]
method = "voxels"
cells = { x = 24, y = 24, z = 24 }
[[objective]]
type = ")" + std::string(objective) + "\"\n" + options + R"(
[[stage]]
optimiser = "nlopt"
algorithm = "slsqp"
)");
    const auto at = [&](const std::string& set) {
      return pkmopt({"evaluate", study, "--json", "--sensitivity", "--set", set}, folder_.path()).json();
    };
    const json exact = at("R=0.2,l_b=0.5");
    const auto value = [&at, name = objective](const std::string& set) { return double(at(set)["objectives"][name]); };
    constexpr double kStep = 1e-5;  // [m]
    EXPECT_NEAR(double(exact["sensitivities"][objective]["R"]),
                (value("R=0.20001,l_b=0.5") - value("R=0.19999,l_b=0.5")) / (2 * kStep), 1e-6);
    EXPECT_NEAR(double(exact["sensitivities"][objective]["l_b"]),
                (value("R=0.2,l_b=0.50001") - value("R=0.2,l_b=0.49999")) / (2 * kStep), 1e-6);
  }
}

/// The best design of a study is proven, and its report draws the solid.
TEST_F(CliLargestSolid, IsCertifiedAtTheEndOfAStudyAndShownInItsReport) {
  const std::string study =
      folder_.write("cylinder.toml", "[mechanism]\nfile = \"" + kSolidRobots + R"(linear-delta.toml"
[variables]
R = { min = 0.2, max = 0.3 }
[workspace]
method = "voxels"
cells = { x = 12, y = 12, z = 12 }
exact = false
[[objective]]
type = "largest-cylinder"
ratio = "2:1"
[[output]]
type = "largest-box"
[[stage]]
optimiser = "ga"
generations = 1
population = 4
)");
  const auto run = pkmopt({"run", study, "-o", "cylinder.h5"}, folder_.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const std::string measure : {"largest-cylinder", "largest-box"})
    EXPECT_THAT(run.out,
                ::testing::HasSubstr("reduced by 0.1 %, the " + measure +
                                     " of the best design is feasible and not singular everywhere (certified)"));
  ASSERT_EQ(pkmopt({"report", "cylinder.h5", "-o", "cylinder.html"}, folder_.path()).exit_code, 0);
  std::ostringstream page;
  page << std::ifstream(folder_.path() + "/cylinder.html").rdbuf();
  EXPECT_THAT(page.str(), ::testing::HasSubstr(R"("solids":[{"name":"largest-cylinder","shape":"cylinder")"));
  EXPECT_THAT(page.str(), ::testing::HasSubstr(R"("balls":[[0,1],[2]])"));
}

TEST_F(CliLargestSolid, IsNullWithoutFeasibleCellsAndReportsWrongOptions) {
  const std::string robot = kSolidRobots + "rotary-delta.toml";
  EXPECT_EQ(largest("box", {robot, "--least", "conditioning=1"}), nullptr);
  const auto error_of = [](std::vector<std::string> words) {
    words.insert(words.begin(), "workspace");
    const auto result = pkmopt(words);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(error_of({"4ppa-2par", "--largest-box"}), HasSubstr("the workspace is over theta, an angle"));
  EXPECT_THAT(error_of({robot, "--largest-box", "--ratio", "1:2"}),
              HasSubstr("ratio: found '1:2'; expected 3 positive numbers separated by colons, of x:y:z"));
  EXPECT_THAT(error_of({robot, "--largest-cylinder", "--axis", "w"}), HasSubstr("axis: found 'w'"));
  EXPECT_THAT(error_of({kSolidRobots + "five-bar.toml", "--largest-cylinder"}),
              HasSubstr("a cylinder needs three lengths"));
  EXPECT_THAT(error_of({robot, "--largest-box", "--least", "conditionin=1"}),
              HasSubstr("--least: found the unknown name 'conditionin'"));
  EXPECT_EQ(error_of({robot, "--ratio", "1:1:1"}),
            "pkmopt: --ratio: found no solid; expected --largest-box, --largest-cylinder or --largest-sphere\n");
}

TEST_F(CliLargestSolid, RangesOfCoordinatesFromAHomePose) {
  const auto result = pkmopt({"workspace", kSolidRobots + "five-bar.toml", "--json", "--cells", "8", "--ranges",
                              "--home", "x=0,y=300mm", "--set", "d=0.1375,l_a=0.23,l_b=0.23"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json ranges = result.json()["ranges"];
  // At y = 0.3 a limb is stretched at the distance l_a + l_b of the point from its pivot.
  const double reach = std::sqrt(0.46 * 0.46 - 0.3 * 0.3) - 0.1375;
  EXPECT_NEAR(ranges["x"]["upper"], reach, 1e-12);
  EXPECT_NEAR(ranges["x"]["lower"], -reach, 1e-12);
  EXPECT_NEAR(ranges["y"]["upper"], std::sqrt(0.46 * 0.46 - 0.1375 * 0.1375), 1e-12);
}

}  // namespace
}  // namespace pkm::testing
