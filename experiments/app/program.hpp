// The command line as a library, for programs that add mechanisms, objectives, constraints or optimisers of their own.
//
//   int main(int argc, char** argv) {
//     pkm::Catalogues all = pkm::all_catalogues();
//     all.mechanisms.push_back(std::make_shared<const Mine>());
//     return pkm::program_main(argc, argv, all);
//   }
#pragma once

#include "engine/config/study.hpp"

namespace pkm {

/// Catalogues of all built-in mechanisms, objectives, constraints and optimisers.
Catalogues all_catalogues();

/// Runs the commands of `pkmopt` with these arguments, under the name by which the program was called. Pass the
/// arguments of main() unchanged, so that the program can start itself as a separate process that checks untrusted
/// study files first: see set_check_command().
/// @return the exit code
int program_main(int argc, char** argv, const Catalogues& catalogues);

}  // namespace pkm
