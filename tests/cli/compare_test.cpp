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
  std::string slurp(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
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
  ASSERT_EQ(run({"run", "bar.toml", "-o", "bar.h5", "--quiet"}), 0) << output_;
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

/// A task with the region and the motion of kTask for the rotary Delta, and further tables.
std::string task_with(const std::string& tables) {
  return R"([task]
name = "test"
[[region]]
name = "bin"
box = { x = [-0.1, 0.1], y = [-0.1, 0.1], z = [-0.5, -0.4] }
[[motion]]
name = "cycle"
type = "pick-and-place"
x = -0.1
y = 0
z = -0.48
lift = 0.025
reach = 0.2
lift_time = 0.1
reach_time = 0.2
overlap = 0.05
cycle = "whole"
)" + tables;
}

TEST_F(CompareProgram, LoadsAlongMotionsAreThoseOfTrajectories) {
  const json robots = compared({kRobots + "rotary-delta.toml", kRobots + "linear-delta.toml"}, kTask);
  std::ofstream(path("rotary.toml")) << study_of("rotary-delta.toml", "-0.5", "-0.4", "-0.48");
  ASSERT_EQ(run({"trajectory", "rotary.toml", "--motion", "cycle", "--json"}), 0) << output_;
  const json single = json::parse(output_)["summary"];
  const auto largest = [&single](const char* key) {
    double peak = 0;
    for (const json& value : single[key]) peak = std::max(peak, value.get<double>());
    return peak;
  };
  const json& values = robots[0]["values"];
  EXPECT_NEAR(values["cycle: peak angular speed"]["value"], largest("peak_speed"), 1e-12);
  EXPECT_NEAR(values["cycle: peak torque"]["value"], largest("peak_force"), 1e-12);
  EXPECT_NEAR(values["cycle: RMS torque"]["value"], largest("rms_force"), 1e-12);
  EXPECT_NEAR(values["cycle: peak power, one drive"]["value"], largest("peak_power"), 1e-12);
  const double most = single["peak_total_power"], least = single["least_total_power"];
  EXPECT_NEAR(values["cycle: peak power, all drives"]["value"], std::max(most, -least), 1e-12);
  EXPECT_NEAR(values["cycle: energy"]["value"], single["energy_drawn"], 1e-9);
  // Torques and forces are not compared with each other.
  EXPECT_EQ(values["cycle: peak force"]["reason"], "no drive is prismatic");
  EXPECT_EQ(robots[1]["values"]["cycle: peak torque"]["reason"], "no drive is revolute");
  EXPECT_GT(robots[1]["values"]["cycle: peak force"]["value"], 0);
}

TEST_F(CompareProgram, ScaleIsTheLargestBoxAndTheMarginNamesItsLimit) {
  std::ofstream(path("task.toml")) << task_with("");
  const json robots = compared({kRobots + "rotary-delta.toml"}, "task.toml");
  const json& values = robots[0]["values"];
  const double scale = values["bin: scale"]["value"];
  EXPECT_GT(scale, 1);
  EXPECT_THAT(values["bin: margin"]["limited_by"].get<std::string>(), HasSubstr("arm"));
  for (const auto& [factor, is_feasible] : {std::pair(scale * 0.999, true), {scale * 1.001, false}}) {
    std::ofstream(path("scaled.toml")) << "[[region]]\nname = \"bin\"\nbox = { x = [" << -0.1 * factor << ", "
                                       << 0.1 * factor << "], y = [" << -0.1 * factor << ", " << 0.1 * factor
                                       << "], z = [" << -0.45 - 0.05 * factor << ", " << -0.45 + 0.05 * factor
                                       << "] }\n";
    EXPECT_EQ(compared({kRobots + "rotary-delta.toml"}, "scaled.toml")[0]["does_task"], is_feasible) << factor;
  }
}

TEST_F(CompareProgram, DriveTrainsOfTheTaskGiveTheReserveAndTheShortestTime) {
  std::ofstream(path("drives.toml")) << task_with(R"([[drive_train]]
joint = "revolute"
peak_speed = 20
peak_acceleration = 300
[[drive_train]]
joint = "prismatic"
peak_speed = 0.1
peak_acceleration = 30
)");
  const json robots = compared({kRobots + "rotary-delta.toml", kRobots + "orthoglide.toml"}, "drives.toml");
  const json &rotary = robots[0]["values"], &orthoglide = robots[1]["values"];
  const double acceleration = 146.2;  // the output joint-acceleration of kTask, see docs/questions.md
  EXPECT_NEAR(rotary["cycle: reserve of the drives"]["value"], 300 / acceleration, 1e-3);
  EXPECT_THAT(rotary["cycle: reserve of the drives"]["limited_by"].get<std::string>(), HasSubstr("acceleration of "));
  EXPECT_GT(rotary["cycle: shortest time"]["value"], 0.1);
  EXPECT_LT(rotary["cycle: shortest time"]["value"], 0.7);
  EXPECT_EQ(robots[0]["does_task"], true);
  EXPECT_EQ(orthoglide["cycle: reserve of the drives"]["required"], 1);
  EXPECT_EQ(robots[1]["does_task"], false);

  // A robot without masses has no motors: whether it can perform the task is unknown.
  std::ofstream(path("motors.toml")) << R"([[motion]]
name = "along x"
type = "points"
time = 0.5
points = [{ x = -0.02 }, { x = 0.02 }]
[[motor]]
name = "small"
continuous_torque = 1
peak_torque = 3
speed = 300
rotor_inertia = 1e-5
[[drive_train]]
joint = "all"
motor = "small"
lead = "20 mm"
)";
  const json hybrid = compared({"2t1r-p-hybrid", kRobots + "orthoglide.toml"}, "motors.toml");
  EXPECT_EQ(hybrid[0]["does_task"], nullptr);
  EXPECT_THAT(hybrid[0]["values"]["along x: reserve of the drives"]["reason"].get<std::string>(), HasSubstr("masses"));
  EXPECT_THAT(hybrid[1]["values"]["along x: reserve of the drives"]["limited_by"].get<std::string>(),
              HasSubstr("of the motor of "));
}

