// (3CRR/R)&CRU and Quadrupteron: joint-space inertia at many poses of one phi, without matrix algebra at a pose.
// Derivation: README.md.
#pragma once

#include <limits>

#include "engine/accelerators/crr_cru/joint_inertia.hpp"
#include "engine/accelerators/crr_cru/limb_inertia.hpp"
#include "engine/dynamics/coupling.hpp"
#include "engine/geometry/singular.hpp"

namespace pkm::crr_cru {

/// What all poses of one phi have in common. NaN, and with it M_q in every row, where J, which depends on phi alone, is
/// singular to working precision.
template <class S>
struct InertiaFrame : SlideFrame<S> {
  std::array<Vector3<S>, 4> arm;  ///< C_i - D
};

template <class S>
InertiaFrame<S> inertia_frame(const Geometry<S>& g, const Masses<S>& b, const S& phi) {
  const auto [sin, cos] = sincos(phi);
  const auto arm = arms(g, sin, cos);
  std::array<Vector<S, 3>, 4> turn;
  for (std::size_t i = 0; i < 4; ++i) turn[i] = turning(arm[i]);
  const S j1 = turn[0][0], j2 = turn[1][1], j4 = turn[3][1];
  const Matrix<double, 3, 3> J = {
      {1, 0, value_of(j1), 0, 1, value_of(j2), 0, 1, value_of(j4)}};  // of x, y, phi; z stands alone
  const S w = is_singular(J) ? S(std::numeric_limits<double>::quiet_NaN()) : S(S(1.0) / (j4 - j2));
  const Vector<S, 4> X = {{j1 * w * -1.0, j2 * w * -1.0, S(0.0), w}};  // per rho_4 rate

  Matrix<S, 4, 4> M = platform_inertia(g, b, sin, cos);
  InertiaFrame<S> f;
  f.rotors = b.rotors;
  for (std::size_t i = 0; i < 4; ++i) {
    const LimbFrame& limb = kLimbs[i];
    f.arm[i] = arm[i].to_joint;
    f.per_slide[i] = {X[limb.p] + turn[i][limb.p] * w, X[limb.q] + turn[i][limb.q] * w};
    add_at_joint(limb, {}, rail_mass(b, i), turn[i], M);
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

/// M_q at a feasible position [kg].
template <class S>
Matrix<S, 4, 4> joint_inertia(const Geometry<S>& g, const Masses<S>& b, const InertiaFrame<S>& f, const Vector3<S>& at,
                              const WorkingMode& mode) {
  std::array<PlaneInertia<S>, 4> share;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3<S> C = {at[0] + f.arm[i][0], at[1] + f.arm[i][1], at[2] + f.arm[i][2]};
    share[i] = plane_inertia(g, b, i, limb_at(g, i, C, mode[i]));
  }
  return matrix_of(joint_inertia(f, share[0], share[1], share[2], share[3]));
}

}  // namespace pkm::crr_cru
