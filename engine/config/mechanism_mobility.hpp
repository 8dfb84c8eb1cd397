// The line on mobility of `pkmopt check`.
#pragma once

#include <span>
#include <string>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// How many degrees of freedom the drives determine at a pose, and whether joints prevent the platform's others.
/// @param rank  of the Jacobian at the pose
std::string mobility_text(const Mechanism& mechanism, std::span<const double> parameters, const Pose<double>& pose,
                          std::size_t rank);

}  // namespace pkm
