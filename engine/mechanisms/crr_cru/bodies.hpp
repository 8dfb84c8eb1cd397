// (3CRR/R)&CRU and Quadrupteron: their bodies and joints, one by one, in the order of README.md. pose_dynamics() is
// the sum of these bodies' terms, limb by limb.
//
// Source: as model.hpp, sections 2.2 to 2.4 with their errata.
#pragma once

#include <array>
#include <vector>

#include "engine/dynamics/newton_euler.hpp"
#include "engine/mechanisms/crr_cru/dynamics.hpp"
#include "engine/mechanisms/crr_cru/masses.hpp"

namespace pkm::crr_cru {

using PlacedBody = pkm::PlacedBody<4>;

/// The bodies in the order above; state and limbs as of one pose. Infinite where sin theta_i2 = 0.
std::vector<PlacedBody> bodies(const Geometry<double>& g, const Masses<double>& b, const Limbs<double>& limbs,
                               const pkm::MotionState<double, 4>& state);

/// The slides: point masses that move along their rails.
std::array<PlacedBody, 4> slides(const Masses<double>& b, const Limbs<double>& limbs,
                                 const pkm::MotionState<double, 4>& state);

/// Equations of all bodies. Joints: for limb i a_i at A_i on rod i1, b_i at B_i on rod i1 (from rod i2), c_i at C_i on
/// rod i2 (from the platform), each with its couples; where the platforms are jointed, t1 at D on the middle one.
/// @param wrench  on the platform, at the moving platform's centre of mass without payload
NewtonEuler newton_euler(const Geometry<double>& g, const Masses<double>& b, const Limbs<double>& limbs,
                         const pkm::MotionState<double, 4>& state, const Vector<double, 4>& acceleration,
                         const Wrench<double>& wrench);

}  // namespace pkm::crr_cru
