#include "engine/config/task.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "engine/config/config_value.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

using Kind = TomlValue::Kind;
using Names = std::vector<std::string>;

constexpr std::int64_t kCells = 16;  // number of cells of a region along each axis, if the task does not set it

TomlValue text_value(const std::string& text) { return {.kind = Kind::text, .text = text, .written = text}; }
TomlValue number_value(double number) { return {.kind = Kind::number, .number = number, .written = shortest(number)}; }
TomlValue list_value() { return {.kind = Kind::array}; }

/// The value of a key of a table, or `otherwise` if the table lacks the key.
TomlValue value_or(const TomlValue& table, const std::string& key, TomlValue otherwise) {
  const TomlValue* const found = table.find(key);
  return found ? *found : std::move(otherwise);
}

/// Writes a task as a study of one robot, in the coordinates of this robot.
class TaskOfRobot {
 public:
  TaskOfRobot(const Task& task, const TaskRobot& robot, const Names& coordinates, const Catalogues& catalogues)
      : task_(task), robot_(robot), coordinates_(coordinates), constraints_(catalogues.constraints) {
    const TomlValue* const origins = task.document.find("origin");
    const TomlValue* const own = origins ? origins->find(robot.name) : nullptr;
    for (const AxisInfo& axis : robot.mechanism->info().coordinates) {
      const TomlValue* const given = own ? own->find(axis.name) : nullptr;
      origin_.push_back(
          given ? ConfigValue(*given, task.file_name, "origin." + robot.name + "." + axis.name).number(axis.unit) : 0);
    }
    if (task.document.find("drive_train")) why_no_drives_ = why_no_joint_forces(*robot.mechanism);
  }

  const std::vector<double>& origin() const { return origin_; }
  const Unsupported& why_no_drives() const { return why_no_drives_; }

  /// The document of a study of the robot with the regions, motions and limits of the task.
  TomlValue document() const {
    static const Names kept = {"mechanism", "parameters", "obstacle", "quantity", "accuracy", "override"};
    static const Names drives = {"motor", "drive_train"};
    const bool has_drives = task_.document.find("drive_train");
    TomlValue study = filtered(robot_.study, [has_drives](const std::string& key) {
      return contains(kept, key) || (!has_drives && contains(drives, key));
    });
    if (const TomlValue* const overrides = study.find("override")) {
      TomlValue lists = *overrides;
      for (TomlValue& table : lists.items)
        table = filtered(table, [](const std::string& key) { return key == "set" || key == "limit"; });
      set_key(study, "override", lists);
    }
    set_key(study, "workspace", workspace());
    set_key(study, "constraint", pose_constraints());
    set_key(study, "region", tables_of_robot("region", &TaskOfRobot::region));
    set_key(study, "motion", tables_of_robot("motion", &TaskOfRobot::motion));
    set_key(study, "output", list_value());
    if (has_drives && !why_no_drives_) {
      set_key(study, "motor", value_or(task_.document, "motor", list_value()));
      set_key(study, "drive_train", drive_trains());
    }
    return study;
  }

 private:
  const MechanismInfo& info() const { return robot_.mechanism->info(); }
  bool has(const std::string& coordinate) const { return find_named(info().coordinates, coordinate) != nullptr; }
  bool is_other_robots(const std::string& key) const { return contains(coordinates_, key) && !has(key); }

  /// Converts a value of a coordinate from the frame of the task to that of the robot. A formula remains a formula.
  TomlValue moved(const std::string& coordinate, const TomlValue& value) const {
    const AxisInfo* const axis = find_named(info().coordinates, coordinate);
    const double origin = origin_[static_cast<std::size_t>(axis - info().coordinates.data())];
    if (origin == 0) return value;
    TomlValue result = value;
    switch (value.kind) {
      case Kind::array:
        for (TomlValue& element : result.items) element = moved(coordinate, element);
        return result;
      case Kind::integer:
        return number_value(static_cast<double>(value.integer) - origin);
      case Kind::number:
        return number_value(value.number - origin);
      case Kind::text: {
        if (value.text == "middle" || value.text == "integrated") return value;
        if (const auto number = parse_quantity(value.text, axis->unit)) return number_value(*number - origin);
        return text_value("(" + value.text + ") - (" + shortest(origin) + ")");
      }
      default:
        return value;
    }
  }

