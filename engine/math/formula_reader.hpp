// From a formula's text to its steps. The only place that knows muParser.
#pragma once

#include <string>
#include <vector>

#include "engine/math/formula_program.hpp"

namespace pkm::formula {

/// Throws as Formula's constructor does.
Program read_program(const std::string& text, const std::vector<std::string>& names);

}  // namespace pkm::formula
