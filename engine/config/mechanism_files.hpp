// The files of engine/config/mechanisms, which the build puts into the program.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pkm {

/// Names and texts.
const std::vector<std::pair<std::string, std::string>>& mechanism_files();

}  // namespace pkm
