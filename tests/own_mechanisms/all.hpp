// User-defined mechanisms, which use the public interface only and have no accelerators. The contract tests check them
// like the mechanisms of the catalogue, and tests/packaging builds a program with them.
#pragma once

#include "engine/mechanism/mechanism_list.hpp"

namespace pkm::test {

std::shared_ptr<const Mechanism> make_five_bar(), make_rotary_delta(), make_gough(), make_scara();

inline MechanismList own_mechanisms() { return {make_five_bar(), make_rotary_delta(), make_gough(), make_scara()}; }

}  // namespace pkm::test
