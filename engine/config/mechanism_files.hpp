// Texts of the mechanism files in engine/config/mechanisms, which are compiled into the program.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pkm {

/// Names and texts of the built-in mechanisms.
const std::vector<std::pair<std::string, std::string>>& mechanism_files();

}  // namespace pkm
