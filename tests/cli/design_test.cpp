// `pkmopt evaluate`, `pose`, `forward` and `check`: selection of the design, output, exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kPose = "x=0.25,y=0.85,z=-0.8,theta=30deg";  // from the paper's table 2; satisfies all limits

std::vector<std::string> keys(const json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

TEST(CliEvaluate, UsesTheBaselineElseTheParametersThenAppliesSet) {
  const StudyFolder folder;
  const auto with = folder.write("with.toml", study_with("[baseline]\na = 0.25\nl_d = \"600 mm\""));
  const auto without = folder.write("without.toml", study_with(""));
  const auto parameters = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "evaluate");
    arguments.push_back("--json");
    return pkmopt(arguments).json()["parameters"];
  };
  EXPECT_EQ(parameters({with})["a"], 0.25);
  EXPECT_EQ(parameters({with})["l_d"], 0.6);
  EXPECT_EQ(parameters({with})["b"], 0.8);
  EXPECT_EQ(parameters({without})["a"], 0.2);
  const json changed = parameters({with, "--set", "b=900mm,d=0", "--set", "L0=3"});
  EXPECT_EQ(changed["a"], 0.25);
  EXPECT_EQ(changed["b"], 0.9);
  EXPECT_EQ(changed["d"], 0.0);
  EXPECT_EQ(changed["L0"], 3.0);
  EXPECT_EQ(parameters({"4ppa-2par", "--set", "a=0.3", "b=0.9", "L0=3"})["b"], 0.9);
  EXPECT_EQ(parameters({"--set", "a=0.3", "4ppa-2par"})["a"], 0.3);
}

TEST(CliEvaluate, PrintsTheViolatedConstraint) {
  const StudyFolder folder;
  const auto file =
      folder.write("shape.toml", study_with("[[constraint]]\ntype = \"workspace-shape\"\n[[constraint]]\n"
                                            "type = \"rail-length\"\n[[output]]\ntype = \"conditioning\""));
  const auto good = pkmopt({"evaluate", file, "--json"});
  EXPECT_EQ(good.exit_code, 0);
  EXPECT_EQ(good.json()["feasible"], true);
  EXPECT_EQ(keys(good.json()["outputs"]), std::vector<std::string>{"conditioning"});

  const auto bad = pkmopt({"evaluate", file, "--set", "l_d=0.45", "--json"});
  EXPECT_EQ(bad.exit_code, 0);
  EXPECT_EQ(bad.json()["feasible"], false);
  EXPECT_LT(bad.json()["constraints"]["workspace-shape"], 0);
  EXPECT_GT(bad.json()["constraints"]["rail-length"], 0);
  EXPECT_GT(bad.json()["workspace"]["volume"], 0);  // computed although the design is rejected
  EXPECT_THAT(pkmopt({"evaluate", file, "--set", "l_d=0.45"}).out,
              HasSubstr("feasible   no: workspace-shape violated"));
}

TEST(CliEvaluate, HasTheDocumentedKeysAndUnits) {
  const json found = pkmopt({"evaluate", "4ppa-2par", "--json"}).json();
  EXPECT_EQ(keys(found), (std::vector<std::string>{"constraints", "facts", "feasible", "mechanism", "objectives",
                                                   "outputs", "parameters", "workspace"}));
  EXPECT_EQ(found["mechanism"], "4ppa-2par");
  EXPECT_EQ(found["facts"]["shape_type_at_theta_0"], 4);
  EXPECT_EQ(keys(found["objectives"]),
            (std::vector<std::string>{"conditioning", "dci", "dci-uniformity", "inertia-condition", "workspace-ratio",
                                      "workspace-volume"}));
  const auto text = pkmopt({"evaluate", "4ppa-2par"});
  EXPECT_EQ(text.err, "");
  EXPECT_THAT(text.out, HasSubstr("  volume          0.5502 m^2 rad\n"));
}

TEST(CliEvaluate, WarnsIfTheFeasibleSetTouchesTheGivenBox) {
  const StudyFolder folder;
  const auto file = folder.write("box.toml", study_with("[workspace]\nmethod = \"voxels\"\nbox = { x = [0.3, 0.5], z = "
                                                        "[-1.0, -0.5], theta = [-0.5, 0.5] }"));
  EXPECT_EQ(pkmopt({"evaluate", file, "--json"}).json()["workspace"]["touches_box"], true);
  EXPECT_THAT(pkmopt({"evaluate", file}).out, HasSubstr("warning         the feasible set touches the box"));
  const auto own = folder.write("own.toml", study_with("[workspace]\nmethod = \"voxels\""));
  EXPECT_TRUE(pkmopt({"evaluate", own, "--json"}).json()["workspace"]["touches_box"].is_null());  // no box given
}

