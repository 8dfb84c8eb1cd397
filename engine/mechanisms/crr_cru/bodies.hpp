// (3CRR/R)&CRU and Quadrupteron: their bodies and joints, one by one.
//
// Rods 11, 12, 21, .. 42 (i1 next to the slide, i2 next to the platform), then the middle and the moving platform, or
// the one platform of the Quadrupteron. With the rods' turning rates per Xdot (rows)
//
//   jpsi_1 = u2^T P J_C/(l1 sin theta_2),   jpsi_2 = -u1^T P J_C/(l2 sin theta_2),   P = [p; q], J_C = [1 | z x arm_i]
//   rod 1   J_v = e e^T J_C + l1 n1 jpsi_1/2                     J_omega = s e jpsi_1
//   rod 2   J_v = e e^T J_C + l1 n1 jpsi_1 + l2 n2 jpsi_2/2      J_omega = s e jpsi_2
//
// Source: as model.hpp, sections 2.2 to 2.4 with their errata. pose_dynamics() (dynamics.hpp) is the sum of
// these bodies' terms, limb by limb.
//
// A slide has no joint with its rail in these equations: it only moves along it, the actuator moves it, and what it
// feels across the rail goes into the ground. So "a1" is what slide 1 and rod 11 do to each other, and the actuator
// gives the force along the rail plus m_s (rhoddot - g . e). The payload is part of the platform that carries D.
#pragma once

#include <array>
#include <vector>

#include "engine/dynamics/newton_euler.hpp"
#include "engine/mechanisms/crr_cru/masses.hpp"

namespace pkm::crr_cru {

using PlacedBody = pkm::PlacedBody<4>;

/// The bodies in the order above; state and limbs as of one pose. Infinite where sin theta_i2 = 0.
std::vector<PlacedBody> bodies(const Geometry<double>& g, const Masses<double>& b, const Limbs<double>& limbs,
                               const MotionState<double>& state);

/// The slides: point masses that move along their rails.
std::array<PlacedBody, 4> slides(const Masses<double>& b, const Limbs<double>& limbs, const MotionState<double>& state);

/// Equations of all bodies. Joints: for limb i a_i at A_i on rod i1, b_i at B_i on rod i1 (from rod i2), c_i at C_i on
/// rod i2 (from the platform), each with its couples; where the platforms are jointed, t1 at D on the middle one.
/// @param wrench  on the platform, at the moving platform's centre of mass without payload
NewtonEuler newton_euler(const Geometry<double>& g, const Masses<double>& b, const Limbs<double>& limbs,
                         const MotionState<double>& state, const Vector<double, 4>& acceleration,
                         const Wrench<double>& wrench);

/// What all joints carry; a reason where the limbs do not reach.
Reactions reactions(const Geometry<double>& g, const Masses<double>& b, const WorkingMode& mode,
                    const MotionState<double>& state, const Vector<double, 4>& acceleration,
                    const Wrench<double>& wrench);

}  // namespace pkm::crr_cru
