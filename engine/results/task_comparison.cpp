#include "engine/results/task_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "engine/core/catalogue.hpp"
#include "engine/core/display_unit.hpp"
#include "engine/core/error.hpp"
#include "engine/math/rounding.hpp"
#include "engine/results/task_motion.hpp"
#include "engine/results/task_workspace.hpp"
#include "engine/workspace/box_poses.hpp"

namespace pkm {
namespace {

constexpr std::size_t kSamples = 201;  // number of samples of each motion, both ends included

/// Throws ConfigError if a table of the task has a key that is not a coordinate of any robot.
void check_coordinates(const TomlValue& table, const SourceLocation& place,
                       const std::vector<std::string>& coordinates) {
  for (const std::string& coordinate : table.keys)
    if (!contains(coordinates, coordinate))
      throw ConfigError(place, "the coordinate '" + coordinate + "'", "one of " + join(coordinates),
                        nearest_name(coordinate, coordinates));
}

/// Throws ConfigError if [origin] in the task names a robot that is not compared, or if it or the box of a region names
/// a coordinate that no robot has.
void check_names(const Task& task, const std::vector<TaskRobot>& robots, const std::vector<std::string>& coordinates) {
  if (const TomlValue* const origins = task.document.find("origin"))
    for (std::size_t i = 0; i < origins->keys.size(); ++i) {
      const std::string& name = origins->keys[i];
      const SourceLocation place{task.file_name, origins->items[i].line, "origin." + name};
      if (!find_named(robots, name))
        throw ConfigError(place, "the robot '" + name + "'", "one of " + join(names_of(robots)),
                          nearest_name(name, names_of(robots)));
      check_coordinates(origins->items[i], place, coordinates);
    }
  const TomlValue* const regions = task.document.find("region");
  for (std::size_t k = 0; regions && k < regions->items.size(); ++k)
    if (const TomlValue* const box = regions->items[k].find("box"))
      check_coordinates(*box, {task.file_name, box->line, "region[" + std::to_string(k + 1) + "].box"}, coordinates);
}

/// Order in which axes are drawn: x, y, other lengths, angles, z, so that z points up.
int rank_of(const AxisInfo& axis) {
  if (axis.name == "x") return 0;
  if (axis.name == "y") return 1;
  if (axis.name == "z") return 4;
  return axis.turns() ? 3 : 2;
}

/// The axes of the comparison: those of the regions' boxes or, without regions, x, y and z of the robots; if a robot
/// has none of them, its first coordinates.
std::vector<AxisInfo> axes_of(const std::vector<TaskEvaluation>& evaluations, const std::vector<TaskRobot>& robots) {
  std::vector<AxisInfo> axes;
  const auto add = [&axes](const AxisInfo& axis) {
    if (axes.size() < 3 && !find_named(axes, axis.name)) axes.push_back(axis);
  };
  for (const TaskEvaluation& evaluation : evaluations) {
    const ProblemParts& parts = evaluation.study.problem->parts();
    for (const Region& region : parts.regions)
      for (const int swept : sweep_of(parts.mechanism->info(), region.plan).swept)
        add(parts.mechanism->info().coordinates[static_cast<std::size_t>(swept)]);
  }
  const bool has_regions = !axes.empty();
  for (const char* const name : {"x", "y", "z"})
    for (const TaskRobot& robot : robots)
      if (const AxisInfo* const axis = find_named(robot.mechanism->info().coordinates, name); axis && !has_regions)
        add(*axis);
  if (axes.empty())
    for (const AxisInfo& axis : robots.front().mechanism->info().coordinates) add(axis);
  std::ranges::stable_sort(axes, {}, rank_of);
  return axes;
}

/// The regions in the frame of the task; the range along each axis is that of the first robot that has this axis.
std::vector<TaskBox> boxes_of(const Task& task, const std::vector<TaskEvaluation>& evaluations,
                              const std::vector<AxisInfo>& axes) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<TaskBox> boxes;
  for (const std::string& name : task.names("region")) {
    TaskBox& box = boxes.emplace_back(TaskBox{name, {}});
    box.ranges.fill({-kInfinity, kInfinity});
    for (const TaskEvaluation& evaluation : evaluations) {
      const ProblemParts& parts = evaluation.study.problem->parts();
      const MechanismInfo& info = parts.mechanism->info();
      const Region* const region = find_named(parts.regions, name);
      if (!region || !region->plan.box()) continue;
      const std::vector<int>& swept = sweep_of(info, region->plan).swept;
      for (std::size_t i = 0; i < swept.size(); ++i) {
        const auto coordinate = static_cast<std::size_t>(swept[i]);
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
          auto& range = box.ranges[axis];
          if (axes[axis].name != info.coordinates[coordinate].name || std::isfinite(range[0])) continue;
          range = (*region->plan.box())[i];
          for (double& end : range) end += evaluation.origin[coordinate];
        }
      }
    }
  }
  return boxes;
}

