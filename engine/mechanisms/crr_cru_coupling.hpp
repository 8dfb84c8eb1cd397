// (3CRR/R)&CRU and Quadrupteron: joint-space inertia at many poses of one phi.
//
// M_q = J^-T M_X J^-1 needs no matrix algebra at a pose. With j_i the entries of J's last column and w = 1/(j_4 - j_2),
// slide 4 alone turns the platform by w and shifts it by (-j_1 w, -j_2 w, 0); slide 2 alone moves it by e_y less that;
// slides 1 and 3 move it along x and z. So with s_i the velocity of C_i per rho_4 rate, A the sum of the limbs'
// inertias at their joints, v that of A_i s_i and k that of s_i^T A_i s_i, platforms included,
//
//          | A_xx  A_xy - v_x             A_xz          v_x     |
//    M_q = |       A_yy - 2 v_y + k       A_yz - v_z    v_y - k |
//          |                              A_zz          v_z     |
//          |  symmetric                                 k       |
//
// A limb's share A_i depends on its two plane coordinates and is the same for all poses that share them: a voxel survey
// keeps it in tables, so that a pose costs sums.
#pragma once

#include "engine/dynamics/coupling.hpp"
#include "engine/mechanisms/crr_cru_dynamics.hpp"

namespace pkm::crr_cru {

/// What all poses of one phi have in common.
template <class S>
struct InertiaFrame {
  std::array<Vector3<S>, 4> arm;              ///< C_i - D
  std::array<std::array<S, 2>, 4> per_slide;  ///< s_i in the limb's plane, along the lower and the higher world axis
  // platforms, and what slides along the rails
  S xx, yy, zz, vx, vy, vz, k;
};

template <class S>
InertiaFrame<S> inertia_frame(const Geometry<S>& g, const Masses<S>& b, const S& phi) {
  const auto [sin, cos] = sincos(phi);
  const auto arm = arms(g, sin, cos);
  std::array<Vector<S, 3>, 4> turn;
  for (std::size_t i = 0; i < 4; ++i) turn[i] = turning(arm[i]);
  const S j1 = turn[0][0], j2 = turn[1][1], j4 = turn[3][1];
  const S w = S(1.0) / (j4 - j2);
  const Vector<S, 4> X = {{j1 * w * -1.0, j2 * w * -1.0, S(0.0), w}};  // per rho_4 rate

  Matrix<S, 4, 4> M = platform_inertia(g, b, sin, cos);
  InertiaFrame<S> f;
  for (std::size_t i = 0; i < 4; ++i) {
    const LimbFrame& limb = kLimbs[i];
    f.arm[i] = arm[i].to_joint;
    f.per_slide[i] = {X[limb.p] + turn[i][limb.p] * w, X[limb.q] + turn[i][limb.q] * w};
    Matrix<S, 3, 3> rail;
    rail(limb.e, limb.e) = rail_mass(b, i);
    add_at_joint(rail, turn[i], M);
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

/// A limb's inertia at its joint in world axes: its plane's lower axis, both, the higher one [kg].
template <class S>
PlaneInertia<S> limb_share(const Geometry<S>& g, const Masses<S>& b, std::size_t i, const Limb<S>& limb) {
  PlaneInertia<S> share = plane_inertia(g, b, i, limb);
  share.pq = share.pq * (kLimbs[i].p_sign * kLimbs[i].q_sign);
  return share;
}

/// M_q from the limbs' shares [kg].
template <class S>
Matrix<S, 4, 4> joint_inertia(const InertiaFrame<S>& f, const PlaneInertia<S>& l1, const PlaneInertia<S>& l2,
                              const PlaneInertia<S>& l3, const PlaneInertia<S>& l4) {
  const auto along = [&f](std::size_t i, const PlaneInertia<S>& l) {  // A_i s_i
    const auto& s = f.per_slide[i];
    return std::array<S, 2>{l.pp * s[0] + l.pq * s[1], l.pq * s[0] + l.qq * s[1]};
  };
  const std::array<S, 2> v1 = along(0, l1), v2 = along(1, l2), v3 = along(2, l3), v4 = along(3, l4);
  const S vx = f.vx + (v2[0] + v3[0] + v4[0]), vy = f.vy + (v1[0] + v3[1]), vz = f.vz + (v1[1] + v2[1] + v4[1]);
  const auto twice = [&f](std::size_t i, const std::array<S, 2>& v) {
    return S(f.per_slide[i][0] * v[0] + f.per_slide[i][1] * v[1]);
  };
  const S k = f.k + ((twice(0, v1) + twice(1, v2)) + (twice(2, v3) + twice(3, v4)));
  Matrix<S, 4, 4> M;
  M(0, 0) = f.xx + (l2.pp + l3.pp + l4.pp);
  M(1, 1) = f.yy + (l1.pp + l3.qq) - vy * 2.0 + k;
  M(2, 2) = f.zz + (l1.qq + l2.qq + l4.qq);
  M(3, 3) = k;
  M(0, 1) = M(1, 0) = l3.pq - vx;
  M(0, 2) = M(2, 0) = l2.pq + l4.pq;
  M(0, 3) = M(3, 0) = vx;
  M(1, 2) = M(2, 1) = l1.pq - vz;
  M(1, 3) = M(3, 1) = vy - k;
  M(2, 3) = M(3, 2) = vz;
  return M;
}

/// M_q at a feasible position [kg].
template <class S>
Matrix<S, 4, 4> joint_inertia(const Geometry<S>& g, const Masses<S>& b, const InertiaFrame<S>& f, const Vector3<S>& at,
                              const WorkingMode& mode) {
  std::array<PlaneInertia<S>, 4> share;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3<S> C = {at[0] + f.arm[i][0], at[1] + f.arm[i][1], at[2] + f.arm[i][2]};
    share[i] = limb_share(g, b, i, limb_at(g, i, C, mode[i]));
  }
  return joint_inertia(f, share[0], share[1], share[2], share[3]);
}

}  // namespace pkm::crr_cru
