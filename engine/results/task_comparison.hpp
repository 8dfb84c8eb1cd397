// Comparison of several robots in one task: all values side by side, the workspaces, and the loads along the motions.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/task.hpp"
#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

/// A value over the time of a motion, at equidistant times including both ends.
struct TaskCurve {
  std::string name, unit;      ///< name and unit of the value, such as "power of all drives", "W"
  std::vector<double> values;  ///< values at equidistant times; NaN: undefined
};

/// A robot along a motion of the task. If it refuses the motion, there are neither curves nor a path.
struct TaskMotion {
  std::string name;
  double duration = 0;            ///< duration of the motion [s]
  std::vector<TaskCurve> curves;  ///< values of the robot over the time; values that the robot does not have are
                                  ///< omitted
  /// Positions along the motion in the frame of the task, in the order of TaskComparison::axes; NaN for a coordinate
  /// that the robot lacks.
  std::vector<std::array<double, 3>> path;
};

struct ComparedRobot {
  std::string name;
  std::vector<TaskValue> values;
  std::vector<TaskMotion> motions;
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> parameters;
  LimitSpec limits;
  Pose<double> origin;  ///< position of the base in the frame of the task
  /// Workspace over those axes of the comparison that the robot has, in the frame of the robot, with the fields
  /// `feasible` and `margin`. The other coordinates have the values of the task.
  std::optional<WorkspaceFields> workspace;
  std::string why_no_workspace = {};  ///< reason why there is no workspace; "" if there is one

  /// The first part of the task that the robot cannot perform; if there is none, the first part for which it is unknown
  /// whether the robot can perform it; null if there is neither.
  const TaskValue* violated() const;
  /// Returns true if the task has a value that the robot must reach.
  bool has_requirements() const;
  /// Whether the robot can perform the task; std::nullopt if this is unknown, or the task has no requirements.
  std::optional<bool> performs_task() const;
  /// Whether the robot can perform the task, as text: "yes", "no: bin: margin", "unknown: ..", or "the task has no
  /// requirements".
  std::string verdict() const;
};

/// A region in the frame of the task: [minimum, maximum] along each axis of the comparison; an infinite range for an
/// axis that the region does not name.
struct TaskBox {
  std::string name;
  std::array<std::array<double, 2>, 3> ranges;
};

struct TaskComparison {
  std::string task;
  std::vector<AxisInfo> axes;  ///< one to three coordinates over which the workspaces are compared
  /// Values of the axes at which slices are drawn, in the frame of the task: the middle of the first region or, without
  /// regions, of the motions.
  std::array<double, 3> middle{};
  std::vector<TaskBox> boxes;
  std::vector<ComparedRobot> robots;
};

/// Evaluates the robots in the task. Throws ConfigError for a mistake in the task.
/// @param cells  number of cells of the workspaces along each axis
TaskComparison compare_in_task(const Task& task, const std::vector<TaskRobot>& robots, const Catalogues& catalogues,
                               std::int64_t cells = 40);

/// Converts a value to the unit in which people read it: mm for lengths and deg for angles. @return value and unit
std::pair<double, std::string> in_display_unit(double value, const std::string& unit);

}  // namespace pkm
