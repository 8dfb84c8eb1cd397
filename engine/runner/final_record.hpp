// Computes the final results of a study after its last stage.
#pragma once

#include <functional>

#include "engine/config/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// @return the multiple of `step` nearest to `value`, as the double nearest to its decimal representation if 1 / step
/// is an integer: 0.7, not 0.7000000000000001
double rounded_to(double value, double step);

/// Evaluates the baseline, the best design and the rounded best design, and lists the active bounds and constraints.
/// Without a best design only the baseline is evaluated.
FinalRecord final_record(const Study& study, const StudyContents& contents);

/// Adds the results that may take much longer than one evaluation to contents.final:
/// - the voxel map of the best design;
/// - certified bounds of the volume and certified motions, if the study requests them;
/// - exact values (columns) of the best design and the baseline of a voxel study, if the mechanism supports the method,
///   limited to study.exact_seconds. If there are none, a note states the reason; values that depend on a region
///   evaluated on voxels are NaN.
/// Throws Stopped; results completed by then remain.
/// @param begin  called before each step with its description, a noun phrase
void complete_final_record(const Study& study, StudyContents& contents,
                           const std::function<void(const std::string&)>& begin);
inline void complete_final_record(const Study& study, StudyContents& contents) {
  complete_final_record(study, contents, [](const std::string&) {});
}

/// @return true if the study is evaluated on voxels, and its exact values are requested and supported by the mechanism
bool has_exact_step(const Study& study);

}  // namespace pkm
