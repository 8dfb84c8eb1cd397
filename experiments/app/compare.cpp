// `pkmopt compare`: compares several robots in one task.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "engine/config/choices.hpp"
#include "engine/config/study_changes.hpp"
#include "engine/config/task.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/catalogue.hpp"
#include "experiments/app/target.hpp"

namespace pkm {
namespace {

struct CompareArguments {
  std::vector<std::string> robots;
  std::string task;
  bool json = false;
};

/// The document of a study with the rows of the catalogues that its design chooses.
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

std::vector<TaskRobot> find_robots(const Session& session, const std::vector<std::string>& arguments) {
  std::vector<TaskRobot> robots;
  for (const std::string& argument : arguments) {
    TaskRobot robot = find_robot(session, argument);
    const std::string stem = robot.name;
    for (int number = 2; find_named(robots, robot.name); ++number) robot.name = stem + "-" + std::to_string(number);
    robots.push_back(std::move(robot));
  }
  return robots;
}

/// Throws ConfigError if [origin] in the task names a robot that is not compared, or a coordinate that no robot has.
void check_origins(const Task& task, const std::vector<TaskRobot>& robots,
                   const std::vector<std::string>& coordinates) {
  const TomlValue* const origins = task.document.find("origin");
  if (!origins) return;
  for (std::size_t i = 0; i < origins->keys.size(); ++i) {
    const std::string& name = origins->keys[i];
    const SourceLocation place{task.file_name, origins->items[i].line, "origin." + name};
    if (!find_named(robots, name))
      throw ConfigError(place, "the robot '" + name + "'", "one of " + join(names_of(robots)),
                        nearest_name(name, names_of(robots)));
    for (const std::string& coordinate : origins->items[i].keys)
      if (!contains(coordinates, coordinate))
        throw ConfigError(place, "the coordinate '" + coordinate + "'", "one of " + join(coordinates),
                          nearest_name(coordinate, coordinates));
  }
}

/// The lines of the comparison: element [robot][line]. Throws ConfigError if no robot supports an [[output]] of the
/// task.
std::vector<std::vector<TaskValue>> compared(const Task& task, const std::vector<TaskRobot>& robots,
                                             const Catalogues& catalogues) {
  std::set<std::string> all;
  for (const TaskRobot& robot : robots)
    for (const AxisInfo& axis : robot.mechanism->info().coordinates) all.insert(axis.name);
  const std::vector<std::string> coordinates(all.begin(), all.end());
  check_origins(task, robots, coordinates);
  std::vector<std::vector<TaskValue>> lines;
  for (const TaskRobot& robot : robots) lines.push_back(evaluate_task(task, robot, coordinates, catalogues));
  for (std::size_t k = 0; k < lines.front().size(); ++k)
    if (std::ranges::all_of(lines, [k](const auto& robot) { return robot[k].is_mistake; }))
      throw ConfigError({task.file_name, 0, "output " + lines.front()[k].name}, lines.front()[k].reason);
  return lines;
}

/// The first constraint of a robot whose margin is negative or unknown, so that the robot cannot perform the task; null
/// if there is none.
const TaskValue* violated(const std::vector<TaskValue>& lines) {
  for (const TaskValue& line : lines)
    if (line.is_margin && !(line.value >= 0)) return &line;
  return nullptr;
}

std::string verdict(const std::vector<TaskValue>& lines) {
  if (const TaskValue* const line = violated(lines))
    return std::isnan(line->value) ? "unknown: " + line->name : "no: " + line->name;
  return std::ranges::any_of(lines, &TaskValue::is_margin) ? "yes" : "nothing is asked";
}

/// The unit of a line, if it is the same for all robots; otherwise "-".
std::string unit_of_line(const std::vector<std::vector<TaskValue>>& lines, std::size_t k) {
  std::string unit;
  for (const auto& robot : lines) {
    if (robot[k].unit.empty()) continue;
    if (!unit.empty() && unit != robot[k].unit) return "-";
    unit = robot[k].unit;
  }
  return unit;
}

void print_table(const std::vector<TaskRobot>& robots, const std::vector<std::vector<TaskValue>>& lines,
                 Printout& out) {
  std::vector<Row> rows = {{"", "unit"}}, reasons;
  for (const TaskRobot& robot : robots) rows[0].push_back(robot.name);
  rows.push_back({"does the task", ""});
  for (const auto& robot : lines) rows.back().push_back(verdict(robot));
  for (std::size_t k = 0; k < lines.front().size(); ++k) {
    const std::string unit = unit_of_line(lines, k);
    Row row = {lines.front()[k].name, unit};
    bool is_available = false;
    for (std::size_t r = 0; r < lines.size(); ++r) {
      const TaskValue& value = lines[r][k];
      const bool has_value = !std::isnan(value.value);
      is_available = is_available || has_value;
      const std::string own_unit = unit == "-" && value.unit != "1" ? " " + value.unit : "";
      row.push_back(has_value ? formatted("%.4g", value.value) + own_unit : "-");
      if (!value.reason.empty()) reasons.push_back({robots[r].name, value.name, value.reason});
    }
    if (is_available) rows.push_back(row);
  }
  out.add_table("comparison", rows);
  out.add_table("not available", reasons);
}

void compare(const CompareArguments& arguments, const Session& session, Printout& out) {
  const Task task = load_task_toml(arguments.task);
  const std::vector<TaskRobot> robots = find_robots(session, arguments.robots);
  const auto lines = compared(task, robots, session.catalogues);
  out.add("task", task.name);
  out.json["robots"] = Json::array();
  for (std::size_t r = 0; r < robots.size(); ++r) {
    Json values = Json::object();
    for (const TaskValue& line : lines[r])
      values[line.name] = {{"value", line.value}, {"unit", line.unit}, {"reason", text_or_null(line.reason)}};
    const bool is_asked = std::ranges::any_of(lines[r], &TaskValue::is_margin);
    out.json["robots"].push_back(
        {{"name", robots[r].name}, {"does_task", is_asked ? Json(!violated(lines[r])) : Json()}, {"values", values}});
  }
  print_table(robots, lines, out);
}

}  // namespace

void add_compare(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<CompareArguments>(
      app, "compare", "Compare several robots in one task: which does it, with what reserve, at what power.",
      "A robot is the name of a built-in mechanism, a mechanism file, a study (its baseline), or a study file F.h5 "
      "(its\n"
      "best design). The task has regions and motions, written like those of a study.\n"
      "Example: pkmopt compare delta.toml gantry.h5 --task pick.toml",
      [&session](const CompareArguments& given) {
        Printout out{.as_json = given.json};
        const SlowStepNotice slow = announce_slow_step(session, "compare is computing, Ctrl-C ends it");
        compare(given, session, out);
        out.print();
      });
  add_option(command, "robots MECHANISM|FILE", arguments.robots, "The robots")->required();
  add_option(command, "--task TASK.toml", arguments.task, "The task")->required();
  command.add_flag("--json", arguments.json, "Print one JSON object, numbers in full precision");
}

}  // namespace pkm
