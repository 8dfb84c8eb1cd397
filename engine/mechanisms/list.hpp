// The makers of the mechanisms of the catalogue: one line per mechanism here and one in all.cpp.
#pragma once

#include <memory>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

std::shared_ptr<const Mechanism> make_four_ppa_two_par();
std::shared_ptr<const Mechanism> make_three_crr_r_cru();
std::shared_ptr<const Mechanism> make_quadrupteron();
std::shared_ptr<const Mechanism> make_hybrid();

}  // namespace pkm
