// What is worked out once a study has ended.
#pragma once

#include "engine/setup/study.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// The multiple of `step` next to `value`, as the decimal number that a reader expects: 0.7, not 0.7000000000000001.
double rounded_to(double value, double step);

/// From the best design so far. Empty records where nothing was evaluated. A note says why a voxel study knows no
/// values on exact columns that its mechanism has; they are NaN where they are read from a region on voxels. Asked to
/// stop, certain bounds end early, `stopped`.
FinalRecord final_record(const Study& study, StudyContents& contents);

}  // namespace pkm
