// The frames of a mechanism file, for `pkmopt check`.
#pragma once

#include <string>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// The dependent coordinates and the frames of a mechanism, as tables; "" if there are none.
std::string frames_text(const Mechanism& mechanism);

}  // namespace pkm
