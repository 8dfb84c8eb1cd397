// Includes the mechanism of tests/packaging/external without its main().
#define main static __attribute__((unused)) main_of_scara
#include "tests/packaging/external/scara.cpp"
#undef main

#include "tests/own_mechanisms/all.hpp"

std::shared_ptr<const pkm::Mechanism> pkm::test::make_scara() { return std::make_shared<Scara>(); }
