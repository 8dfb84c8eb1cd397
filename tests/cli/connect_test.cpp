// `pkmopt connect`, and the component of a home pose in `evaluate`, `workspace` and `certify`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

const std::string kConnectivity = PKM_EXPERIMENTS "/mechanisms/connectivity/";
const std::string kFiveBar = PKM_EXPERIMENTS "/mechanisms/five-bar.toml";

class Connect : public ::testing::Test {
 protected:
  ProgramResult run(const std::vector<std::string>& arguments) const { return pkmopt(arguments, folder_.path()); }
  ProgramResult connect(const std::string& file, const std::string& from, const std::string& to,
                        const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"connect", file, "--from", from, "--to", to, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  StudyFolder folder_;
};

/// reference: the feasible rotations at the centre are 28.458 to 101.537 deg, and their negatives
TEST_F(Connect, FindsAPathWithinOneComponentOfA3Rpr) {
  const auto found = connect(kConnectivity + "3-rpr.toml", "x=0,y=0,phi=40deg", "x=0.02,y=-0.03,phi=80deg",
                             {"--cells", "24", "-o", "path.toml"});
  ASSERT_EQ(found.exit_code, 0) << found.err << found.out;
  EXPECT_EQ(found.json()["path"], "yes");
  const auto points = found.json()["points"];
  EXPECT_EQ(points.front()["phi"], found.json()["from"]["phi"]);
  EXPECT_EQ(points.back(), found.json()["to"]);
  const auto certified = run({"certify", kConnectivity + "3-rpr.toml", "--motion", "path.toml", "--json"});
  ASSERT_EQ(certified.exit_code, 0) << certified.err;
  EXPECT_EQ(certified.json()["feasible"]["verdict"], "yes");
  EXPECT_EQ(certified.json()["regular"]["verdict"], "yes");
}

TEST_F(Connect, ProvesThatTheComponentsOfA3RprAreSeparate) {
  const auto found =
      connect(kConnectivity + "3-rpr.toml", "x=0,y=0,phi=60deg", "x=0,y=0,phi=-60deg", {"--cells", "24"});
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_EQ(found.json()["path"], "no") << found.out;
  EXPECT_THAT(found.json()["reason"], HasSubstr("(proven)"));
  const auto one = connect(kConnectivity + "3-rpr.toml", "x=0,y=0,phi=60deg", "x=0,y=0,phi=60deg");
  EXPECT_EQ(one.json()["path"], "yes");
  const auto infeasible = connect(kConnectivity + "3-rpr.toml", "x=0,y=0,phi=60deg", "x=0,y=0,phi=0");
  EXPECT_EQ(infeasible.exit_code, 1);
  EXPECT_THAT(infeasible.json()["reason"], HasSubstr("the pose --to is infeasible"));
}

TEST_F(Connect, ReportsInvalidArguments) {
  EXPECT_THAT(connect(kFiveBar, "x=0", "x=0,y=0.3").err, HasSubstr("no value of y; expected values of x, y"));
  EXPECT_THAT(connect("quadrupteron", "x=0,y=0,z=0.3,phi=0", "x=0,y=0,z=0.3,phi=0.1").err, HasSubstr("--to"));
  EXPECT_THAT(run({"connect", kFiveBar, "--from", "x=0,y=0.3"}).err, HasSubstr("--to"));
}

/// reference: an independent program, 36122.1 mm^2 on the side of (0, 300) mm, 36600.1 mm^2 on both sides
TEST_F(Connect, HomePoseSelectsOneSideOfAFiveBar) {
  const auto one = run({"workspace", kConnectivity + "five-bar.toml", "--cells", "800", "--json"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  const auto printed = one.json();
  EXPECT_NEAR(printed["volume"].get<double>(), 0.0361221, 2e-5);
  double both = 0;
  for (const auto& component : printed["components"]) {
    both += component["volume"].get<double>();
    EXPECT_EQ(component["home"].get<bool>(), component == printed["components"][0]);
  }
  EXPECT_NEAR(both, 0.0366001, 3e-5);
  const auto evaluated = run({"evaluate", kConnectivity + "five-bar.toml", "--json"});
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
  EXPECT_NEAR(evaluated.json()["objectives"]["workspace-volume"].get<double>(), 0.0361221, 1e-4);
  const auto failed = run({"evaluate", kConnectivity + "five-bar.toml", "--set", "l_a=0.1,l_b=0.1"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.out + failed.err, HasSubstr("the home pose x = 0 m, y = 0.31 m is infeasible"));
}

/// reference: half of the exact volume of the whole workspace, by symmetry
TEST_F(Connect, HomePoseSelectsOneSideOfAnExactWorkspace) {
  const auto evaluated = run({"evaluate", kConnectivity + "3-rpr-side.toml", "--json"});
  ASSERT_EQ(evaluated.exit_code, 0) << evaluated.err;
  const auto workspace = evaluated.json()["workspace"];
  EXPECT_NEAR(workspace["volume"].get<double>(), 0.115496444715 / 2, 1e-10);
  EXPECT_LT(workspace["relative_error"].get<double>(), 1e-3);
  EXPECT_FALSE(workspace["certified"].get<bool>());
}

TEST_F(Connect, HomePoseIsRead) {
  const std::string mechanism =
                        "[mechanism]\nfile = \"" + kFiveBar + "\"\n[variables]\nl_a = { min = 0.1, max = 0.4 }\n",
                    objective = "[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\n";
  const auto error_of = [&](const std::string& workspace) {
    folder_.write("study.toml", mechanism + "[workspace]\n" + workspace + objective);
    return run({"check", "study.toml"}).err;
  };
  EXPECT_THAT(error_of("certified = true\nhome = { x = 0, y = 0.3 }\n"), HasSubstr("remove `certified` or `home`"));
  EXPECT_THAT(error_of("method = \"voxels\"\nhome = { x = 0 }\n"), HasSubstr("home.y"));
  EXPECT_THAT(error_of("method = \"voxels\"\nhome = { x = 0, y = 0.3, q = 1 }\n"), HasSubstr("home.q"));
  EXPECT_EQ(error_of("method = \"voxels\"\nexact = true\nhome = { x = 0, y = 0.3 }\n"), "");
  EXPECT_EQ(error_of("method = \"voxels\"\nhome = { x = 0, y = \"300 mm\" }\n"), "");
  EXPECT_THAT(run({"check", "study.toml"}).out, HasSubstr("home"));
  EXPECT_THAT(run({"certify", "study.toml"}).err, HasSubstr("remove home"));
}

}  // namespace
}  // namespace pkm::testing
