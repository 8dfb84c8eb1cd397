// Active bounds and constraints of a design as sentences.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/storage/study_contents.hpp"

namespace pkm {

/// One sentence for each bound that is active, and for each constraint that is active or violated.
/// @param design   values of the variables
/// @param margins  values of the constraints
std::vector<std::string> active_sentences(const ProblemRecord& problem, std::span<const double> design,
                                          std::span<const double> margins);

}  // namespace pkm
