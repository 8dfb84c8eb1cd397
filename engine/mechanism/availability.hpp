// Determines which pose quantities are defined for a mechanism. The conditioning requires consistent units and enough
// drives; quantities derived from the joint-space inertia require dynamics.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/pose_quantity.hpp"

namespace pkm {

/// The reason why the conditioning is undefined at every pose of every design, with the keys of the mechanism file that
/// would define it; empty if it is defined.
Unsupported why_no_conditioning(const MechanismInfo& info);

/// The reason why a pose quantity is undefined for this mechanism; empty if it is defined.
Unsupported why_unavailable(const Mechanism& mechanism, const PoseQuantity& quantity);

}  // namespace pkm
