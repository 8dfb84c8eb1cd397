// Mutations of the HDF5 contents of a study file, with a valid header.
#pragma once

#include <string>

namespace pkm::fuzz {

/// Makes one to three changes in a study file - to values, sizes, types and storage of datasets, attributes, names,
/// links, or the text of the study - and writes a valid header. Returns the file unchanged if its header is invalid or
/// if it cannot be changed.
std::string mutated_study(const std::string& file, unsigned seed);

/// Whether a study file is not self-contained: external or virtual storage, or links that are not hard links.
bool has_external_references(const std::string& file);

}  // namespace pkm::fuzz
