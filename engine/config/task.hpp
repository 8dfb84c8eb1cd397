// A task for the comparison of several robots: regions, motions and limits, written like those of a study.
//
// A task file is a study without a robot. The task may name coordinates that some of the robots lack (a planar robot
// has no z); the entries for these coordinates are ignored for those robots. Coordinates of a robot that the task does
// not name have their default values. [origin] gives the position of a robot's base in the frame of the task, if it is
// not at the origin. The drive trains and motors of a task replace those of the robots' studies.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/config/study.hpp"
#include "engine/config/toml.hpp"

namespace pkm {

struct Task {
  std::string name;
  std::string file_name;
  TomlValue document;

  /// Names of the tables under this key, "region" or "motion".
  std::vector<std::string> names(const std::string& key) const;
};

/// Reads the file at `path`, and checks its keys. Throws ConfigError.
Task load_task_toml(const std::string& path);

/// A robot that is compared in a task.
struct TaskRobot {
  std::string name;  ///< unique name of the robot, to which [origin] refers
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> parameters;
  TomlValue study;  ///< document of the robot's study; if it has no study, only the table [mechanism]
  /// Text of the robot's mechanism file; std::nullopt: the mechanism is built in.
  std::optional<SourceText> description;
};

/// One line of a comparison.
struct TaskValue {
  std::string group;  ///< the region or motion that the value belongs to; "": neither
  std::string name;   ///< name of the value, such as "bin: conditioning, min"
  std::string unit;
  /// Minimum of the value for which the robot can perform this part of the task; std::nullopt: the value is only
  /// reported.
  std::optional<double> required = {};
  double value = std::numeric_limits<double>::quiet_NaN();  ///< the value; NaN: it is not available
  std::string reason = {};                                  ///< reason why the value is not available; "" if it is
  std::string limited_by = {};  ///< name of the limit that determines the value; "" if it is unknown
  bool is_users = false;        ///< true for an [[output]] of the task
  bool is_mistake = false;      ///< an [[output]] of the task that the robot refuses; a mistake if all robots refuse it
};

/// A robot in a task.
struct TaskEvaluation {
  Study study;                 ///< the task as a study of the robot, in the frame of the robot's base
  std::vector<double> origin;  ///< position of the robot's base in the frame of the task, by coordinate
  std::vector<TaskValue> values;
  Unsupported why_no_drives = {};  ///< reason why the robot cannot have the drive trains of the task; empty if it can
  /// Regions and motions that the robot refuses, such as a motion along a coordinate that it lacks. One that all robots
  /// refuse is a mistake.
  std::vector<std::pair<std::string, ConfigError>> refused = {};
};

/// Evaluates one robot in the task. For each region: the minimum of all margins in its box, and statistics over it. For
/// each motion: the minimum of the margins, energies and the shortest time. In addition, the outputs of the task. The
/// lists of all robots have the same lines in the same order. Throws ConfigError for a mistake in the task.
/// @param coordinates  names of the coordinates of all robots that are compared
TaskEvaluation evaluate_task(const Task& task, const TaskRobot& robot, const std::vector<std::string>& coordinates,
                             const Catalogues& catalogues);

}  // namespace pkm
