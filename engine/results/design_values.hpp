// Values of design variables for people: the names of choices from catalogues.
#pragma once

#include <string>

#include "engine/storage/study_contents.hpp"

namespace pkm {

/// The name of the catalogue row that a value of a variable selects; "" if the variable is not a choice from a
/// catalogue.
std::string choice_name(const ProblemRecord& problem, std::size_t variable, double value);

}  // namespace pkm
