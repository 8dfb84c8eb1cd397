// Version and git revision of this program. version.cmake writes the definitions in every build.
#pragma once

#include <string>

namespace pkm {

std::string program_version();  ///< version, for example "0.1.0"
/// Git revision: "f6d30b4a1c22", "f6d30b4a1c22+changes", or "unknown" outside of a git repository.
std::string program_revision();

/// Name, version and revision of the program: "pkmopt 0.1.0 (f6d30b4a1c22)".
inline std::string program_words() { return "pkmopt " + program_version() + " (" + program_revision() + ")"; }

}  // namespace pkm
