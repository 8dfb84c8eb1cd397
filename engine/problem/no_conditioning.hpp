// Why poses of a mechanism have no conditioning, and why it has no other quantity of poses.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/pose_quantity.hpp"

namespace pkm {

/// Why the conditioning is undefined at every pose of every design, with the keys that define it.
Refusal no_conditioning(const MechanismInfo& info);

/// The same of any quantity of poses.
Refusal unavailable(const Mechanism& mechanism, const PoseQuantity& quantity);

}  // namespace pkm
