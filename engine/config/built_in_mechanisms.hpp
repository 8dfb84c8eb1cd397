// The mechanisms of the catalogue: files that the program carries, with accelerators where a closed form is faster.
#pragma once

#include <string>

#include "engine/config/mechanism_file.hpp"
#include "engine/mechanism/mechanism_list.hpp"

namespace pkm {

/// All built-in mechanisms, in the order in which `pkmopt list` shows them. Each is read from its file when it is first
/// used.
const MechanismList& all_mechanisms();

/// A built-in mechanism with the quantities and limits that a study adds. Throws std::invalid_argument with a message
/// if there is no built-in mechanism file of this name.
std::shared_ptr<const Mechanism> built_in_mechanism(const std::string& name, const StudyAdditions& study);

/// The text of the file of a built-in mechanism, which `pkmopt list NAME --file` prints. Throws std::invalid_argument
/// for other names.
const std::string& mechanism_file_text(const std::string& name);

}  // namespace pkm