TEST_F(CompareProgram, RobotsThatCannotMoveAsTheTaskSaysAreReported) {
  std::ofstream(path("lift.toml")) << task_with("");
  const json robots = compared({kRobots + "five-bar.toml", kRobots + "rotary-delta.toml"}, "lift.toml");
  const json& bar = robots[0]["values"];
  EXPECT_THAT(bar["cycle: margin"]["reason"].get<std::string>(), HasSubstr("the mechanism has no such coordinate"));
  EXPECT_EQ(bar["cycle: peak torque"]["reason"], bar["cycle: margin"]["reason"]);
  EXPECT_EQ(robots[0]["does_task"], false);  // its workspace lies at y > 0
  EXPECT_EQ(robots[0]["violated"], "bin: margin");
  EXPECT_EQ(robots[1]["does_task"], true);
  // A planar robot has an area instead of a volume.
  EXPECT_GT(bar["workspace: area"]["value"], 0);
  EXPECT_EQ(bar["workspace: volume"]["value"], nullptr);
  EXPECT_EQ(bar["workspace: size along z"]["reason"], "the robot has no coordinate z");
}

TEST_F(CompareProgram, DrawsWorkspacesAndLoads) {
  std::ofstream(path("lift.toml")) << task_with("");
  const std::vector<std::string> words = {"compare",
                                          kRobots + "five-bar.toml",
                                          kRobots + "rotary-delta.toml",
                                          "--task",
                                          "lift.toml",
                                          "-o",
                                          "both.svg",
                                          "-o",
                                          "both.png"};
  ASSERT_EQ(run(words), 0) << output_;
  const std::string svg = slurp("both.svg");
  for (const char* const text :
       {"five-bar, does the task: no: bin: margin", "rotary-delta, does the task: yes", "workspaces at y = 0 mm",
        "workspaces at z = -450 mm", ">bin<", "cycle: power of all drives", "cycle: largest torque",
        "cycle: largest angular speed", "time [s]"})
    EXPECT_THAT(svg, HasSubstr(text));
  const auto count = [&svg](const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = svg.find(part); at != std::string::npos; at = svg.find(part, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("<rect x="), 5);         // two slices, three loads
  EXPECT_EQ(count("class=\"area\" "), 3);  // the planar robot in the slice z, the other one in both
  EXPECT_THAT(slurp("both.png"), ::testing::StartsWith("\x89PNG"));
  EXPECT_EQ(run(words), 1);  // files exist
  EXPECT_THAT(output_, HasSubstr("both.svg"));
}

TEST_F(CompareProgram, RefusesMistakes) {
  const std::string region = "[[region]]\nname = \"bin\"\nbox = { x = [0, 0.1], y = [0.3, 0.4] }\n";
  EXPECT_THAT(refusal("[task]\nname = \"empty\"\n"), HasSubstr("expected at least one of them"));
  EXPECT_THAT(refusal("[[region]]\nbox = { x = [0, 1] }\n"), HasSubstr("name"));
  EXPECT_THAT(refusal(region + "cels = 3\n"), HasSubstr("wrong.toml:4: region[1].cels"));
  EXPECT_THAT(refusal("[[region]]\nname = \"bin\"\nbox = { zz = [0, 0.1] }\n"),
              HasSubstr("wrong.toml:3: region[1].box: found the coordinate 'zz'; expected one of x, y, z"));
  EXPECT_THAT(refusal(region + region), HasSubstr("the name 'bin' is used twice"));
  EXPECT_THAT(
      refusal("[[motion]]\nname = \"m\"\ntype = \"points\"\ntime = 0\npoints = [{ x = 0, y = 0.4 }, { x = 0.1 }]\n"),
      HasSubstr("time"));  // a motion that all robots refuse
  EXPECT_THAT(refusal(region + "[[motor]]\nname = \"m\"\ncontinuous_torque = 1\npeak_torque = 1\nspeed = 1\n"
                               "rotor_inertia = 0\n"),
              HasSubstr("no [[drive_train]] of the task uses the motors"));
  EXPECT_THAT(refusal(region + "[[drive_train]]\njoint = \"crank\"\npeak_speed = 1\n"),
              HasSubstr("expected one of all, revolute, prismatic"));
  EXPECT_THAT(refusal(region + "[origin]\nrotari-delta = { z = 1 }\n"), HasSubstr("rotary-delta"));
  EXPECT_THAT(refusal(region + "[[output]]\ntype = \"pek-force\"\n"), HasSubstr("did you mean 'peak-force'?"));
  EXPECT_THAT(refusal("[mechanism]\ntype = \"4ppa-2par\"\n" + region), HasSubstr("mechanism"));
}

}  // namespace
}  // namespace pkm::testing