/// For each axis, the middle of the box of the first region or, if the region does not name the axis, of the range over
/// which the motions extend.
std::array<double, 3> middle_of(const TaskComparison& comparison) {
  std::array<double, 3> middle{};
  for (std::size_t axis = 0; axis < comparison.axes.size(); ++axis) {
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    if (!comparison.boxes.empty() && std::isfinite(comparison.boxes.front().ranges[axis][0])) {
      lower = comparison.boxes.front().ranges[axis][0];
      upper = comparison.boxes.front().ranges[axis][1];
    } else {
      for (const ComparedRobot& robot : comparison.robots)
        for (const TaskMotion& motion : robot.motions)
          for (const auto& at : motion.path) {
            lower = std::fmin(lower, at[axis]);
            upper = std::fmax(upper, at[axis]);
          }
    }
    if (lower <= upper) middle[axis] = (lower + upper) / 2;
  }
  return middle;
}

/// Computes the values of a robot along a motion, and appends the lines of the comparison for this motion.
/// @param named        null if the robot does not support the motion, for example because it lacks a coordinate
/// @param why_refused  the reason why the robot does not support the motion
TaskMotion compute_motion(const TaskComparison& comparison, const Task& task, const TaskEvaluation& evaluation,
                          const std::string& name, const DesignMotion* named, const std::string& why_refused,
                          ComparedRobot& robot) {
  const MechanismInfo& info = robot.mechanism->info();
  Trajectory found;
  if (named)
    found = compute_trajectory(*robot.mechanism, robot.parameters, info.modes.front(), robot.limits,
                               *named->at(robot.parameters), kSamples);
  const bool needs_drives = task.document.find("drive_train") != nullptr;
  for (TaskValue& line : values_along(name, *robot.mechanism, found, needs_drives, evaluation.why_no_drives)) {
    if (!named) line.reason = why_refused;
    robot.values.push_back(std::move(line));
  }
  TaskMotion result{name, found.duration, curves_along(*robot.mechanism, found), {}};
  std::vector<Pose<double>> poses;
  for (const TrajectoryPoint& point : found.points) {
    std::array<double, 3> at;
    at.fill(std::nan(""));
    for (std::size_t axis = 0; axis < comparison.axes.size(); ++axis)
      if (const int i = coordinate_index(info, comparison.axes[axis].name); i >= 0)
        at[axis] = point.motion.pose[static_cast<std::size_t>(i)] + evaluation.origin[static_cast<std::size_t>(i)];
    result.path.push_back(at);
    poses.push_back(point.motion.pose);
  }
  const auto line_of = [&](const std::string& line) -> TaskValue& {
    return *std::ranges::find(robot.values, name + ": " + line, &TaskValue::name);
  };
  line_of("margin").limited_by = limiting_margin(robot, poses);
  TaskValue &drawn = line_of("energy"), &recovered = line_of("energy with recovery of braking energy");
  recovered.value = zero_if_rounding_error(recovered.value, drawn.value);
  if (const std::string impossible = named ? why_impossible(found) : ""; !impossible.empty())
    for (TaskValue* const line : {&drawn, &recovered, &line_of("shortest time")})
      if (std::isnan(line->value) && !why_no_joint_forces(*robot.mechanism)) line->reason = impossible;
  return result;
}

/// Appends the lines of the comparison for a region to the values of a robot: those in `evaluation` and, computed here,
/// the largest factor by which the region can be scaled.
/// @param region  null if the robot does not support the region, for example because it lacks a coordinate
void append_region(const TaskEvaluation& evaluation, const std::string& name, const Region* region,
                   ComparedRobot& robot) {
  for (TaskValue line : evaluation.values) {
    if (line.group != name || line.is_users) continue;
    TaskValue scale{.group = name, .name = name + ": scale", .unit = "1", .reason = line.reason};
    if (line.required && region && line.reason.empty()) {
      const auto poses = poses_of_box(region->plan, robot.mechanism->info(), kBoxPoints, name);
      line.limited_by = limiting_margin(robot, poses);
      scale = largest_scale(*region, robot, poses);
    }
    const bool is_margin = line.required.has_value();
    robot.values.push_back(std::move(line));
    if (is_margin) robot.values.push_back(std::move(scale));
  }
}

