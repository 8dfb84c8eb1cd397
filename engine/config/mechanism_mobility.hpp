// Writes the line "mobility" in the output of `pkmopt check`.
#pragma once

#include <span>
#include <string>

#include "engine/mechanism/mechanism.hpp"

namespace pkm {

/// Text that states how many degrees of freedom the drives determine at a pose, and whether the joints prevent all
/// other motions of the platform.
/// @param rank   rank of the Jacobian at the pose
/// @param cause  explains why the rank is less than the number of coordinates, if this is the case
std::string mobility_text(const Mechanism& mechanism, std::span<const double> parameters, const Pose<double>& pose,
                          std::size_t rank, const std::string& cause);

}  // namespace pkm
