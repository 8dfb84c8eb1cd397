#include "experiments/app/task_robots.hpp"

#include <filesystem>

#include "engine/config/choices.hpp"
#include "engine/config/study_changes.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/catalogue.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

/// The TOML document of a study, in which the choices from catalogues are replaced by the rows that the design selects.
TomlValue with_rows_of_design(const TomlValue& study, const std::string& file_name, const Target& target) {
  std::vector<std::size_t> rows;
  for (const Choice& choice : target.study->problem->parts().choices)
    rows.push_back(choice.row(target.parameters[choice.parameter]));
  const auto recorded = [&study](const ConfigValue& file) {
    return recorded_catalogue(study, file.text("the name of a catalogue's file")).value();
  };
  return with_rows(study, file_name, read_catalogues(study, file_name, recorded), rows);
}

/// The robot that an argument names: a mechanism, a study, or a study file, whose best design is used.
TaskRobot find_robot(const Session& session, const std::string& argument) {
  const std::filesystem::path path(argument);
  DesignArguments design;
  (path.extension() == ".h5" ? design.from : design.target) = argument;
  const Target target = find_target(session, design);
  TaskRobot robot{
      looks_like_file(argument) ? path.stem().string() : argument, target.mechanism, target.parameters, {}, {}};
  if (target.study) {
    robot.study = with_rows_of_design(parse_toml(target.study->text, argument), argument, target);
    robot.description = target.study->description;
  } else if (looks_like_file(argument)) {
    robot.study = parse_toml("[mechanism]\nfile = \"mechanism.toml\"\n", argument);
    robot.description = SourceText{read_text_file(argument, "a mechanism in TOML"), argument};
  } else {
    robot.study = parse_toml("[mechanism]\ntype = \"" + argument + "\"\n", argument);
  }
  return robot;
}

}  // namespace

std::vector<TaskRobot> find_task_robots(const Session& session, const std::vector<std::string>& arguments) {
  std::vector<TaskRobot> robots;
  for (const std::string& argument : arguments) {
    TaskRobot robot = find_robot(session, argument);
    const std::string stem = robot.name;
    for (int number = 2; find_named(robots, robot.name); ++number) robot.name = stem + "-" + std::to_string(number);
    robots.push_back(std::move(robot));
  }
  return robots;
}

}  // namespace pkm
