// Patterns of limbs in [variables], such as "arm*.l_b": one variable for each copy of a parameter, or one for all.
#pragma once

#include <functional>

#include "engine/config/config_value.hpp"
#include "engine/core/source_text.hpp"

namespace pkm {

/// Whether the name of a limb or of its parameter is a pattern; `*` stands for any characters.
inline bool is_pattern(const std::string& name) { return name.find('*') != std::string::npos; }

/// Replaces every pattern in [variables] by the variables that it stands for: one for each limb whose joints or limits
/// depend on the parameter or, with tie = true, the parameter that all limbs share. A variable that has the name of a
/// single limb is not replaced.
/// @param description  reads the mechanism file that the study names
TomlValue with_limb_patterns(const TomlValue& study, const std::string& file_name,
                             const std::function<SourceText(const ConfigValue& file)>& description);

}  // namespace pkm
