// `pkmopt tolerances`: certified tolerances of a box of poses and of a motion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

const std::string kToleranceFolder = PKM_EXPERIMENTS "/mechanisms/";
const std::string kToleranceFiveBar = kToleranceFolder + "five-bar.toml",
                  kToleranceDelta = kToleranceFolder + "rotary-delta.toml";
const std::string kToleranceBox = "x=-50mm:50mm,y=300mm:400mm";

class Tolerances : public ::testing::Test {
 protected:
  ProgramResult run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "tolerances");
    return pkmopt(arguments, folder_.path());
  }
  /// The joints of the Delta at the pose of a violation are beyond their limits, or the pose is not reached.
  static void expect_infeasible(const nlohmann::json& found) {
    std::string set, at;
    for (const auto& [name, value] : found["violation"]["parameters"].items())
      set += (set.empty() ? "" : ",") + name + "=" + value.dump();
    for (const auto& [name, value] : found["violation"]["pose"].items())
      at += (at.empty() ? "" : ",") + name + "=" + value.dump();
    EXPECT_EQ(pkmopt({"pose", kToleranceDelta, "--at=" + at, "--set=" + set, "--json"}).json()["feasible"], false);
  }

  StudyFolder folder_;
};

TEST_F(Tolerances, OfABoxOfPoses) {
  const std::vector<std::string> command = {kToleranceDelta, "--box", "x=-150mm:150mm,y=-150mm:150mm,z=-550mm:-400mm"};
  const auto text = run(command);
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("  certified      +-3.15"));
  EXPECT_THAT(text.out, HasSubstr("  singularities  none within the certified tolerances"));
  std::vector<std::string> more = command;
  more.insert(more.end(), {"--json", "-o", "t.csv", "--gap", "0.01", "--yield", "1"});
  const auto found = run(more).json();
  const double certified = found["certified"]["l_a"], violation = found["violation"]["tolerance"]["l_a"];
  EXPECT_GE(certified, 0.99 * violation * (1 - 1e-12));
  EXPECT_LT(certified, violation);
  EXPECT_EQ(found["certified"].size(), 4u) << "all lengths";
  expect_infeasible(found);
  std::ifstream table(folder_.path() + "/t.csv");
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "parameter,unit,design,certified,violation");
  std::getline(table, line);
  EXPECT_THAT(line, HasSubstr("R,m,0.2,0.00319"));
}

TEST_F(Tolerances, OfTheSixLegsOfAGoughPlatform) {
  // 24 independent deviations: the determinant alone certifies only 30 mm of 48 mm in 20000 boxes
  const auto text = run(
      {kToleranceFolder + "gough.toml", "--box", "x=-200mm:200mm,y=-200mm:200mm,z=1.2m:1.4m", "--copies", "--json"});
  EXPECT_EQ(text.exit_code, 0) << text.err;
  const auto found = text.json();
  EXPECT_EQ(found["certified"].size(), 24u);
  EXPECT_GE(found["certified"]["left1.R"],
            0.98 * found["violation"]["tolerance"]["left1.R"].get<double>() * (1 - 1e-12));
  EXPECT_LT(found["boxes"], 20000);
}

TEST_F(Tolerances, OfTheLimbsOneByOne) {
  const auto found = run({kToleranceFiveBar, "--box", kToleranceBox, "--copies", "--of", "l_a=2mm", "--json"}).json();
  EXPECT_EQ(found["certified"].size(), 2u);
  EXPECT_EQ(found["certified"]["left.l_a"], found["certified"]["right.l_a"]);
  const auto named = run({kToleranceFiveBar, "--box", kToleranceBox, "--of", "left.l_a=1mm,right.l_a=2mm", "--set",
                          "l_a=260mm", "--json"})
                         .json();
  EXPECT_EQ(named["parameters"]["left.l_a"], 0.26);
  EXPECT_EQ(named["certified"]["right.l_a"], 2 * named["certified"]["left.l_a"].get<double>());
}

