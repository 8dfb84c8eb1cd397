// Version and git revision of this program. version.cmake writes the definitions in every build.
#pragma once

#include <string>

namespace pkm {

std::string program_version();   ///< "0.1.0"
std::string program_revision();  ///< "f6d30b4a1c22", "f6d30b4a1c22+changes", or "unknown" outside git

/// "pkmopt 0.1.0 (f6d30b4a1c22)"
inline std::string program_words() { return "pkmopt " + program_version() + " (" + program_revision() + ")"; }

}  // namespace pkm
