// The mechanisms of the catalogue: files that the program carries, with accelerators where a closed form is faster.
#pragma once

#include <string>

#include "engine/config/mechanism_file.hpp"
#include "engine/mechanism/mechanism_list.hpp"

namespace pkm {

/// In the order in which `pkmopt list` shows them. Each is read from its file when it is first used.
const MechanismList& all_mechanisms();

/// One of them with what a study adds. Throws std::invalid_argument with a sentence if a mechanism of this name is none
/// of them: it is written in C++.
std::shared_ptr<const Mechanism> built_in_mechanism(const std::string& name, const StudyAdditions& study);

/// The file of one of them: what `pkmopt list NAME --file` prints. Throws std::invalid_argument for other names.
const std::string& mechanism_file_text(const std::string& name);

}  // namespace pkm
