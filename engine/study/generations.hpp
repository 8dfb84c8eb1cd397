// What a study's file keeps of each generation.
#pragma once

#include "engine/optimisers/optimiser.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Adds a generation's entries to the records of its stage. One that an evaluation limit had cut short is reported
/// again, complete, and takes its own place.
/// @param seconds  wall time of the study at the generation's end
void record_generation(const Generation& generation, const DesignSpace& space, double seconds, StageRecord& stage);

}  // namespace pkm
