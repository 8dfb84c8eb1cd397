// (3CRR/R)&CRU and Quadrupteron: joint-space inertia at many poses of one phi, without matrix algebra at each pose.
// Derivation: README.md.
#pragma once

#include <limits>

#include "engine/accelerators/crr_cru/joint_inertia.hpp"
#include "engine/accelerators/crr_cru/limb_inertia.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/geometry/singular.hpp"

namespace pkm::crr_cru {

/// The part of the joint-space inertia M_q that depends on phi alone. If J, which also depends on phi alone, is
/// singular to working precision, this part and every row of M_q are NaN.
template <class S>
YawInertia<S> yaw_inertia(const Geometry<S>& g, const Masses<S>& b, const S& phi) {
  const auto [sin, cos] = sincos(phi);
  const auto arm = arms(g, sin, cos);
  std::array<Vector<S, 3>, 4> by_phi;
  for (std::size_t i = 0; i < 4; ++i) by_phi[i] = yaw_velocity(arm[i]);
  const S j1 = by_phi[0][0], j2 = by_phi[1][1], j4 = by_phi[3][1];
  // The columns of J belong to x, y and phi; z depends on slide 3 alone.
  const Matrix<double, 3, 3> J = {{1, 0, value_of(j1), 0, 1, value_of(j2), 0, 1, value_of(j4)}};
  const S w = is_singular(J) ? S(std::numeric_limits<double>::quiet_NaN()) : S(S(1.0) / (j4 - j2));
  // Velocities of x, y, z and phi if only slide 4 moves, with unit velocity.
  const Vector<S, 4> X = {{j1 * w * -1.0, j2 * w * -1.0, S(0.0), w}};

  Matrix<S, 4, 4> M = platform_inertia(g, b, sin, cos);
  YawInertia<S> f;
  f.rotors = b.rotors;
  for (std::size_t i = 0; i < 4; ++i) {
    const LimbAxes& limb = kLimbs[i];
    f.arm[i] = arm[i].to_joint;
    f.per_slide[i] = {X[limb.p] + by_phi[i][limb.p] * w, X[limb.q] + by_phi[i][limb.q] * w};
    add_on_rail(limb.e, S(b.m_1[i] + b.m_2[i] + b.slide), by_phi[i][limb.e], M);
  }
  const Vector<S, 4> v = M * X;
  f.xx = M(0, 0);
  f.yy = M(1, 1);
  f.zz = M(2, 2);
  f.vx = v[0];
  f.vy = v[1];
  f.vz = v[2];
  f.k = dot(X, v);
  return f;
}

/// The joint-space inertia M_q at a feasible position [kg].
template <class S>
Matrix<S, 4, 4> joint_inertia(const Geometry<S>& g, const Masses<S>& b, const YawInertia<S>& f, const Vector3<S>& at,
                              const WorkingMode& mode) {
  std::array<PlaneInertia<S>, 4> limbs;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3<S> C = {at[0] + f.arm[i][0], at[1] + f.arm[i][1], at[2] + f.arm[i][2]};
    limbs[i] = plane_inertia(g, b, i, limb_at(g, i, C, mode[i]));
  }
  return matrix_of(joint_inertia(f, limbs));
}

}  // namespace pkm::crr_cru
