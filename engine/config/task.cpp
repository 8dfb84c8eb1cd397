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

constexpr std::int64_t kCells = 16;  // cells of a region along each axis, if the task does not set them

/// A copy of a table with only the entries for which keep(key) is true.
template <class Keep>
TomlValue filtered(const TomlValue& table, const Keep& keep) {
  TomlValue result = table;
  result.keys.clear();
  result.items.clear();
  result.order.clear();
  for (std::size_t i = 0; i < table.keys.size(); ++i)
    if (keep(table.keys[i])) set_key(result, table.keys[i], table.items[i]);
  return result;
}

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
    if (const TomlValue* const own = origins ? origins->find(robot.name) : nullptr)
      for (const AxisInfo& axis : robot.mechanism->info().coordinates)
        if (own->find(axis.name))
          origin_.emplace_back(
              axis.name, ConfigValue(*own->find(axis.name), task.file_name, "origin." + axis.name).number(axis.unit));
  }

  /// The document of a study of the robot with the regions, motions and limits of the task.
  TomlValue document() const {
    static const Names kept = {"mechanism", "parameters", "motor",    "drive_train",
                               "obstacle",  "quantity",   "accuracy", "override"};
    TomlValue study = filtered(robot_.study, [](const std::string& key) { return contains(kept, key); });
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
    return study;
  }

 private:
  const MechanismInfo& info() const { return robot_.mechanism->info(); }
  bool has(const std::string& coordinate) const { return find_named(info().coordinates, coordinate) != nullptr; }
  bool is_other_robots(const std::string& key) const { return contains(coordinates_, key) && !has(key); }

  /// Converts a value of a coordinate from the frame of the task to that of the robot. A formula remains a formula.
  TomlValue moved(const std::string& coordinate, const TomlValue& value) const {
    const auto origin = std::ranges::find(origin_, coordinate, &std::pair<std::string, double>::first);
    if (origin == origin_.end()) return value;
    TomlValue result = value;
    const std::string& unit = find_named(info().coordinates, coordinate)->unit;
    switch (value.kind) {
      case Kind::array:
        for (TomlValue& element : result.items) element = moved(coordinate, element);
        return result;
      case Kind::integer:
        return number_value(static_cast<double>(value.integer) - origin->second);
      case Kind::number:
        return number_value(value.number - origin->second);
      case Kind::text: {
        if (value.text == "middle" || value.text == "integrated") return value;
        if (const auto number = parse_quantity(value.text, unit)) return number_value(*number - origin->second);
        return text_value("(" + value.text + ") - (" + shortest(origin->second) + ")");
      }
      default:
        return value;
    }
  }

  /// A list of the task's tables under `key`, each written for the robot.
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

  /// The constraints of the robot's study that limit poses.
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
  std::vector<std::pair<std::string, double>> origin_;
};

/// A line of the comparison before it is evaluated: an entry of [[output]] or [[constraint]].
struct Line {
  std::string name;
  bool is_margin = false;
  TomlValue entry;
  bool is_users = false;  ///< true for an [[output]] of the task
};

Names names_of_tables(const TomlValue& document, const std::string& key) {
  Names names;
  if (const TomlValue* const tables = document.find(key))
    for (const TomlValue& table : tables->items) names.push_back(value_or(table, "name", {}).text);
  return names;
}

std::vector<Line> lines_of(const Task& task) {
  std::vector<Line> lines;
  const auto add = [&lines](const std::string& name, bool is_margin,
                            const std::vector<std::array<const char*, 2>>& keys, const char* where = "",
                            const std::string& what = "") {
    Line line{name, is_margin, {}};
    for (const auto& [key, value] : keys) set_key(line.entry, key, text_value(value));
    if (*where) set_key(line.entry, where, text_value(what));
    lines.push_back(line);
  };
  for (const std::string& region : names_of_tables(task.document, "region")) {
    add(region + ": margin", true, {{"type", "task-workspace"}}, "region", region);
    add(region + ": conditioning, min", false, {{"type", "conditioning"}, {"statistic", "min"}}, "region", region);
    add(region + ": conditioning, mean", false, {{"type", "conditioning"}}, "region", region);
    add(region + ": lti, min", false, {{"type", "quantity"}, {"quantity", "lti"}, {"statistic", "min"}}, "region",
        region);
    add(region + ": installation space", false, {{"type", "installation-space"}}, "region", region);
    add(region + ": footprint", false, {{"type", "footprint"}}, "region", region);
    add(region + ": height", false, {{"type", "height"}}, "region", region);
  }
  for (const std::string& motion : names_of_tables(task.document, "motion")) {
    add(motion + ": margin", true, {{"type", "motion"}}, "motion", motion);
    add(motion + ": peak power", false, {{"type", "peak-power"}}, "motion", motion);
  }
  add("moving mass", false, {{"type", "mass"}});
  if (const TomlValue* const outputs = task.document.find("output"))
    for (const TomlValue& each : outputs->items) {
      const TomlValue* const name = each.find("name");
      lines.push_back({name ? name->text : value_or(each, "type", {}).text, false, each, true});
    }
  return lines;
}

