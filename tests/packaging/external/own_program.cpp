// A program with mechanisms of your own and nothing else: it has every command that pkmopt has.
#include "experiments/app/program.hpp"
#include "tests/own_mechanisms/all.hpp"

int main(int argc, char** argv) {
  pkm::Catalogues all = pkm::all_catalogues();
  all.mechanisms = pkm::test::own_mechanisms();
  return pkm::program_main(argc, argv, all);
}
