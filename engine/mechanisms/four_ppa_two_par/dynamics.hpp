// 4PPa-2PaR: equations of motion, from the speeds of a few lengths per limb: README.md, Motion.
#pragma once

#include <optional>

#include "engine/dynamics/body.hpp"
#include "engine/mechanisms/four_ppa_two_par/masses.hpp"
#include "engine/model/influence.hpp"

namespace pkm::four_ppa_two_par {

template <class S>
using MotionState = pkm::MotionState<S, 4>;
template <class S>
using PoseDynamics = pkm::PoseDynamics<S, 4>;
template <class S>
using Body = pkm::Body<S, 4>;
template <class S>
using Influence = pkm::Influence<S, 4>;

/// A length or an angle that X determines: its rate is row Xdot, its acceleration row Xddot + bias.
template <class S>
struct Follower {
  Vector<S, 4> row;
  S rate{}, bias{};

  Follower operator*(const S& factor) const { return {row * factor, rate * factor, bias * factor}; }
  Follower operator+(const Follower& o) const { return {row + o.row, rate + o.rate, bias + o.bias}; }
  Follower operator-(const Follower& o) const { return {row - o.row, rate - o.rate, bias - o.bias}; }
  /// This rate over a length `l` that changes itself.
  Follower over(const S& l, const S& l_rate) const {
    return {row * (S(1.0) / l), rate / l, (bias - rate / l * l_rate) / l};
  }
};

/// What follows from r^2 = constant - l^2: r' = -(l / r) l'.
template <class S>
Follower<S> other_leg(const S& l, const Follower<S>& l_moves, const S& r) {
  const S slope = l / r * -1.0, rate = slope * l_moves.rate;
  return {l_moves.row * slope, rate, (l_moves.rate * l_moves.rate + l * l_moves.bias + rate * rate) / r * -1.0};
}

/// Motion of one limb.
template <class S>
struct LimbMotion {
  Follower<S> x, y, z_c, h;
  Follower<S> turn_upper;  ///< of the bars of the slider at y_j - h_j, about x
  Follower<S> turn_lower;  ///< about y
};

/// @param limb_sign  1 for limb 1, -1 for limb 2
/// @param sigma      of this limb, negative in the upper branch [m]
template <class S>
LimbMotion<S> limb_motion(const Geometry<S>& g, const MotionState<S>& state, const SinCosOf<S>& theta,
                          const Limbs<S>& limb, std::size_t j, const S& sigma) {
  const double side = j == 0 ? 1 : -1;
  const S turn = state.velocity[3], half = g.a * 0.5, zero(0.0), one(1.0);
  LimbMotion<S> m;
  m.x.row = {{S(side), zero, zero, half * theta.sin}};
  m.x.bias = half * theta.cos * turn * turn;
  m.y.row = {{zero, one, zero, half * theta.cos * -side}};
  m.y.bias = half * theta.sin * turn * turn * side;
  for (Follower<S>* follower : {&m.x, &m.y}) follower->rate = dot(follower->row, state.velocity);
  const Follower<S> z{{{zero, zero, one, zero}}, state.velocity[2], zero};
  const Follower<S> sigma_moves = other_leg(limb.x[j], m.x, sigma);
  m.z_c = z + sigma_moves;
  m.h = other_leg(limb.z_c[j], m.z_c, limb.h[j]);
  m.turn_upper = m.z_c.over(limb.h[j], m.h.rate);
  m.turn_lower = m.x.over(sigma, sigma_moves.rate) * S(-side);
  return m;
}

/// The sliders at y_j - h_j (side 0) and at y_j + h_j (side 1).
template <class S>
Follower<S> slider_motion(const LimbMotion<S>& m, std::size_t side) {
  return side == 0 ? m.y - m.h : m.y + m.h;
}

/// sigma_j with the sign that limb_motion takes.
template <class S>
S signed_sigma(const Limbs<S>& limbs, WorkingMode mode, std::size_t j) {
  return mode[j] == Branch::lower ? limbs.sigma[j] : S(limbs.sigma[j] * -1.0);
}

/// Influence coefficients of the sliders; absent where the pose does not assemble or they are infinite.
std::optional<Influence<double>> influence(const Geometry<double>& g, const Pose<double>& pose, WorkingMode mode);

/// A body by the velocity of its centre along the world's axes.
template <class S>
Body<S> body(const S& mass, const std::array<Follower<S>, 3>& centre) {
  Body<S> b;
  b.mass = mass;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 4; ++c) b.J_v(k, c) = centre[k].row[c];
    b.b_v[k] = centre[k].bias;
  }
  return b;
}

