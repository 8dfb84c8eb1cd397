// Changes of what a study file records as a whole: sizes agree with one another, though not with the study's text.
#pragma once

#include <random>
#include <string>

namespace pkm::fuzz {

/// `file` with one thing more, less or otherwise in its record, sealed; as it is where it cannot be read.
/// @param schema  of `file`; the result has today's
std::string with_other_record(const std::string& file, int schema, std::mt19937& engine);

}  // namespace pkm::fuzz
