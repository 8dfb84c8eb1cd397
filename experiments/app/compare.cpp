// `pkmopt compare`: compares several robots in one task.

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/team.hpp"
#include "engine/export/task_picture.hpp"
#include "engine/report/html_page.hpp"
#include "engine/storage/safe_file.hpp"
#include "experiments/app/running.hpp"
#include "experiments/app/task_robots.hpp"
#include "experiments/app/version.hpp"
#include "experiments/app/workspace_outputs.hpp"

namespace pkm {
namespace {

struct CompareArguments {
  std::vector<std::string> robots;
  std::string task, svg, png, html;
  bool force = false, json = false;
  int threads = 0;
};

using Robots = std::vector<ComparedRobot>;

/// The unit in which the table shows line k of the comparison, if it is the same for all robots; otherwise "-".
std::string unit_of_line(const Robots& robots, std::size_t k) {
  std::string unit;
  for (const ComparedRobot& robot : robots) {
    const TaskValue& line = robot.values[k];
    if (line.unit.empty() || std::isnan(line.value)) continue;
    const std::string shown = in_display_unit(0, line.unit).second;
    if (!unit.empty() && unit != shown) return "-";
    unit = shown;
  }
  return unit;
}

/// The table row of line k of the comparison, with the values of all robots; empty if no robot has the value.
Row row_of_line(const Robots& robots, std::size_t k) {
  const std::string unit = unit_of_line(robots, k);
  Row row = {robots.front().values[k].name, unit};
  bool is_available = false;
  for (const ComparedRobot& robot : robots) {
    const TaskValue& line = robot.values[k];
    const auto [value, own_unit] = in_display_unit(line.value, line.unit);
    is_available = is_available || !std::isnan(value);
    row.push_back(std::isnan(value) ? "-" : digits(value) + (unit == "-" && own_unit != "1" ? " " + own_unit : ""));
  }
  return is_available ? row : Row();
}

/// For each reason why some robots lack values: these values, the robots, and the reason. Values of one region or
/// motion share a row if they are missing for the same reason.
std::vector<Row> rows_of_reasons(const Robots& robots) {
  struct Missing {
    std::string group, robots, reason, values;
    std::size_t count;
  };
  std::vector<Missing> missing;
  std::map<std::string, std::size_t> size_of_group;
  for (std::size_t k = 0; k < robots.front().values.size(); ++k) {
    const std::string &name = robots.front().values[k].name, &group = robots.front().values[k].group;
    ++size_of_group[group];
    std::vector<std::pair<std::string, std::vector<std::string>>> found;  // reason, and names of its robots
    for (const ComparedRobot& robot : robots) {
      const std::string& reason = robot.values[k].reason;
      if (reason.empty()) continue;
      auto same = std::ranges::find(found, reason, [](const auto& each) { return each.first; });
      if (same == found.end()) same = found.insert(same, {reason, {}});
      same->second.push_back(robot.name);
    }
    for (const auto& [reason, names] : found) {
      const std::string who = names.size() == robots.size() && names.size() > 1 ? "all robots" : join(names);
      const auto same = std::ranges::find_if(missing, [&group, &who, &why = reason](const Missing& other) {
        return other.group == group && other.robots == who && other.reason == why;
      });
      if (same == missing.end()) {
        missing.push_back({group, who, reason, name, 1});
      } else {
        same->values += "; " + name.substr(group.empty() ? 0 : group.size() + 2);
        ++same->count;
      }
    }
  }
  std::vector<Row> rows;
  for (const Missing& each : missing) {
    constexpr std::size_t kMaxNamed = 5;
    const bool is_all = !each.group.empty() && each.count == size_of_group[each.group];
    rows.push_back({is_all                   ? each.group + ": all values"
                    : each.count > kMaxNamed ? each.group + ": " + std::to_string(each.count) + " values"
                                             : each.values,
                    each.robots, each.reason});
  }
  return rows;
}

void print_table(const Robots& robots, Printout& out) {
  std::vector<Row> rows = {{"", "unit"}, {"does the task", ""}};
  for (const ComparedRobot& robot : robots) {
    rows[0].push_back(robot.name);
    rows[1].push_back(robot.verdict());
  }
  for (std::size_t k = 0; k < robots.front().values.size(); ++k) {
    if (const Row row = row_of_line(robots, k); !row.empty()) rows.push_back(row);
    Row limits = {robots.front().values[k].name + " limited by", ""};
    for (const ComparedRobot& robot : robots) {
      const std::string& limit = robot.values[k].limited_by;
      limits.push_back(limit.empty() ? "-" : limit);
    }
    if (std::ranges::any_of(limits.begin() + 2, limits.end(), [](const auto& limit) { return limit != "-"; }))
      rows.push_back(limits);
  }
  out.add_table("comparison", rows);
  out.add_table("not available", rows_of_reasons(robots));
}

Json robot_json(const ComparedRobot& robot) {
  Json values = Json::object();
  for (const TaskValue& line : robot.values)
    values[line.name] = {{"value", line.value},
                         {"unit", line.unit},
                         {"required", json_or_null(line.required)},
                         {"limited_by", text_or_null(line.limited_by)},
                         {"reason", text_or_null(line.reason)}};
  const TaskValue* const violated = robot.violated();
  const bool is_asked = std::ranges::any_of(robot.values, [](const auto& line) { return line.required.has_value(); });
  const bool is_known = is_asked && !(violated && std::isnan(violated->value));
  return {{"name", robot.name},
          {"does_task", is_known ? Json(!violated) : Json()},
          {"violated", violated ? Json(violated->name) : Json()},
          {"values", values}};
}

void compare(const CompareArguments& arguments, const Session& session, Printout& out) {
  const Task task = load_task_toml(arguments.task);
  const std::vector<TaskRobot> robots = find_task_robots(session, arguments.robots);
  std::vector<std::string> files;
  for (const std::string& file : {arguments.svg, arguments.png, arguments.html})
    if (!file.empty()) files.push_back(file);
  std::vector<std::string> inputs = arguments.robots;
  inputs.push_back(arguments.task);
  const Existing existing = if_forced(arguments.force);
  check_outputs(files, inputs, existing);
  if (!arguments.html.empty())
    page_assets();  // throws std::runtime_error here, before any evaluation, if this build does not contain the page
  with_team(arguments.threads, [&] {
    const TaskComparison comparison = compare_in_task(task, robots, session.catalogues);
    out.add("task", task.name);
    out.json["robots"] = list_json(comparison.robots, robot_json);
    print_table(comparison.robots, out);
    if (!arguments.html.empty())
      write_file(arguments.html, html_page(page_data({}, program_words(), &comparison)), existing);
    if (arguments.svg.empty() && arguments.png.empty()) return;
    const Picture picture = draw_comparison(comparison);
    if (!arguments.svg.empty()) write_file(arguments.svg, svg_file(picture), existing);
    if (!arguments.png.empty()) write_file(arguments.png, png_file(picture), existing);
  });
  out.json["files"] = files;
  for (const std::string& file : files) out.text += "wrote " + file + '\n';
}

}  // namespace

void add_compare(CLI::App& app, Session& session) {
  const auto [command, arguments] = add_command<CompareArguments>(
      app, "compare", "Compare several robots in one task: which does it, with what reserve, at what power.",
      "A robot is the name of a built-in mechanism, a mechanism file, a study (its baseline), or a study file F.h5 "
      "(its\n"
      "best design). The task has regions and motions, written like those of a study.\n"
      "Example: pkmopt compare delta.toml gantry.h5 --task pick.toml -o comparison.html",
      [&session](const CompareArguments& given) {
        Printout out{.as_json = given.json};
        const SlowStepNotice slow = announce_slow_step(session, "compare is computing, Ctrl-C ends it");
        compare(given, session, out);
        out.print();
      });
  add_option(command, "robots MECHANISM|FILE", arguments.robots, "The robots")->required();
  add_option(command, "--task TASK.toml", arguments.task, "The task")->required();
  add_option(command, "--svg FILE", arguments.svg,
             "Draw the workspaces with the regions, and the loads along the motions, to this file");
  add_option(command, "--png FILE", arguments.png, "Draw the same picture to a PNG file");
  add_option(command, "--html FILE", arguments.html, "Write a page with the comparison to this file");
  add_output_by_extension(command, {{".html", &arguments.html}, {".png", &arguments.png}, {".svg", &arguments.svg}});
  command.add_flag("--force", arguments.force, "Overwrite files that exist");
  command.add_flag("--json", arguments.json, "Print one JSON object, numbers in full precision");
  add_threads(command, arguments.threads);
}

}  // namespace pkm
