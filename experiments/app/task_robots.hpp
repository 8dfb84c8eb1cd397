// The robots that a task compares, named on the command line.
#pragma once

#include <string>
#include <vector>

#include "engine/config/task.hpp"
#include "experiments/app/commands.hpp"

namespace pkm {

/// The robots that the arguments name: mechanisms, mechanism files, studies (their baselines), or study files (their
/// best designs). Each robot has a name of its own, the stem of the file. Throws ConfigError and StorageError.
std::vector<TaskRobot> find_task_robots(const Session& session, const std::vector<std::string>& arguments);

}  // namespace pkm
