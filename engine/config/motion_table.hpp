// Reads motion files. (study_draft.hpp declares the reader of a study's tables [[motion]].)
#pragma once

#include <memory>
#include <string>

#include "engine/config/config_value.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// The names that a motion of a mechanism may use: the coordinates, and the inputs, which may be formulas of the time.
struct MotionNames {
  std::vector<AxisInfo> coordinates;
  std::vector<InputInfo> inputs = {};
};
MotionNames motion_names(const Mechanism& mechanism);

/// Reads the text of a motion file. `file_name` is named in messages. Throws ConfigError.
std::shared_ptr<const Motion> read_motion_toml(const std::string& text, const std::string& file_name,
                                               const MotionNames& names);

/// Reads one motion from the file at `path`. Throws ConfigError, also when the file cannot be read.
std::shared_ptr<const Motion> load_motion_toml(const std::string& path, const MotionNames& names);

}  // namespace pkm
