// Reads motor files: [[motor]] with name, continuous_torque, peak_torque, speed, rotor_inertia.
#pragma once

#include <string>
#include <vector>

#include "engine/dynamics/motor.hpp"

namespace pkm {

/// Reads the file at `path`. Throws ConfigError, also when it cannot be read.
std::vector<Motor> load_motors_toml(const std::string& path);

}  // namespace pkm
