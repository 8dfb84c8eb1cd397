// What is worked out once a study has ended.
#pragma once

#include <functional>

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// The multiple of `step` next to `value`, as the decimal number that a reader expects: 0.7, not 0.7000000000000001.
double rounded_to(double value, double step);

/// From the best design so far: what its evaluation, the baseline's and that of the rounded design come to. Empty
/// records where nothing was evaluated.
FinalRecord final_record(const Study& study, const StudyContents& contents);

/// Adds to contents.final what may take much longer than an evaluation, step by step: the map of the best design, the
/// certain bounds that the study asks for, and values on exact columns of a study by voxels, where the mechanism has
/// columns. These end after study.exact_seconds. A note says why they are not known; they are NaN where they are read
/// from a region on voxels. Throws Stopped; what was complete by then is there.
/// @param begin  called before each step with a noun phrase
void complete_final_record(const Study& study, StudyContents& contents,
                           const std::function<void(const std::string&)>& begin);
inline void complete_final_record(const Study& study, StudyContents& contents) {
  complete_final_record(study, contents, [](const std::string&) {});
}

/// Whether values on exact columns are asked for and possible.
bool has_exact_step(const Study& study);

}  // namespace pkm
