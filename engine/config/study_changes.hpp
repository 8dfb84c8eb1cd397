// Changes made to a study on the command line. They are appended to the text of the study, so that `resume` and
// `report` use the problem that was run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/config/toml.hpp"
#include "engine/core/parameter.hpp"
#include "engine/core/source_text.hpp"

namespace pkm {

/// Values of command-line options that change a study. Most are lists "name=value,.."; an option can occur several
/// times.
struct StudyChanges {
  std::vector<std::string> set;    ///< values of fixed parameters (--set)
  std::vector<std::string> limit;  ///< thresholds of limits on poses (--limit)
  std::vector<std::string> cells;  ///< numbers of voxels by coordinate, or one number for all coordinates (--cells)
  std::vector<std::string> start_from;  ///< name of the study file whose designs the first stage starts from
  /// Designs from which the first stage starts, one list "name=value,.." each (engine/runner/start_from.hpp).
  std::vector<std::string> start;

  /// Parameters of single limbs, such as "arm2.l_b", that the mechanism must have in addition to those that the study
  /// names. They do not change the study.
  std::vector<std::string> limb_parameters;
  std::vector<std::string> joint_error;  ///< bounds of joint errors (--joint-error), for a mechanism without a study
  std::optional<std::int64_t> machines;  ///< number of samples of [tolerance]; does not change the text of the study

  /// Values of parameters and bounds of variables recorded in a study file. They replace the values given by the
  /// study's text, but do not change the text.
  std::vector<std::pair<std::string, double>> recorded_parameters;
  std::vector<Variable> recorded_variables;

  bool empty() const { return set.empty() && limit.empty() && cells.empty() && start.empty(); }
  /// The changes as command-line arguments: "--set", "L0=2", "--cells", "40".
  std::vector<std::string> arguments() const;
};

/// The parameters of single limbs that the changes name.
std::vector<LimbParameter> limb_parameters(const StudyChanges& changes);

/// The text of a study with an [[override]] appended. Later overrides take precedence.
std::string with_changes(const std::string& text, const StudyChanges& changes);
/// The text of a study with an [[override]] that contains the file of a catalogue, for reading the study elsewhere.
std::string with_catalogue(const std::string& text, const SourceText& file);
/// The file of a catalogue that with_catalogue() has added under this name; std::nullopt if there is none.
std::optional<SourceText> recorded_catalogue(const TomlValue& study, const std::string& file_name);
/// The text of a study without the [[override]]s that with_changes() and with_catalogue() have appended.
std::string without_changes(const std::string& text);

}  // namespace pkm