ComparedRobot compare_robot(const TaskComparison& comparison, const Task& task, const TaskRobot& given,
                            const TaskEvaluation& evaluation, std::int64_t cells) {
  const ProblemParts& parts = evaluation.study.problem->of(given.parameters).parts();
  ComparedRobot robot{.name = given.name,
                      .values = {},
                      .motions = {},
                      .mechanism = parts.mechanism,
                      .parameters = given.parameters,
                      .limits = workspace_limits(parts.mechanism->info(), parts.plan.limits),
                      .origin = Pose<double>(evaluation.origin.size()),
                      .workspace = {}};
  std::ranges::copy(evaluation.origin, robot.origin.begin());
  try {
    robot.workspace = workspace_over(comparison.axes, evaluation, robot, cells);
    if (!robot.workspace) robot.why_no_workspace = "no pose is feasible";
  } catch (const std::invalid_argument& reason) {
    robot.why_no_workspace = message_of(reason);
  }
  const auto append_group = [&](const std::string& group, bool is_users) {
    for (const TaskValue& line : evaluation.values)
      if (line.group == group && line.is_users == is_users) robot.values.push_back(line);
  };
  append_group("", false);
  for (const std::string& name : task.names("region"))
    append_region(evaluation, name, find_named(parts.regions, name), robot);
  for (const std::string& name : task.names("motion")) {
    append_group(name, false);
    const std::string why = std::ranges::find(robot.values, name + ": margin", &TaskValue::name)->reason;
    robot.motions.push_back(
        compute_motion(comparison, task, evaluation, name, find_named(evaluation.study.motions, name), why, robot));
  }
  append_group("", true);
  return robot;
}

}  // namespace

const TaskValue* ComparedRobot::violated() const {
  const TaskValue* unknown = nullptr;
  for (const TaskValue& line : values) {
    if (!line.required || line.value >= *line.required) continue;
    if (!std::isnan(line.value)) return &line;
    if (!unknown) unknown = &line;
  }
  return unknown;
}

bool ComparedRobot::has_requirements() const {
  return std::ranges::any_of(values, [](const TaskValue& line) { return line.required.has_value(); });
}

std::optional<bool> ComparedRobot::performs_task() const {
  const TaskValue* const line = violated();
  if (!has_requirements() || (line && std::isnan(line->value))) return {};
  return line == nullptr;
}

std::string ComparedRobot::verdict() const {
  if (const TaskValue* const line = violated())
    return std::isnan(line->value) ? "unknown: " + line->name : "no: " + line->name;
  return has_requirements() ? "yes" : "the task has no requirements";
}

TaskComparison compare_in_task(const Task& task, const std::vector<TaskRobot>& robots, const Catalogues& catalogues,
                               std::int64_t cells) {
  std::set<std::string> all;
  for (const TaskRobot& robot : robots)
    for (const AxisInfo& axis : robot.mechanism->info().coordinates) all.insert(axis.name);
  const std::vector<std::string> coordinates(all.begin(), all.end());
  check_names(task, robots, coordinates);
  std::vector<TaskEvaluation> evaluations;
  for (const TaskRobot& robot : robots) evaluations.push_back(evaluate_task(task, robot, coordinates, catalogues));
  for (const auto& [group, error] : evaluations.front().refused)
    if (std::ranges::all_of(evaluations, [&name = group](const TaskEvaluation& each) {
          return std::ranges::any_of(each.refused, [&name](const auto& refused) { return refused.first == name; });
        }))
      throw error;
  const std::vector<TaskValue>& first = evaluations.front().values;
  for (std::size_t k = 0; k < first.size(); ++k)
    if (std::ranges::all_of(evaluations, [k](const auto& each) { return each.values[k].is_mistake; }))
      throw ConfigError({task.file_name, 0, "output " + first[k].name}, first[k].reason);

  TaskComparison comparison{.task = task.name, .axes = axes_of(evaluations, robots), .boxes = {}, .robots = {}};
  comparison.boxes = boxes_of(task, evaluations, comparison.axes);
  for (std::size_t r = 0; r < robots.size(); ++r)
    comparison.robots.push_back(compare_robot(comparison, task, robots[r], evaluations[r], cells));
  comparison.middle = middle_of(comparison);
  std::set<std::size_t, std::greater<>> counts;
  for (const ComparedRobot& robot : comparison.robots)
    counts.insert(robot.workspace ? robot.workspace->axes.size() : comparison.axes.size());
  for (ComparedRobot& robot : comparison.robots) {
    const std::vector<TaskValue> lines = workspace_values(comparison.axes, counts, robot);
    robot.values.insert(robot.values.begin(), lines.begin(), lines.end());
  }
  return comparison;
}

std::pair<double, std::string> in_display_unit(double value, const std::string& unit) {
  const DisplayUnit shown = display_unit(unit);
  return {value / shown.size, shown.name};
}

}  // namespace pkm
