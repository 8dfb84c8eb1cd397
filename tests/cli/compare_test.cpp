// `pkmopt compare`: several robots in one task. The values are those of studies of the single robots.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kRobots = PKM_EXPERIMENTS "/mechanisms/";
const std::string kTask = PKM_EXPERIMENTS "/tasks/transfer.toml";

class CompareProgram : public StudyProgram {
 protected:
  json compared(const std::vector<std::string>& robots, const std::string& task) {
    std::vector<std::string> words = {"compare"};
    words.insert(words.end(), robots.begin(), robots.end());
    words.insert(words.end(), {"--task", task, "--json"});
    EXPECT_EQ(run(words), 0) << output_;
    return json::parse(output_.substr(output_.find('{')))["robots"];  // after a notice on a slow machine
  }
  json evaluated(const std::string& study) {
    EXPECT_EQ(run({"evaluate", study, "--json"}), 0) << output_;
    return json::parse(output_);
  }
  /// The error of a task with these lines.
  std::string refusal(const std::string& task) {
    std::ofstream(path("wrong.toml")) << task;
    EXPECT_EQ(run({"compare", kRobots + "rotary-delta.toml", kRobots + "five-bar.toml", "--task", "wrong.toml"}), 2);
    return output_;
  }
};

/// A study of one robot with the region and the motion of the task, in the robot's coordinates.
std::string study_of(const std::string& file, const std::string& least_z, const std::string& greatest_z,
                     const std::string& motion_z) {
  return "[mechanism]\nfile = \"" + kRobots + file + "\"\n" + R"([[region]]
name = "bin"
method = "voxels"
cells = { x = 16, y = 16, z = 16 }
box = { x = [-0.1, 0.1], y = [-0.1, 0.1], z = [)" +
         least_z + ", " + greatest_z + R"(] }
[[motion]]
name = "cycle"
type = "pick-and-place"
x = -0.1
y = 0
z = )" + motion_z +
         R"(
lift = 0.025
reach = 0.2
lift_time = 0.1
reach_time = 0.2
overlap = 0.05
cycle = "whole"
[[constraint]]
type = "task-workspace"
region = "bin"
[[constraint]]
type = "motion"
motion = "cycle"
[[output]]
type = "conditioning"
statistic = "min"
region = "bin"
[[output]]
type = "joint-acceleration"
motion = "cycle"
)";
}

TEST_F(CompareProgram, ValuesAreThoseOfStudiesOfTheSingleRobots) {
  const json robots = compared({kRobots + "rotary-delta.toml", kRobots + "linear-delta.toml"}, kTask);
  std::ofstream(path("rotary.toml")) << study_of("rotary-delta.toml", "-0.5", "-0.4", "-0.48");
  // -0.5 - -0.45 and so on, in the order of the program
  std::ofstream(path("linear.toml")) << study_of("linear-delta.toml", "-0.04999999999999999", "0.04999999999999999",
                                                 "-0.02999999999999997");
  for (const auto& [robot, study] : {std::pair(robots[0], "rotary.toml"), {robots[1], "linear.toml"}}) {
    const json single = evaluated(study);
    const json& values = robot["values"];
    EXPECT_NEAR(values["bin: margin"]["value"], single["constraints"]["task-workspace"], 1e-12) << study;
    EXPECT_NEAR(values["cycle: margin"]["value"], single["constraints"]["motion"], 1e-12) << study;
    EXPECT_NEAR(values["bin: conditioning, min"]["value"], single["outputs"]["conditioning"], 1e-12) << study;
    EXPECT_NEAR(values["joint-acceleration"]["value"], single["outputs"]["joint-acceleration"], 1e-9) << study;
    EXPECT_EQ(robot["does_task"], values["bin: margin"]["value"] >= 0 && values["cycle: margin"]["value"] >= 0);
  }
  EXPECT_EQ(robots[0]["name"], "rotary-delta");
}

TEST_F(CompareProgram, RobotsMayLackCoordinatesAndBeStudies) {
  std::ofstream(path("flat.toml")) << R"([task]
name = "flat"
[[region]]
name = "plate"
box = { x = ["-20 mm", "20 mm"], y = ["380 mm", "420 mm"], z = ["-460 mm", "-440 mm"] }
[[output]]
type = "peak-force"
motion = "move"
[[motion]]
name = "move"
type = "points"
time = 0.2
points = [{ x = 0, y = 0.4, z = -0.45 }, { x = 0.02 }]
)";
  ASSERT_EQ(run({"new", "study", kRobots + "five-bar.toml", "-o", "bar.toml"}), 0) << output_;
  ASSERT_EQ(run({"run", "bar.toml", "-o", "bar.h5", "--cells", "8", "--quiet"}), 0) << output_;
  const json robots =
      compared({kRobots + "five-bar.toml", "bar.toml", "bar.h5", kRobots + "rotary-delta.toml"}, "flat.toml");
  EXPECT_GT(robots[0]["values"]["plate: margin"]["value"], 0);
  EXPECT_EQ(robots[1]["name"], "bar");
  EXPECT_EQ(robots[2]["name"], "bar-2");
  EXPECT_NE(robots[2]["values"]["plate: margin"], robots[0]["values"]["plate: margin"]);  // another design
  EXPECT_EQ(robots[3]["does_task"], false);  // y = 400 mm is out of its reach
  ASSERT_EQ(run({"compare", kRobots + "five-bar.toml", kRobots + "rotary-delta.toml", "--task", "flat.toml"}), 0);
  EXPECT_THAT(output_, HasSubstr("does the task"));
  EXPECT_THAT(output_, HasSubstr("no: plate: margin"));
}

TEST_F(CompareProgram, RefusesMistakes) {
  const std::string region = "[[region]]\nname = \"bin\"\nbox = { x = [0, 0.1], y = [0.3, 0.4] }\n";
  EXPECT_THAT(refusal("[task]\nname = \"empty\"\n"), HasSubstr("expected at least one of them"));
  EXPECT_THAT(refusal("[[region]]\nbox = { x = [0, 1] }\n"), HasSubstr("name"));
  EXPECT_THAT(refusal(region + "cels = 3\n"), HasSubstr("wrong.toml:4: region[1].cels"));
  EXPECT_THAT(refusal(region + "[origin]\nrotari-delta = { z = 1 }\n"), HasSubstr("rotary-delta"));
  EXPECT_THAT(refusal(region + "[[output]]\ntype = \"pek-force\"\n"), HasSubstr("did you mean 'peak-force'?"));
  EXPECT_THAT(refusal("[mechanism]\ntype = \"4ppa-2par\"\n" + region), HasSubstr("mechanism"));
}

}  // namespace
}  // namespace pkm::testing
