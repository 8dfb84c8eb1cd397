// Availability of pose quantities for a mechanism: the conditioning needs consistent units and enough drives, the
// quantities of the joint-space inertia need dynamics.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanism/pose_quantity.hpp"

namespace pkm {

/// Empty if the conditioning is defined, else the reason why it is undefined at every pose of every design, with the
/// keys of the mechanism file that define it.
Unsupported no_conditioning(const MechanismInfo& info);

/// The same for any pose quantity.
Unsupported unavailable(const Mechanism& mechanism, const PoseQuantity& quantity);

}  // namespace pkm
