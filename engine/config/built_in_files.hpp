// Files of the built-in mechanisms, whose limbs can have parameters of their own like those of any mechanism file.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/mechanism_file.hpp"
#include "engine/core/source_text.hpp"

namespace pkm {

/// The file of a built-in mechanism; std::nullopt for other names.
std::optional<SourceText> find_built_in_file(const std::string& name);

/// A built-in mechanism with the quantities and limits that a study adds, and with parameters of single limbs. Throws
/// std::invalid_argument with a message if there is no built-in mechanism file of this name.
/// @param own  parameters of single limbs; with them, the mechanism has no accelerators
std::shared_ptr<const Mechanism> built_in_mechanism(const std::string& name, const StudyAdditions& study,
                                                    const std::vector<LimbParameter>& own);

}  // namespace pkm