/// The same where it turns about one of the world's axes, a principal axis of it.
template <class S>
Body<S> turning_body(const S& mass, const std::array<Follower<S>, 3>& centre, std::size_t axis, const Follower<S>& turn,
                     const S& inertia) {
  Body<S> b = body(mass, centre);
  for (std::size_t c = 0; c < 4; ++c) b.J_omega(axis, c) = turn.row[c];
  b.b_omega[axis] = turn.bias;
  b.inertia(axis, axis) = inertia;
  return b;
}

/// The equations of motion at a pose and velocity. Infinite or NaN where J is (x_j = l_d, h_j = 0).
template <class S>
PoseDynamics<S> pose_dynamics(const Geometry<S>& g, const Masses<S>& b, const MotionState<S>& state, WorkingMode mode) {
  PoseDynamics<S> d;
  const Limbs<S> limbs = inverse(g, state.pose, mode);
  d.assembles = limbs.assembles;
  if (!d.assembles) return d;
  const SinCosOf<S> theta = sincos(state.pose.angle);
  const Vector<S, 4>& X = state.velocity;
  const S half(0.5), one(1.0), two(2.0);
  const Follower<S> still;
  std::array<Follower<S>, 4> along;  // of x, y, z, theta themselves
  for (std::size_t k = 0; k < 4; ++k) {
    along[k].row[k] = one;
    along[k].rate = X[k];
  }
  const auto add = [&](const Body<S>& moving) { add_body(d, moving, X); };
  for (std::size_t j = 0; j < 2; ++j) {
    const LimbMotion<S> m = limb_motion(g, state, theta, limbs, j, signed_sigma(limbs, mode, j));
    const Follower<S> x_d = m.x * S(j == 0 ? 1.0 : -1.0);
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t i = 2 * j + k;
      const Follower<S> q = slider_motion(m, k);
      d.q[i] = limbs.q[i];
      for (std::size_t c = 0; c < 4; ++c) d.J(i, c) = q.row[c];
      d.J_rate_X[i] = q.bias;
      add(body(b.slider, {still, q, still}));
      add(turning_body(S(b.upper_bar * two), {still, (q + m.y) * half, m.z_c * half}, 0,
                       m.turn_upper * S(k == 0 ? 1.0 : -1.0), S(b.I_upper * two)));
    }
    add(body(b.upper_connector, {still, m.y, m.z_c}));
    add(turning_body(S(b.lower_bar * two), {x_d * half, m.y, (m.z_c + along[2]) * half}, 1, m.turn_lower,
                     S(b.I_lower * two)));
    add(body(b.lower_connector, {x_d, m.y, along[2]}));
  }
  add(turning_body(b.platform, {along[0], along[1], along[2]}, 2, along[3], b.I_platform));
  // the payload's place on the platform turns with it
  Follower<S> payload_x = along[0] - along[3] * S(b.c_payload * theta.sin),
              payload_y = along[1] + along[3] * S(b.c_payload * theta.cos);
  payload_x.bias = b.c_payload * theta.cos * X[3] * X[3] * -1.0;
  payload_y.bias = b.c_payload * theta.sin * X[3] * X[3] * -1.0;
  add(body(b.payload, {payload_x, payload_y, along[2]}));
  for (std::size_t k = 0; k < 3; ++k) d.J_wrench(k, k) = one;
  d.J_wrench(5, 3) = one;
  return d;
}

}  // namespace pkm::four_ppa_two_par