TEST(CliPose, UsesTheLimitsOfTheStudy) {
  const StudyFolder folder;
  const auto file = folder.write("limits.toml", study_with("[workspace]\nlimits = { cos_theta_min = 0.9 }"));
  const auto bare = pkmopt({"pose", "4ppa-2par", "--at", kPose, "--json"});
  EXPECT_EQ(bare.exit_code, 0);
  EXPECT_EQ(bare.json()["mode"], "lower,lower");
  EXPECT_EQ(bare.json()["feasible"], true);
  EXPECT_TRUE(bare.json()["reason"].is_null());

  const auto limited = pkmopt({"pose", file, "--at", kPose, "--json"});
  EXPECT_EQ(limited.exit_code, 0);
  EXPECT_EQ(limited.json()["feasible"], false);
  EXPECT_EQ(limited.json()["assembles"], true);
  EXPECT_EQ(limited.json()["reason"], "cos_theta_min is violated");
  EXPECT_LT(limited.json()["margins"]["cos_theta_min"], 0);
  EXPECT_EQ(limited.json()["joints"], bare.json()["joints"]);
}

TEST(CliPose, NamesTheLinksThatAreTooClose) {
  const StudyFolder folder;
  const auto file = folder.write("near.toml", study_with("[[constraint]]\ntype = \"clearance\"\nmin = \"10 mm\""));
  const std::string low = "x=0.4,y=1.25,z=-1.207,theta=0";  // sliders nearly meet
  const auto bare = pkmopt({"pose", "4ppa-2par", "--at", low, "--json"}).json();
  EXPECT_EQ(bare["feasible"], true);
  EXPECT_FALSE(bare["margins"].contains("clearance_min"));
  const auto limited = pkmopt({"pose", file, "--at", low, "--json"}).json();
  EXPECT_EQ(limited["feasible"], false);
  EXPECT_EQ(limited["reason"], "clearance_min is violated: slider 1 and slider 2 overlap");
  const double clearance = limited["angles"]["clearance"];
  EXPECT_LT(clearance, 0);
  EXPECT_EQ(bare["angles"]["clearance"], clearance);
  EXPECT_DOUBLE_EQ(limited["margins"]["clearance_min"], clearance - 0.01);
  EXPECT_EQ(pkmopt({"pose", file, "--at", kPose, "--json"}).json()["feasible"], true);
}

TEST(CliPose, APoseThatDoesNotAssembleGivesNullsAndExitCode1) {
  const auto found = pkmopt({"pose", "4ppa-2par", "--at", "x=0.4,y=1.25,z=-3,theta=0", "--json"});
  EXPECT_EQ(found.exit_code, 1);
  const std::string reason = "h_1 has no real value, so q1 is undefined";
  EXPECT_EQ(found.err, "pkmopt: the pose does not assemble in mode lower,lower: " + reason + "\n");
  const json pose = found.json();
  EXPECT_EQ(pose["assembles"], false);
  EXPECT_EQ(pose["feasible"], false);
  EXPECT_EQ(pose["reason"], reason);
  for (const char* key : {"J", "Jq", "G", "det_Jq", "det_G", "conditioning"}) EXPECT_TRUE(pose[key].is_null()) << key;
  for (const char* joint : {"q1", "q2", "q3", "q4"}) EXPECT_TRUE(pose["joints"][joint].is_null()) << joint;
}

TEST(CliForward, ListsTheUsualModesAndAllOnRequest) {
  const std::string joints = "q1=0.9355,q2=1.5645,q3=0.9355,q4=1.5645";
  const json usual = pkmopt({"forward", "4ppa-2par", "--joints", joints, "--json"}).json();
  for (const auto& pose : usual["poses"]) EXPECT_EQ(pose["mode"], "below,below");
  EXPECT_EQ(usual["joints"]["q2"], 1.5645);
  const json all = pkmopt({"forward", "4ppa-2par", "--joints", joints, "--all", "--json"}).json();
  EXPECT_GT(all["poses"].size(), usual["poses"].size());
  EXPECT_THAT(pkmopt({"forward", "4ppa-2par", "--joints", joints}).out, HasSubstr("  poses      4\n"));
}

TEST(CliForward, NoSolutionGivesExitCode1AndAnEmptyList) {
  const auto none = pkmopt({"forward", "4ppa-2par", "--joints", "q1=0,q2=2.5,q3=0,q4=2.5", "--json"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_EQ(none.err, "pkmopt: no pose assembles with these joint values\n");
  EXPECT_EQ(none.json()["poses"], json::array());
}

TEST(CliCheck, PrintsAllDefaults) {
  const StudyFolder folder;
  const auto file = folder.write("s.toml", study_with("[baseline]\na = 0.9"));
  const auto text = pkmopt({"check", file});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr("adaptive: at most 2 % of the run time"));
  EXPECT_THAT(text.out, HasSubstr("baseline 900 mm (outside the bounds)"));
  const json found = pkmopt({"check", file, "--json"}).json();
  EXPECT_EQ(found["seed"], 1);
  EXPECT_EQ(found["variables"][1], (json{{"name", "b"}, {"unit", "m"}, {"min", 0.7}, {"max", 1.5}, {"step", nullptr}}));
  EXPECT_EQ(found["workspace"]["method"], "columns");
  EXPECT_EQ(found["workspace"]["y"], "middle");
  EXPECT_EQ(found["stages"][0]["optimiser"], "ga");
  EXPECT_EQ(found["stages"][0]["options"]["generations"], 100);
  EXPECT_EQ(found["warnings"].size(), 0U);
}

}  // namespace
}  // namespace pkm::testing
