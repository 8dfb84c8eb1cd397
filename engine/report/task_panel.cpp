// Computes the data of the panel "Task": the comparison of several robots in one task.
#include <algorithm>
#include <cmath>

#include "engine/report/packed_array.hpp"
#include "engine/report/panels.hpp"

namespace pkm {
namespace {

Json value_json(const TaskValue& line) {
  return {{"value", line.value},
          {"unit", line.unit},
          {"required", line.required ? Json(*line.required) : Json()},
          {"limited_by", line.limited_by},
          {"reason", line.reason}};
}

Json task_motion_json(const TaskMotion& motion, std::size_t axes) {
  Json json = {{"name", motion.name},
               {"duration", motion.duration},
               {"samples", motion.path.size()},
               {"curves", Json::array()},
               {"path", Json::array()}};
  for (const TaskCurve& curve : motion.curves)
    json["curves"].push_back({{"name", curve.name}, {"unit", curve.unit}, {"values", packed_floats(curve.values)}});
  for (std::size_t axis = 0; axis < axes; ++axis) {
    std::vector<double> values;
    for (const auto& at : motion.path) values.push_back(at[axis]);
    json["path"].push_back(packed_floats(values));
  }
  return json;
}

Json compared_robot_json(const ComparedRobot& robot, std::size_t axes) {
  const std::optional<bool> performs = robot.performs_task();
  Json json = {{"name", robot.name},
               {"performs", performs ? Json(*performs) : Json()},
               {"verdict", robot.verdict()},
               {"values", Json::array()}};
  for (const TaskValue& line : robot.values) json["values"].push_back(value_json(line));
  json["motions"] = Json::array();
  for (const TaskMotion& motion : robot.motions) json["motions"].push_back(task_motion_json(motion, axes));
  if (!robot.workspace) return json;
  WorkspaceFields moved = *robot.workspace;
  for (WorkspaceAxis& axis : moved.axes) {
    const double origin = robot.origin[static_cast<std::size_t>(axis.coordinate)];
    axis.lower += origin;
    axis.upper += origin;
  }
  json["workspace"] = plain_workspace(robot.name, moved);
  return json;
}

}  // namespace

Json task_data(const TaskComparison& comparison) {
  Json json = {{"name", comparison.task},     {"axes", axes_data(comparison.axes)},
               {"middle", comparison.middle}, {"boxes", Json::array()},
               {"lines", Json::array()},      {"robots", Json::array()}};
  for (const TaskBox& box : comparison.boxes) {
    Json ranges = Json::array();
    for (std::size_t axis = 0; axis < comparison.axes.size(); ++axis)
      ranges.push_back(std::isfinite(box.ranges[axis][0]) ? Json(box.ranges[axis]) : Json());
    json["boxes"].push_back({{"name", box.name}, {"ranges", ranges}});
  }
  for (const TaskValue& line : comparison.robots.front().values) json["lines"].push_back(line.name);
  for (const ComparedRobot& robot : comparison.robots)
    json["robots"].push_back(compared_robot_json(robot, comparison.axes.size()));
  return json;
}

}  // namespace pkm
