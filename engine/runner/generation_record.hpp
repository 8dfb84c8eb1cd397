// Adds the statistics of each generation to the record of its stage.
#pragma once

#include "engine/optimisers/optimiser.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm {

/// Appends one generation to the records of its stage: population, feasible share, front, and diversity, which is the
/// mean over the variables of the population's standard deviation relative to the variable's range. A generation that
/// an evaluation limit has cut short is reported again when it is complete and then replaces its first record.
/// @param seconds  wall time of the study at the end of the generation
void record_generation(const Generation& generation, const DesignSpace& space, double seconds, StageRecord& stage);

}  // namespace pkm