/// The message of an error without its location.
std::string sentence_of(const ConfigError& error) {
  const std::string all = error.what(), place = error.place().key + ": ";
  const std::size_t at = error.place().key.empty() ? std::string::npos : all.find(place);
  return at == std::string::npos ? all : all.substr(at + place.size());
}

/// Evaluates the lines that the robot supports, all in one evaluation of its design.
void evaluate(const TaskRobot& robot, const Study& study, const Names& names, std::vector<TaskValue>& values) {
  const DesignProblem& problem = *study.problem;
  const DesignReport report = problem.report(robot.parameters);
  const auto store = [&](const auto& infos, const std::vector<double>& found) {
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const auto at = std::ranges::find(names, infos[i].name);
      if (at == names.end()) continue;
      TaskValue& value = values[static_cast<std::size_t>(at - names.begin())];
      value.unit = infos[i].unit;
      value.value = found[i];
      if (std::isnan(found[i])) value.reason = report.reason.empty() ? "it is not defined there" : report.reason;
    }
  };
  store(problem.margins(), report.margins);
  store(problem.reports(), report.reports);
}

}  // namespace

Task load_task_toml(const std::string& path) {
  Task task{"", path, parse_toml(read_text_file(path, "a task in TOML"), path, "a task in TOML")};
  const ConfigValue root = ConfigValue(task.document, path, "").described_by(task_keys());
  const auto table = root.find_table("task");
  task.name =
      table && table->has("name") ? table->find("name")->text("text") : std::filesystem::path(path).stem().string();
  bool is_empty = true;
  for (const char* const key : {"region", "motion", "output"})
    if (const auto list = root.find(key))
      for (const ConfigValue& each : list->elements(std::string("a list of tables, each written [[") + key + "]]")) {
        is_empty = false;
        if (key != std::string("output")) each.expect_table().at("name", "a name");
      }
  if (is_empty) throw ConfigError({path, 0, ""}, "no [[region]], [[motion]] or [[output]]", "at least one of them");
  return task;
}

std::vector<TaskValue> evaluate_task(const Task& task, const TaskRobot& robot, const Names& coordinates,
                                     const Catalogues& catalogues) {
  TomlValue document = TaskOfRobot(task, robot, coordinates, catalogues).document();
  StudyChanges changes;
  for (std::size_t i = 0; i < robot.parameters.size(); ++i) {
    const std::string& name = robot.mechanism->info().parameters[i].name;
    changes.recorded_parameters.emplace_back(name, robot.parameters[i]);
    if (name.find('.') != std::string::npos) changes.limb_parameters.push_back(name);
  }
  const auto read = [&](const TomlValue& study) {
    return read_study_document(study, task.file_name, catalogues, robot.description, changes);
  };
  Study study = read(document);  // throws for a mistake in the task

  std::vector<TaskValue> values;
  Names names;
  for (const Line& line : lines_of(task)) {
    names.push_back("line-" + std::to_string(names.size() + 1));
    TaskValue& value = values.emplace_back();
    value.name = line.name;
    value.is_margin = line.is_margin;
    value.value = std::numeric_limits<double>::quiet_NaN();
    TomlValue entry = line.entry, longer = document;
    set_key(entry, "name", text_value(names.back()));
    const char* const key = line.is_margin ? "constraint" : "output";
    TomlValue entries = *document.find(key);
    entries.items.push_back(entry);
    set_key(longer, key, entries);
    try {
      study = read(longer);
      document = std::move(longer);
    } catch (const ConfigError& error) {
      value.reason = sentence_of(error);
      value.is_mistake = line.is_users;
    }
  }
  evaluate(robot, study, names, values);
  return values;
}

}  // namespace pkm
