// (3CRR/R)&CRU and Quadrupteron: the inertia of limbs and platforms as it is felt at the joints C_i (README.md).
//
// Source: as model.hpp, sections 2.2 to 3.1 with their errata; the limb-wise form follows from virtual work.
#pragma once

#include "engine/accelerators/crr_cru/joint_inertia.hpp"
#include "engine/accelerators/crr_cru/masses.hpp"
#include "engine/accelerators/crr_cru/yaw.hpp"

namespace pkm::crr_cru {

/// A limb's share of the inertia at its joint, in world axes: its plane's lower axis, both, the higher one [kg]. None
/// where rounding has put a sample just outside the reach.
template <class S>
PlaneInertia<S> plane_inertia(const Geometry<S>& g, const Masses<S>& b, std::size_t i, const Limb<S>& limb) {
  if (!limb.reaches) return {};
  const S &l1 = g.l_1[i], &l2 = g.l_2[i];
  const S sin2 = limb.sin_2 * limb.sin_2;
  const S A = (b.m_1[i] * 0.25 + b.m_2[i] + b.I_1[i] / (l1 * l1)) / sin2;
  const S B = b.m_2[i] * 0.5 * limb.cos_2 / sin2;
  const S C = (b.m_2[i] * 0.25 + b.I_2[i] / (l2 * l2)) / sin2;
  const double sign = kLimbs[i].p_sign * kLimbs[i].q_sign;
  const auto& u = limb.u1;
  const auto& v = limb.u2;
  return {A * v[0] * v[0] - B * 2.0 * (u[0] * v[0]) + C * u[0] * u[0],
          (A * v[0] * v[1] - B * (u[0] * v[1] + u[1] * v[0]) + C * u[0] * u[1]) * sign,
          A * v[1] * v[1] - B * 2.0 * (u[1] * v[1]) + C * u[1] * u[1]};
}

/// What moves along a limb's rail [kg].
template <class S>
S rail_mass(const Masses<S>& b, std::size_t i) {
  return b.m_1[i] + b.m_2[i] + b.slide;
}

/// Adds J_C^T A J_C, J_C = [1 | turning], to M_X, where A is a limb's share in space: in its plane, and what moves
/// along its rail.
template <class S>
void add_at_joint(const LimbFrame& f, const PlaneInertia<S>& share, const S& along, const Vector<S, 3>& turning,
                  Matrix<S, 4, 4>& M) {
  Matrix<S, 3, 3> at;
  at(f.p, f.p) = share.pp;
  at(f.q, f.q) = share.qq;
  at(f.p, f.q) = at(f.q, f.p) = share.pq;
  at(f.e, f.e) = along;
  const Vector<S, 3> column = at * turning;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) M(r, c) += at(r, c);
    M(r, 3) += column[r];
    M(3, r) += column[r];
  }
  M(3, 3) += dot(turning, column);
}

/// A point mass that moves with D and an arm of length `at` along D-C_4 [m]: on the moving platform.
template <class S>
void add_on_arm(const S& mass, const S& at, const S& sin_phi, const S& cos_phi, Matrix<S, 4, 4>& M) {
  for (std::size_t k = 0; k < 3; ++k) M(k, k) += mass;
  const S x = mass * at * sin_phi * -1.0, y = mass * at * cos_phi;
  M(0, 3) += x;
  M(3, 0) += x;
  M(1, 3) += y;
  M(3, 1) += y;
  M(3, 3) += mass * at * at;
}

/// Platforms' and payload's share of M_X: depends on phi alone.
template <class S>
Matrix<S, 4, 4> platform_inertia(const Geometry<S>& g, const Masses<S>& b, const S& sin_phi, const S& cos_phi) {
  Matrix<S, 4, 4> M;
  for (std::size_t k = 0; k < 3; ++k) M(k, k) += b.m_middle;
  if (g.platform == Platform::rigid) M(3, 3) += b.I_middle;
  add_on_arm(b.m, b.c, sin_phi, cos_phi, M);
  M(3, 3) += b.I_zz;
  add_on_arm(b.payload, b.c_payload, sin_phi, cos_phi, M);
  return M;
}

}  // namespace pkm::crr_cru
