// A motion as users write it: MOTION.toml, or a table [[motion]] of a study.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "engine/motion/motion.hpp"
#include "engine/setup/config_value.hpp"

namespace pkm {

/// Reads one motion.
/// @param coordinates  the mechanism's names of x, y, z, rotation: MechanismInfo::coordinates
/// @param more_keys    keys of the table that the caller reads
/// Throws ConfigError.
std::shared_ptr<const Motion> read_motion(const ConfigValue& table, const std::array<std::string, 4>& coordinates,
                                          const std::vector<std::string>& more_keys = {});

/// Reads the file at `path`, which is one motion. Throws ConfigError, also when the file cannot be read.
std::shared_ptr<const Motion> load_motion_toml(const std::string& path, const std::array<std::string, 4>& coordinates);

}  // namespace pkm
