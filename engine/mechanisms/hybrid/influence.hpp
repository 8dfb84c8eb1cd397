// Hybrid robot: first- and second-order influence coefficients, and the indices of quality made of them.
//
// All of them are infinite where n1, n2, n3 is 0. Equations: README.md.
#pragma once

#include "engine/mechanisms/hybrid/limits.hpp"
#include "engine/model/conditioning.hpp"
#include "engine/model/influence.hpp"

namespace pkm::hybrid {

template <class S>
using Influence = pkm::Influence<S, 4>;

/// Jx and Jq = diag(n1, 1, n2, n3).
template <class S>
struct VelocityEquation {
  Matrix<S, 4, 4> Jx, Jq;
};

template <class S>
VelocityEquation<S> velocity_equation(const Pose<S>& pose, const Joints<S>& j) {
  const S zero(0.0), one(1.0), &z = pose.z;
  VelocityEquation<S> v;
  v.Jx = {{j.n1, zero, z, zero, zero, one, zero, zero, j.n2, zero, z, zero, j.n3, zero, j.N1, j.N2}};
  v.Jq = {{j.n1, zero, zero, zero, zero, one, zero, zero, zero, zero, j.n2, zero, zero, zero, zero, j.n3}};
  return v;
}

template <class S>
Influence<S> influence(const Geometry<S>& g, const Pose<S>& pose, const Joints<S>& j) {
  const auto [sin_b, cos_b] = sincos(pose.angle);
  const S &z = pose.z, zero(0.0), one(1.0);
  const S m1 = j.N1 / j.n3, m2 = j.N2 / j.n3;
  Influence<S> q;
  q.G = {{one, zero, z / j.n1, zero, zero, one, zero, zero, one, zero, z / j.n2, zero, one, zero, m1, m2}};
  q.H[0](2, 2) = g.L1 * g.L1 / (j.n1 * j.n1 * j.n1);
  q.H[2](2, 2) = g.L2 * g.L2 / (j.n2 * j.n2 * j.n2);
  q.H[3](2, 2) = (one + m1 * m1) / j.n3;
  q.H[3](2, 3) = q.H[3](3, 2) = (g.e * cos_b + m1 * m2) / j.n3;
  q.H[3](3, 3) = (g.e * (g.d * cos_b - z * sin_b) + m2 * m2) / j.n3;
  return q;
}

/// Least of the measures of transmission but the constraint's: LTI.
template <class S>
S local_transmission_index(const Transmission<S>& t) {
  return min(min(min(t.t[0], t.t[1]), t.t[2]), min(t.t_xz, magnitude(t.t_beta)));
}

}  // namespace pkm::hybrid
