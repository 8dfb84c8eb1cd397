// Mechanisms whose conditioning is undefined: every command that needs it refuses, and it is never reported as 0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kRadius = "[platform] needs characteristic_radius";
const std::string kBoth = "[platform] needs characteristic_length and characteristic_radius";

/// A folder with two robots and a study of each.
class UndefinedConditioning : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"crank-and-slide", "double-scara", "crank-and-slide-study", "double-scara-study"})
      folder_.write(name + std::string(".toml"), text(name));
  }
  static std::string text(const std::string& name) {
    std::ostringstream all;
    all << std::ifstream(PKM_TEST_DATA "/robots/" + name + ".toml").rdbuf();
    return all.str();
  }
  /// Writes the robot's file with a line inserted after the line that contains `after`.
  void write_with(const std::string& robot, const std::string& after, const std::string& line) const {
    std::string file = text(robot);
    const std::size_t at = file.find(after);
    ASSERT_NE(at, std::string::npos);
    folder_.write(robot + ".toml", file.insert(file.find('\n', at) + 1, line + "\n"));
  }
  ProgramResult run(const std::vector<std::string>& arguments) const { return pkmopt(arguments, folder_.path()); }

  StudyFolder folder_;
};

TEST_F(UndefinedConditioning, IsRefusedByStudiesWithItsLine) {
  for (const char* command : {"check", "run", "evaluate"}) {
    const auto slide = run({command, "crank-and-slide-study.toml"});
    EXPECT_EQ(slide.exit_code, 2) << slide.out;
    EXPECT_THAT(slide.err, HasSubstr("crank-and-slide-study.toml:10: objective[1].type: "));
    EXPECT_THAT(slide.err, HasSubstr("its drives include both lengths and angles; " + kRadius));
    const auto scara = run({command, "double-scara-study.toml"});
    EXPECT_EQ(scara.exit_code, 2) << scara.out;
    EXPECT_THAT(scara.err, HasSubstr("double-scara-study.toml:11: objective[1].type: "));
    EXPECT_THAT(scara.err, HasSubstr("its coordinates and its drives include both lengths and angles; " + kBoth));
  }
}

TEST_F(UndefinedConditioning, IsRefusedInFormulasAndRegions) {
  std::string study = text("crank-and-slide-study");
  study.replace(study.find("type = \"conditioning\""), 21,
                "type = \"expression\"\nexpression = \"volume*conditioning_mean\"");
  folder_.write("crank-and-slide-study.toml", study);
  const auto found = run({"check", "crank-and-slide-study.toml"});
  EXPECT_EQ(found.exit_code, 2) << found.out;
  EXPECT_THAT(found.err, HasSubstr("uses conditioning_mean, but the conditioning of mechanism mix is undefined"));
  EXPECT_THAT(found.err, HasSubstr(kRadius));
}

TEST_F(UndefinedConditioning, IsAbsentFromPosesAndWorkspaces) {
  const auto pose = run({"pose", "crank-and-slide.toml", "--at", "x=0.1,y=0.3"});
  EXPECT_EQ(pose.exit_code, 0) << pose.err;
  EXPECT_THAT(pose.out, ::testing::ContainsRegex("conditioning +none: "));
  EXPECT_THAT(pose.out, HasSubstr(kRadius));
  const auto printed = run({"pose", "crank-and-slide.toml", "--at", "x=0.1,y=0.3", "--json"}).json();
  EXPECT_TRUE(printed["conditioning"].is_null());
  EXPECT_THAT(printed["why_no_conditioning"], HasSubstr(kRadius));
  EXPECT_FALSE(printed["joints"]["crank"].is_null());

  const auto workspace = run({"workspace", "crank-and-slide.toml", "--cells", "8", "--json"});
  EXPECT_EQ(workspace.exit_code, 0) << workspace.err;
  const auto field = workspace.json()["fields"]["conditioning"];
  EXPECT_TRUE(field["least"].is_null() && field["greatest"].is_null());
  EXPECT_THAT(field["unavailable"], HasSubstr(kRadius));
  const auto box =
      run({"workspace", "crank-and-slide.toml", "--cells", "8", "--largest-box", "--least", "conditioning=0.1"});
  EXPECT_EQ(box.exit_code, 2) << box.out;
  EXPECT_THAT(box.err, HasSubstr("--least: the conditioning of mechanism mix is undefined"));

  const auto check = run({"check", "crank-and-slide.toml"});
  EXPECT_THAT(check.out.substr(check.out.find("not available, and why")), HasSubstr(kRadius));
}

/// The expected values are means over the cells of both studies, computed independently with numpy (closed-form cranks,
/// J from the loop-closure equations, singular values).
TEST_F(UndefinedConditioning, IsDefinedByACharacteristicRadius) {
  const auto mean_of = [&](const std::string& study) {
    const auto found = run({"evaluate", study, "--json"});
    EXPECT_EQ(found.exit_code, 0) << found.err;
    return found.json()["objectives"]["conditioning"].get<double>();
  };
  write_with("crank-and-slide", "coordinates", "characteristic_radius = \"a\"");
  EXPECT_NEAR(mean_of("crank-and-slide-study.toml"), 0.4238662594869749, 1e-12);
  write_with("double-scara", "characteristic_length", "characteristic_radius = \"l_a\"");
  EXPECT_NEAR(mean_of("double-scara-study.toml"), 0.4053991262321131, 1e-12);
}

TEST_F(UndefinedConditioning, ANonPositiveRadiusFailsWithAReason) {
  write_with("crank-and-slide", "coordinates", "characteristic_radius = \"0.25 - a\"");
  const auto study = run({"evaluate", "crank-and-slide-study.toml", "--set", "a=250mm"});
  EXPECT_THAT(study.out + study.err,
              HasSubstr("the conditioning is undefined: characteristic_radius is 0 m; expected a positive length"));
  const auto pose = run({"pose", "crank-and-slide.toml", "--at", "x=0.1,y=0.3", "--set", "a=250mm"});
  EXPECT_EQ(pose.exit_code, 0) << pose.err;
  EXPECT_THAT(pose.out, ::testing::ContainsRegex("conditioning +none: "));
  EXPECT_THAT(run({"pose", "crank-and-slide.toml", "--at", "x=0.1,y=0.3", "--set", "a=220mm"}).out,
              Not(HasSubstr("none: ")));
}

}  // namespace
}  // namespace pkm::testing
