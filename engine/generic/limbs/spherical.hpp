// Inverse kinematics of a spherical chain: three revolute joints whose axes u, w, v intersect in one point, connected
// by two links with the angles alpha_1 (from u to w) and alpha_2 (from w to v).
#pragma once

#include <array>
#include <vector>

#include "engine/generic/limbs/limb.hpp"

namespace pkm::limbs {

struct SphericalChain {
  Vector3 w;  ///< unit vector along the axis of the joint in the middle
  /// Angles of the three joints: of the first link about u, from `zero`; of the second link relative to the first about
  /// w, 0 where both lie on one great circle in sequence; of the platform relative to the second link about v, from the
  /// normal w x v of the second link to `reference`. They are in (-pi, pi], except for the first one, which is not
  /// wrapped.
  std::array<Term, 3> angles;
  std::vector<Constraint> constraints;  ///< constraints under which the chain assembles
  /// Left sides of the loop-closure equation, closure = 0: one form for each of the three joints that may be driven.
  std::array<Term, 3> closures;
};

/// @param u, v       unit vectors along the first axis, fixed to the base, and along the last, fixed to the platform
/// @param zero       unit vector normal to u: half-plane of the first link at q = 0
/// @param reference  vector fixed to the platform, not parallel to v
/// @param alpha      angles of the two links [rad]
/// @param branch     sign (+1 or -1) of the solution
/// @param q          the driven joint's coordinate as a variable of the loop-closure equations
SphericalChain spherical_chain(const Vector3& u, const Vector3& v, const Vector3& zero, const Vector3& reference,
                               const std::array<Term, 2>& alpha, const Term& branch, const Term& q);

}  // namespace pkm::limbs