  /// A list of the task's tables under `key`, each converted by `written` to the coordinates of the robot.
  TomlValue tables_of_robot(const std::string& key, TomlValue (TaskOfRobot::*written)(const TomlValue&) const) const {
    TomlValue tables = list_value();
    if (const TomlValue* const all = task_.document.find(key))
      for (const TomlValue& table : all->items) tables.items.push_back((this->*written)(table));
    return tables;
  }

  /// A copy of the table without the coordinates that only other robots have.
  TomlValue without_other_coordinates(const TomlValue& table) const {
    return filtered(table, [this](const std::string& key) { return !is_other_robots(key); });
  }

  /// A copy of the table without the coordinates that only other robots have, and with the values of this robot's
  /// coordinates converted to its frame.
  TomlValue in_robot_frame(const TomlValue& table) const {
    TomlValue own = without_other_coordinates(table);
    for (std::size_t i = 0; i < own.keys.size(); ++i)
      if (has(own.keys[i])) own.items[i] = moved(own.keys[i], own.items[i]);
    return own;
  }

  /// Adds the default values of the coordinates that neither `table` nor `given` names.
  void add_default_values(const TomlValue& given, TomlValue& table) const {
    for (std::size_t i = 0; i < info().coordinates.size(); ++i) {
      const std::string& name = info().coordinates[i].name;
      if (given.find(name) || table.find(name)) continue;
      if (const auto value = robot_.mechanism->default_value(robot_.parameters, static_cast<int>(i)))
        set_key(table, name, number_value(*value));
    }
  }

  TomlValue region(const TomlValue& table) const {
    TomlValue own = in_robot_frame(table);
    if (const TomlValue* const cells = own.find("cells")) set_key(own, "cells", without_other_coordinates(*cells));
    const TomlValue box = in_robot_frame(value_or(own, "box", {}));
    if (box.keys.empty()) return own;
    set_key(own, "box", box);
    TomlValue axes = list_value(), cells;
    for (const std::string& name : box.keys) {
      axes.items.push_back(text_value(name));
      set_key(cells, name, {.kind = Kind::integer, .integer = kCells});
    }
    if (!own.find("sweep")) {
      set_key(own, "sweep", axes);
      add_default_values(box, own);
    }
    if (!own.find("method")) {
      set_key(own, "method", text_value("voxels"));
      if (!own.find("cells")) set_key(own, "cells", cells);
    }
    return own;
  }

  TomlValue motion(const TomlValue& table) const {
    TomlValue own = in_robot_frame(table);
    TomlValue* first = &own;
    if (const TomlValue* const points = own.find("points"); points && !points->items.empty()) {
      TomlValue moved_points = *points;
      for (TomlValue& point : moved_points.items) point = in_robot_frame(point);
      set_key(own, "points", moved_points);
      first = &own.items[static_cast<std::size_t>(std::ranges::find(own.keys, "points") - own.keys.begin())].items[0];
    }
    add_default_values(*first, *first);
    return own;
  }

  /// [workspace] with the limits of the robot's study and those of the task; the latter take precedence.
  TomlValue workspace() const {
    TomlValue limits;
    for (const TomlValue* const document : {&robot_.study, &task_.document})
      if (const TomlValue* const table = document->find("workspace"))
        if (const TomlValue* const own = table->find("limits"))
          for (std::size_t i = 0; i < own->keys.size(); ++i) set_key(limits, own->keys[i], own->items[i]);
    TomlValue table;
    if (!robot_.mechanism->columns()) set_key(table, "method", text_value("voxels"));
    if (!limits.keys.empty()) set_key(table, "limits", limits);
    return table;
  }

  /// The drive trains of the task, one table for each joint that they apply to.
  TomlValue drive_trains() const {
    TomlValue tables = list_value();
    for (const TomlValue& table : task_.document.find("drive_train")->items)
      for (const AxisInfo& joint : info().joints) {
        const std::string& kind = value_or(table, "joint", {}).text;
        if (kind != "all" && kind != (joint.turns() ? "revolute" : "prismatic")) continue;
        TomlValue own = filtered(table, [&](const std::string& key) { return key != "lead" || !joint.turns(); });
        set_key(own, "joint", text_value(joint.name));
        tables.items.push_back(own);
      }
    return tables;
  }

  /// The constraints on poses in the robot's study.
  TomlValue pose_constraints() const {
    TomlValue list = list_value();
    if (const TomlValue* const all = robot_.study.find("constraint"))
      for (const TomlValue& each : all->items)
        if (const ConstraintEntry* const entry = find_named(constraints_, value_or(each, "type", {}).text);
            entry && entry->pose_level())
          list.items.push_back(each);
    return list;
  }

