// Entry point of the command-line program pkmopt.

#include "experiments/app/program.hpp"

int main(int argc, char** argv) { return pkm::program_main(argc, argv, pkm::all_catalogues()); }
