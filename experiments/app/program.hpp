// The command line as a library: a program with mechanisms, objectives, constraints or optimisers of its own.
//
//   int main(int argc, char** argv) {
//     pkm::Catalogues all = pkm::all_catalogues();
//     all.mechanisms.push_back(std::make_shared<const Mine>());
//     return pkm::program_main(argc, argv, all);
//   }
#pragma once

#include "engine/setup/study.hpp"

namespace pkm {

/// Everything that is built in.
Catalogues all_catalogues();

/// What `pkmopt` does with these arguments, under the name by which the program was called. Returns the exit code. They
/// are those that main() was given where study files of others are to be read by a process of their own first: see
/// use_file_checker().
int program_main(int argc, char** argv, const Catalogues& catalogues);

}  // namespace pkm
