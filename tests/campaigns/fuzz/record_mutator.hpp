// Mutations of the record of a study file: the sizes of its arrays stay consistent with each other, but not with the
// text of the study.
#pragma once

#include <random>
#include <string>

namespace pkm::fuzz {

/// Adds, removes or changes one element of the record of a study file and writes a valid header. Returns the file
/// unchanged if it cannot be read.
/// @param schema  schema version of `file`; the result has the current one
std::string with_mutated_record(const std::string& file, int schema, std::mt19937& engine);

}  // namespace pkm::fuzz
