// (3CRR/R)&CRU and Quadrupteron: inertia of the limbs at the platform joints C_i, and of the platforms (README.md).
//
// Source: the paper cited in model.hpp, sections 2.2 to 3.1 with their errata. The sum over the limbs that is used here
// follows from the principle of virtual work.
#pragma once

#include "engine/accelerators/crr_cru/joint_inertia.hpp"
#include "engine/accelerators/crr_cru/masses.hpp"
#include "engine/accelerators/crr_cru/yaw.hpp"

namespace pkm::crr_cru {

/// Inertia of the rods of a limb, reduced to its platform joint C_i. It is 0 if C_i is out of reach, which can happen
/// by rounding.
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

/// Adds the mass that moves with the slide of a limb to the inertia matrix M_X of the coordinates.
/// @param by_phi  velocity of C_i along the rail, divided by the rate of phi [m]
template <class S>
void add_on_rail(std::size_t e, const S& mass, const S& by_phi, Matrix<S, 4, 4>& M) {
  const S moment = mass * by_phi;
  M(e, e) += mass;
  M(e, 3) += moment;
  M(3, e) += moment;
  M(3, 3) += by_phi * moment;
}

/// Adds a point mass that is fixed to the moving platform to the inertia matrix M_X of the coordinates.
/// @param at  distance of the point mass from D along the line from D to C_4 [m]
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

/// The inertia M_X of the platforms and of the payload, which depends on phi alone.
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
