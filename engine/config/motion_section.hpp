// A motion as users write it: MOTION.toml, or a table [[motion]] of a study.
#pragma once

#include <memory>
#include <string>

#include "engine/config/config_value.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// The names in motions of a mechanism: its coordinates, and inputs, which may be formulas of the time.
struct MotionNames {
  std::vector<AxisInfo> coordinates;
  std::vector<InputInfo> inputs = {};
};
MotionNames motion_names(const Mechanism& mechanism);

/// Reads one motion.
/// @param more_keys  keys of the table that the caller reads
/// Throws ConfigError.
std::shared_ptr<const Motion> read_motion(const ConfigValue& table, const MotionNames& names,
                                          const std::vector<std::string>& more_keys = {});

/// Reads the file at `path`, which is one motion. Throws ConfigError, also when the file cannot be read.
std::shared_ptr<const Motion> load_motion_toml(const std::string& path, const MotionNames& names);

}  // namespace pkm
