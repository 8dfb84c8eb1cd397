// A task for the comparison of several robots: regions, motions and limits, written like those of a study.
//
// A task file is a study without a robot. The task may name coordinates that some of the robots lack (a planar robot
// has no z); the entries for these coordinates are ignored for those robots. Coordinates of a robot that the task does
// not name have their default values. [origin] gives the position of a robot's base in the frame of the task, if it is
// not at the origin.
#pragma once

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
};

/// Reads the file at `path`, and checks its keys. Throws ConfigError.
Task load_task_toml(const std::string& path);

/// A robot that is compared in a task.
struct TaskRobot {
  std::string name;  ///< unique, for [origin]
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> parameters;
  TomlValue study;                        ///< document of its study; without a study, only the table [mechanism]
  std::optional<SourceText> description;  ///< its mechanism file
};

/// One line of a comparison: a value, or a margin, which is >= 0 if the robot can perform this part of the task.
struct TaskValue {
  std::string name;  ///< text of the line, such as "region bin, all poses"
  std::string unit;
  bool is_margin = false;
  double value = 0;         ///< the value or margin [SI]; NaN: not available
  std::string reason;       ///< why it is not available
  bool is_mistake = false;  ///< an [[output]] of the task that the robot refuses; a mistake if all robots refuse it
};

/// Evaluates one robot in the task. For each region: the minimum of all margins in its box, and indices over it. For
/// each motion: the minimum of the margins and the peak power. In addition, the outputs of the task. The lists of all
/// robots have the same lines in the same order. Throws ConfigError for a mistake in the task.
/// @param coordinates  names of the coordinates of all robots that are compared
std::vector<TaskValue> evaluate_task(const Task& task, const TaskRobot& robot,
                                     const std::vector<std::string>& coordinates, const Catalogues& catalogues);

}  // namespace pkm
