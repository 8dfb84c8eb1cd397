// Reads motion files. (study_draft.hpp declares the reader of a study's tables [[motion]].)
#pragma once

#include <memory>
#include <span>
#include <string>

#include "engine/config/config_value.hpp"
#include "engine/mechanism/mechanism.hpp"
#include "engine/motion/motion.hpp"

namespace pkm {

/// The names that a motion of a mechanism may use: coordinates and inputs, whose values may be formulas of the time,
/// and parameters, which may occur in the formula of any value.
struct MotionNames {
  std::vector<AxisInfo> coordinates;
  std::vector<InputInfo> inputs = {};
  std::vector<Parameter> parameters = {};
  std::vector<double> values = {};  ///< value of each of the parameters [SI]
};
MotionNames motion_names(const Mechanism& mechanism, std::span<const double> parameters);

/// Reads the text of a motion file. `file_name` is named in messages. Throws ConfigError.
std::shared_ptr<const Motion> read_motion_toml(const std::string& text, const std::string& file_name,
                                               const MotionNames& names);

/// Reads a table of comma-separated values (csv_columns.hpp): the columns `time`, which starts at 0 and increases, and
/// one for each coordinate. Throws ConfigError.
std::shared_ptr<const Motion> read_motion_csv(const std::string& text, const std::string& file_name,
                                              const MotionNames& names);

/// Reads the motion at `path`: a table if its name ends in ".csv", otherwise TOML. Throws ConfigError.
std::shared_ptr<const Motion> load_motion(const std::string& path, const MotionNames& names);

}  // namespace pkm
