// A task that several robots are compared in: regions, motions and limits, written like those of a study.
//
// A task file is a study without a robot. Robots may lack coordinates that the task names (a planar robot has no z);
// what the task says of these is left out for them. Coordinates of a robot that the task does not name have their
// default values. A robot's base may stand elsewhere: [origin] gives its position in the frame of the task.
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

/// A robot that does a task.
struct TaskRobot {
  std::string name;  ///< unique, for [origin]
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> parameters;
  TomlValue study;                        ///< document of its study; for a mechanism only the table [mechanism]
  std::optional<SourceText> description;  ///< its mechanism file
};

/// One line of a comparison: a margin (the robot does this part of the task if it is >= 0), or a value.
struct TaskValue {
  std::string name;  ///< "region bin, all poses"
  std::string unit;
  bool is_margin = false;
  double value = 0;         ///< NaN: not available
  std::string reason;       ///< why it is not available
  bool is_mistake = false;  ///< an [[output]] of the task that the robot refuses; a mistake if all robots refuse it
};

/// Evaluates one robot in the task: for each region the minimum of all margins in its box and indices over it, for each
/// motion the minimum of the margins and the peak power, and the task's outputs. The lists of different robots
/// have the same lines in the same order. Throws ConfigError for a mistake in the task.
/// @param coordinates  names of the coordinates of all robots that are compared
std::vector<TaskValue> evaluate_task(const Task& task, const TaskRobot& robot,
                                     const std::vector<std::string>& coordinates, const Catalogues& catalogues);

}  // namespace pkm
