// (3CRR/R)&CRU and Quadrupteron: equations of motion, limb by limb (README.md).
//
// Source: as model.hpp, sections 2.2 to 3.1 with their errata; the limb-wise form follows from virtual work.
#pragma once

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/mechanisms/crr_cru/joint_inertia.hpp"
#include "engine/mechanisms/crr_cru/masses.hpp"
#include "engine/mechanisms/crr_cru/yaw.hpp"

namespace pkm::crr_cru {

template <class S>
using MotionState = pkm::MotionState<S, 4>;
template <class S>
using PoseDynamics = pkm::PoseDynamics<S, 4>;

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

/// The equations of motion at a pose and velocity. Infinite where a limb is stretched or folded (sin theta_2 = 0).
template <class S>
PoseDynamics<S> pose_dynamics(const Geometry<S>& g, const Masses<S>& b, const MotionState<S>& state,
                              const WorkingMode& mode) {
  PoseDynamics<S> d;
  const auto [s, c] = sincos(state.pose.angle);
  const Limbs<S> limbs = inverse(g, state.pose, mode);
  d.assembles = limbs.assembles;
  if (!d.assembles) return d;
  const Vector<S, 4>& X = state.velocity;
  const S turn2 = X[3] * X[3];
  d.J = Matrix<S, 4, 4>();
  d.M_X = platform_inertia(g, b, s, c);
  for (std::size_t i = 0; i < 4; ++i) {
    const LimbFrame& f = kLimbs[i];
    const Limb<S>& limb = limbs.limb[i];
    const Vector<S, 3> t = turning(limbs.arm[i]), swing = swinging(limbs.arm[i]);
    d.q[i] = limb.rho;
    d.J(i, f.e) = S(1.0);
    d.J(i, 3) = t[f.e];
    // at rest in X, C_i is still accelerated towards the arm's centre
    Vector<S, 3> v, a;
    for (std::size_t k = 0; k < 3; ++k) {
      v[k] = X[k] + t[k] * X[3];
      a[k] = swing[k] * turn2;
    }
    d.J_rate_X[i] = a[f.e];
    const S along = rail_mass(b, i);
    add_at_joint(f, plane_inertia(g, b, i, limb), along, t, d.M_X);

    // forces that the rods need in the plane at C_i: by rates alone, and by weight alone
    const RodRates<S> rate = rod_rates(g, i, limb, v.m, a.m);
    const S &l1 = g.l_1[i], &l2 = g.l_2[i], &m1 = b.m_1[i], &m2 = b.m_2[i];
    const Vector<S, 2> n1 = across(limb.u1), n2 = across(limb.u2),
                       weight = in_plane<S>(f, {S(0.0), S(0.0), S(kGravity)});
    const S square1 = rate.velocity[0] * rate.velocity[0], square2 = rate.velocity[1] * rate.velocity[1];
    const Vector<S, 2> a2 = (n1 * rate.acceleration[0] - limb.u1 * square1) * l1 +  // of the outer rod's centre
                            (n2 * rate.acceleration[1] - limb.u2 * square2) * (l2 * 0.5);
    const S Q1 = (m1 * 0.25 * l1 * l1 + b.I_1[i]) * rate.acceleration[0] + m2 * l1 * dot(n1, a2);
    const S Q2 = b.I_2[i] * rate.acceleration[1] + m2 * 0.5 * l2 * dot(n2, a2);
    const S W1 = (m1 * 0.5 + m2) * l1 * dot(n1, weight), W2 = m2 * 0.5 * l2 * dot(n2, weight);
    const auto at_C = [&](const S& turn1, const S& turn2_, const S& rail) {  // j1^T turn1 + j2^T turn2, in space
      const S x = turn1 / (l1 * limb.sin_2), y = turn2_ / (l2 * limb.sin_2) * -1.0;
      return in_space(f, Vector<S, 2>(limb.u2 * x + limb.u1 * y), rail);
    };
    const auto add = [&](Vector<S, 4>& sum, const Vector<S, 3>& force) {
      for (std::size_t k = 0; k < 3; ++k) sum[k] += force[k];
      sum[3] += dot(t, force);
    };
    add(d.h_X, at_C(Q1, Q2, S(along * a[f.e])));
    add(d.G_X, at_C(W1, W2, S(along * (f.e == 2 ? kGravity : 0.0))));
  }
  // platforms: the centre on the arm is accelerated towards D
  const S arm = b.m * b.c + b.payload * b.c_payload;
  d.h_X[0] = d.h_X[0] - arm * c * turn2;
  d.h_X[1] = d.h_X[1] - arm * s * turn2;
  d.G_X[2] += (b.m + b.m_middle + b.payload) * kGravity;
  for (std::size_t k = 0; k < 3; ++k) d.J_wrench(k, k) = S(1.0);
  d.J_wrench(0, 3) = b.c * s * -1.0;
  d.J_wrench(1, 3) = b.c * c;
  d.J_wrench(5, 3) = S(1.0);
  return d;
}

}  // namespace pkm::crr_cru