  const Task& task_;
  const TaskRobot& robot_;
  const Names& coordinates_;
  const std::vector<ConstraintEntry>& constraints_;
  std::vector<double> origin_;  ///< position of the robot's base in the frame of the task, by coordinate
  Unsupported why_no_drives_;
};

/// A line of the comparison before it is evaluated, with its entry of [[output]] or [[constraint]].
struct Line {
  TaskValue value;
  TomlValue entry;
};

std::vector<Line> lines_of(const Task& task) {
  using Keys = std::vector<std::array<std::string, 2>>;
  std::vector<Line> lines;
  // Adds a line of the comparison for a region or a motion; kind is "region" or "motion".
  const auto add = [&lines](const std::string& kind, const std::string& group, const std::string& name,
                            const Keys& keys) {
    Line line{{.group = group, .name = group + ": " + name}, {}};
    for (const auto& [key, value] : keys) set_key(line.entry, key, text_value(value));
    set_key(line.entry, kind, text_value(group));
    lines.push_back(line);
  };
  for (const std::string& region : task.names("region")) {
    add("region", region, "margin", {{"type", "task-workspace"}});
    lines.back().value.required = 0;
    add("region", region, "conditioning, min", {{"type", "conditioning"}, {"statistic", "min"}});
    add("region", region, "conditioning, mean", {{"type", "conditioning"}});
    const auto add_quantity = [&](const std::string& name, const std::string& quantity, const std::string& statistic) {
      add("region", region, name + ", " + statistic,
          {{"type", "quantity"}, {"quantity", quantity}, {"statistic", statistic}});
    };
    add_quantity("lti", "lti", "min");
    add_quantity("lti", "lti", "mean");
    add_quantity("accuracy", "accuracy", "max");
    add_quantity("stiffness", "stiffness", "min");
    add_quantity("natural frequency", "natural_frequency", "min");
    add("region", region, "installation space", {{"type", "installation-space"}});
    add("region", region, "footprint", {{"type", "footprint"}});
    add("region", region, "height", {{"type", "height"}});
  }
  for (const std::string& motion : task.names("motion")) {
    add("motion", motion, "margin", {{"type", "motion"}});
    lines.back().value.required = 0;
    add("motion", motion, "energy", {{"type", "energy"}});
    add("motion", motion, "energy with recovery of braking energy", {{"type", "energy"}});
    set_key(lines.back().entry, "recuperation", {.kind = Kind::flag, .flag = true, .written = "true"});
    add("motion", motion, "shortest time", {{"type", "cycle-time"}});
  }
  lines.push_back({{.group = "", .name = "moving mass"}, {}});
  set_key(lines.back().entry, "type", text_value("mass"));
  if (const TomlValue* const outputs = task.document.find("output"))
    for (const TomlValue& each : outputs->items) {
      const TomlValue* const name = each.find("name");
      const std::string shown = name ? name->text : value_or(each, "type", {}).text;
      lines.push_back({{.group = "", .name = shown, .is_users = true}, each});
    }
  return lines;
}

/// The message of an error without its location and without "X is undefined for mechanism NAME: ", so that it is the
/// same for all robots.
std::string sentence_of(const ConfigError& error, const std::string& mechanism) {
  std::string sentence = error.what();
  const auto remove_until = [&sentence](const std::string& end) {
    if (const std::size_t at = sentence.find(end); at != std::string::npos) sentence.erase(0, at + end.size());
  };
  if (!error.place().key.empty()) remove_until(error.place().key + ": ");
  remove_until(" is undefined for mechanism " + mechanism + ": ");
  return sentence;
}

/// Evaluates the lines that the robot supports, all in one evaluation of its design.
/// @param names  names of the lines in the study
void evaluate(const TaskRobot& robot, const Names& names, TaskEvaluation& task) {
  const DesignProblem& problem = *task.study.problem;
  const DesignReport report = problem.report(robot.parameters);
  // In a region without feasible poses, a statistic is not available, although the analysis gives it the value that its
  // quantity has where it is undefined.
  Names empty;
  const std::vector<Region>& regions = problem.parts().regions;
  for (std::size_t k = 0; k < regions.size(); ++k)
    if (!(problem.workspace(robot.parameters, k + 1).volume > 0)) empty.push_back(regions[k].name);
  const auto store = [&](const auto& infos, const std::vector<double>& found) {
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const auto at = std::ranges::find(names, infos[i].name);
      if (at == names.end()) continue;
      TaskValue& value = task.values[static_cast<std::size_t>(at - names.begin())];
      value.unit = infos[i].unit;
      if (!value.required && contains(empty, value.group)) {
        value.reason = "no pose of the region is feasible";
        continue;
      }
      value.value = found[i];
      if (std::isnan(found[i])) value.reason = report.reason.empty() ? "the value is undefined" : report.reason;
    }
  };
  store(problem.margins(), report.margins);
  store(problem.reports(), report.reports);
}

}  // namespace

