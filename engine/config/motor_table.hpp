// Reads motors: [[motor]] with name, continuous_torque, peak_torque, speed, rotor_inertia and, optionally, curve.
#pragma once

#include <string>
#include <vector>

#include "engine/config/config_value.hpp"
#include "engine/dynamics/motor.hpp"

namespace pkm {

/// Reads the tables [[motor]] of a document. Throws ConfigError.
std::vector<Motor> read_motors(const ConfigValue& root);

/// Reads the motor file at `path`. Throws ConfigError, also when it cannot be read.
std::vector<Motor> load_motors_toml(const std::string& path);

}  // namespace pkm
