// Designs of a finished or stopped study as starting points of another study.
#pragma once

#include <string>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Changes to a study that make its first stage start from the best designs of another study.
struct StartFrom {
  /// Value of StudyChanges::start: the designs, best first, each as text such as "a=0.3,b=1".
  std::vector<std::string> start;
  /// Number of designs that lie outside the study's bounds, or between the steps of a variable; they are moved to the
  /// nearest allowed design.
  std::size_t moved = 0;
  /// Names of the variables that are not parameters of the other study. They get the value of the baseline or, without
  /// a baseline, the centre of their range.
  std::vector<std::string> missing;
};

/// Chooses designs of `other` for the first stage of `study`: for a genetic algorithm at most half of the population,
/// for a solver as many as it has multistart runs, and one for any other optimiser. They are chosen by
/// distinct_best_designs(). A variable gets the value of the other study's parameter of the same name. If there is no
/// such parameter, it gets the value of the baseline or, without a baseline, the centre of its range. Throws
/// ConfigError if the other study has no variable in common with `study`, if units differ, or if it has no design.
/// @param file  name of the other study's file, for messages
/// Precondition: the study has a stage.
StartFrom start_from(const Study& study, const StudyContents& other, const std::string& file);

}  // namespace pkm
