// Changes of a study file behind a right seal.
#pragma once

#include <string>

namespace pkm::fuzz {

/// Changes one to three things inside a sealed study file - values, sizes, types and storage of datasets, attributes,
/// names, links, the study's text - and seals it again. What is no sealed study, or cannot be changed, comes back as it
/// is.
std::string mutated_study(const std::string& file, unsigned seed);

/// Whether anything in a sealed study lies outside of it or stands for something else: external or virtual storage,
/// links that are not hard.
bool looks_elsewhere(const std::string& file);

}  // namespace pkm::fuzz
