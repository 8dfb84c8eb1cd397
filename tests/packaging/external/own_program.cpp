// Example of a program with user-defined mechanisms only; it has all commands of pkmopt.
#include "experiments/app/program.hpp"
#include "tests/own_mechanisms/all.hpp"

int main(int argc, char** argv) {
  pkm::Catalogues all = pkm::all_catalogues();
  all.mechanisms = pkm::test::own_mechanisms();
  return pkm::program_main(argc, argv, all);
}
