// Mechanisms of a user, written against the public interface alone: what the engine does with machines that it does not
// know. The contract suites hold them to the laws of the catalogue's, and tests/packaging makes a program of them.
#pragma once

#include "engine/mechanism/mechanism.hpp"

namespace pkm::test {

std::shared_ptr<const Mechanism> make_five_bar(), make_rotary_delta(), make_gough(), make_scara();

inline MechanismList own_mechanisms() { return {make_five_bar(), make_rotary_delta(), make_gough(), make_scara()}; }

}  // namespace pkm::test
