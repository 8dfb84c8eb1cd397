// (3CRR/R)&CRU and Quadrupteron: forward kinematics.
#pragma once

#include <vector>

#include "engine/mechanisms/crr_cru/yaw.hpp"

namespace pkm::crr_cru {

/// Both assembly branches for slide positions: "+" with cos(phi + delta) > 0 and "-"; one where they meet, none where
/// |sin(phi + delta)| would exceed 1. phi in (-pi, pi].
std::vector<AssemblyMode> forward(const Geometry<double>& g, const AxisVector<double>& rho);

}  // namespace pkm::crr_cru
