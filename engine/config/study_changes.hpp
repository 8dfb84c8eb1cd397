// What a command line changes in a study. It becomes part of the study's text, so that whoever reads the text, to go on
// with a run or to report it, has what was run.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/parameter.hpp"

namespace pkm {

/// In the command line's words: `name=value`, several separated by commas.
struct StudyChanges {
  std::vector<std::string> set;    ///< fixed parameters
  std::vector<std::string> limit;  ///< thresholds of a pose
  std::vector<std::string> cells;  ///< of voxels; or one number, along every coordinate that has some

  /// Parameters of one limb of a described mechanism, "arm2.l_b", that there have to be beside those that the study
  /// names; no change of it.
  std::vector<std::string> limb_parameters;

  /// Values of parameters and bounds of variables that a study file records; they replace those that its text gives.
  /// No change of the text.
  std::vector<std::pair<std::string, double>> recorded_parameters;
  std::vector<Variable> recorded_variables;

  bool empty() const { return set.empty() && limit.empty() && cells.empty(); }
  /// "--set", "L0=2", "--cells", "40"
  std::vector<std::string> arguments() const;
};

/// The parameters of limbs that the changes name.
std::vector<LimbParameter> limb_parameters(const StudyChanges& changes);

/// The text with an [[override]] behind it. Later ones prevail.
std::string with_changes(const std::string& text, const StudyChanges& changes);
/// The text without the [[override]]s that with_changes() has put behind it.
std::string without_changes(const std::string& text);

}  // namespace pkm