TEST_F(Tolerances, OfFreeProportionsCostLess) {
  const auto cost = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = {kToleranceFolder + "par4.toml", "--box", "x=-0.1:0.1,y=-0.1:0.1,z=-0.55:-0.45",
                                        "--json"};
    command.insert(command.end(), more.begin(), more.end());
    double sum = 0;
    const auto found = run(command).json();
    for (const auto& [name, tolerance] : found["certified"].items()) sum += 1e-3 / tolerance.get<double>();
    return sum;
  };
  EXPECT_LT(cost({"--free"}), 0.95 * cost({}));
}

TEST_F(Tolerances, OfAMotion) {
  const auto found = run({kToleranceFolder + "motors/rotary-delta.toml", "--motion", "cycle", "--json"}).json();
  EXPECT_GT(found["certified"]["R"], 0.02);
  EXPECT_FALSE(found["violation"]["time"].is_null());
  expect_infeasible(found);
}

TEST_F(Tolerances, OfADesignThatFails) {
  const auto found = run({kToleranceDelta, "--box", "x=-0.3:0.3,y=-0.3:0.3,z=-0.6:-0.5"});
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_THAT(found.out, HasSubstr("  violation  of the design itself: "));
  EXPECT_THAT(found.err, HasSubstr("the design itself does not do the task"));
}

TEST_F(Tolerances, OfFewBoxesAreCertifiedButSmaller) {
  const auto few = run({kToleranceFiveBar, "--box", kToleranceBox, "--boxes", "200", "--json"});
  EXPECT_EQ(few.exit_code, 1);
  EXPECT_THAT(few.err, HasSubstr("the requested gap needs more than 200 boxes (--boxes)"));
  const auto all = run({kToleranceFiveBar, "--box", kToleranceBox, "--json", "--threads", "2"});
  EXPECT_LT(few.json()["certified"]["d"], all.json()["certified"]["d"]);
}

TEST_F(Tolerances, RejectsInvalidArguments) {
  const auto error = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = {kToleranceFiveBar};
    command.insert(command.end(), more.begin(), more.end());
    const auto result = run(command);
    EXPECT_EQ(result.exit_code, 2);
    return result.err;
  };
  EXPECT_THAT(error({}), HasSubstr("found no task; expected the poses of the task: --box NAME=FROM:TO or --motion"));
  EXPECT_THAT(error({"--box", kToleranceBox, "--motion", "m.toml"}), HasSubstr("both --box and --motion"));
  EXPECT_THAT(error({"--box", "x=0:1"}), HasSubstr("--box"));
  EXPECT_THAT(error({"--box", kToleranceBox, "--yield", "0.9"}),
              HasSubstr("is sampled by the objective 'yield' of a study"));
  EXPECT_THAT(error({"--box", kToleranceBox, "--gap", "1"}), HasSubstr("between 0 and 1"));
  EXPECT_THAT(error({"--box", kToleranceBox, "--of", "l_c"}), HasSubstr("did you mean 'l_a'?"));
  EXPECT_THAT(error({"--box", kToleranceBox, "--of", "l_a,l_a"}), HasSubstr("'l_a' twice"));
  EXPECT_THAT(error({"--box", kToleranceBox, "--of", "l_a=-1mm"}), HasSubstr("a size > 0 in m"));
  EXPECT_THAT(run({kToleranceDelta, "--box", "x=0:0.1,y=0:0.1,z=-0.5:-0.4", "--of", "q_max"}).err,
              HasSubstr("q_max=0.1deg"));
  EXPECT_THAT(run({kToleranceDelta, "--box", "x=0:0.1,y=0:0.1,z=-0.5:-0.4", "--limit", "clearance_min=5mm"}).err,
              HasSubstr("has no certified bounds with a clearance limit"));
}

}  // namespace
}  // namespace pkm::testing
