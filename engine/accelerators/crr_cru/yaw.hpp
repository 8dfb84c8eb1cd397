// (3CRR/R)&CRU and Quadrupteron: quantities that depend on the yaw alone: Jacobian, parallel singularity, conditioning.
// Derivation: README.md, "The yaw".
#pragma once

#include "engine/accelerators/crr_cru/model.hpp"
#include "engine/geometry/conditioning.hpp"

namespace pkm::crr_cru {

/// Coefficients of the equation rho_4 - rho_2 = a_s sin phi + a_c cos phi + a_0, which determines phi.
template <class S>
struct Yaw {
  S a_s, a_c, a_0;  ///< coefficients of rho_4 - rho_2 = a_s sin phi + a_c cos phi + a_0 [m]
  S R;              ///< amplitude of a_s sin(phi) + a_c cos(phi): hypot(a_s, a_c) [m]
};

template <class S>
Yaw<S> yaw(const Geometry<S>& g) {
  const S along = g.r * g.cos_beta[1], across = g.r * g.sin_beta[1];
  if (g.platform == Platform::jointed) return {g.l, S(0.0), -across, g.l};
  const S a_s = g.l - along;
  return {a_s, -across, S(0.0), sqrt_or_zero(S(a_s * a_s + across * across))};
}

/// The angle delta, in (-pi, pi], in the loop-closure equation rho_4 - rho_2 = R sin(phi + delta) + a_0.
template <class S>
S offset(const Yaw<S>& y) {
  return atan2(y.a_c, y.a_s);
}

/// kappa_p = det J / R = cos(phi + delta), in [-1, 1]. It is 0 at a parallel singularity and positive on the nominal
/// branch.
template <class S>
S parallel_index(const Yaw<S>& y, const S& sin_phi, const S& cos_phi) {
  return (y.a_s * cos_phi - y.a_c * sin_phi) / y.R;
}

/// Default characteristic length, by which the column of J for phi is divided: l or, with Platform::rigid, l + r [m].
template <class S>
S characteristic_length(const Geometry<S>& g) {
  return g.platform == Platform::jointed ? g.l : S(g.l + g.r);
}

/// Inverse condition number of the Jacobian J with its column for phi divided by `length` [m]. J consists of two
/// blocks: the element for z with the singular value 1, and a 3 x 3 matrix for x, y, phi.
template <class S>
S conditioning(const std::array<Arm<S>, 4>& arm, const S& length) {
  const S one(1.0), zero(0.0);
  const S turn_1 = yaw_velocity(arm[0])[0] / length, turn_2 = yaw_velocity(arm[1])[1] / length;
  return inverse_condition(
      Rows3<S>{{{one, zero, turn_1}, {zero, one, turn_2}, {zero, one, arm[3].to_joint[0] / length}}}, one);
}

}  // namespace pkm::crr_cru