std::vector<std::string> Task::names(const std::string& key) const {
  std::vector<std::string> found;
  if (const TomlValue* const tables = document.find(key))
    for (const TomlValue& table : tables->items) found.push_back(value_or(table, "name", {}).text);
  return found;
}

Task load_task_toml(const std::string& path) {
  Task task{"", path, parse_toml(read_text_file(path, "a task in TOML"), path, "a task in TOML")};
  const ConfigValue root = ConfigValue(task.document, path, "").described_by(task_keys());
  const auto table = root.find_table("task");
  task.name =
      table && table->has("name") ? table->find("name")->text("text") : std::filesystem::path(path).stem().string();
  bool is_empty = true;
  Names names;
  for (const char* const key : {"region", "motion", "output"})
    if (const auto list = root.find(key))
      for (const ConfigValue& each : list->elements(std::string("a list of tables, each written [[") + key + "]]")) {
        is_empty = false;
        if (key == std::string("output")) continue;
        const ConfigValue name = each.expect_table().at("name", "a name");
        if (contains(names, name.text("a name")))
          throw name.refusal("the name '" + name.text("a name") +
                             "' is used twice; regions and motions need different names");
        names.push_back(name.text("a name"));
      }
  for (const ConfigValue& train : root.tables("drive_train"))
    train.at("joint", "a kind of joints").word({"all", "revolute", "prismatic"});
  if (root.has("motor") && !root.has("drive_train"))
    throw root.find("motor")->refusal("no [[drive_train]] of the task uses the motors");
  if (is_empty) throw ConfigError({path, 0, ""}, "no [[region]], [[motion]] or [[output]]", "at least one of them");
  return task;
}

TaskEvaluation evaluate_task(const Task& task, const TaskRobot& robot, const Names& coordinates,
                             const Catalogues& catalogues) {
  const TaskOfRobot of_robot(task, robot, coordinates, catalogues);
  TomlValue document = of_robot.document();
  StudyChanges changes;
  for (std::size_t i = 0; i < robot.parameters.size(); ++i) {
    const std::string& name = robot.mechanism->info().parameters[i].name;
    changes.recorded_parameters.emplace_back(name, robot.parameters[i]);
    if (name.find('.') != std::string::npos) changes.limb_parameters.push_back(name);
  }
  const auto read = [&](const TomlValue& study) {
    return read_study_document(study, task.file_name, catalogues, robot.description, changes);
  };
  const TomlValue all = document;
  for (const char* const kind : {"region", "motion"}) set_key(document, kind, list_value());
  // Throws ConfigError for mistakes in the task.
  TaskEvaluation result{read(document), of_robot.origin(), {}, of_robot.why_no_drives()};
  for (const char* const kind : {"region", "motion"})
    for (const TomlValue& table : all.find(kind)->items) {
      TomlValue longer = document, tables = *document.find(kind);
      tables.items.push_back(table);
      set_key(longer, kind, tables);
      try {
        result.study = read(longer);
        document = std::move(longer);
      } catch (const ConfigError& error) {
        result.refused.emplace_back(value_or(table, "name", {}).text, error);
      }
    }
  Names names;
  for (const Line& line : lines_of(task)) {
    names.push_back("line-" + std::to_string(names.size() + 1));
    TaskValue& value = result.values.emplace_back(line.value);
    if (const auto refused =
            std::ranges::find(result.refused, value.group, [](const auto& each) { return each.first; });
        refused != result.refused.end()) {
      value.reason = sentence_of(refused->second, robot.mechanism->info().name);
      continue;
    }
    TomlValue entry = line.entry, longer = document;
    set_key(entry, "name", text_value(names.back()));
    const char* const key = value.required ? "constraint" : "output";
    TomlValue entries = *document.find(key);
    entries.items.push_back(entry);
    set_key(longer, key, entries);
    try {
      result.study = read(longer);
      document = std::move(longer);
    } catch (const ConfigError& error) {
      value.reason = sentence_of(error, robot.mechanism->info().name);
      value.is_mistake = value.is_users;
    }
  }
  evaluate(robot, names, result);
  return result;
}

}  // namespace pkm
