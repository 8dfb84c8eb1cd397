// Hybrid robot: the auxiliary R-U-P-U-R chain that turns the tool. Equations: README.md.
#pragma once

#include "engine/mechanisms/hybrid/model.hpp"
#include "engine/model/capsule.hpp"
#include "engine/model/chain.hpp"
#include "engine/motion/motion.hpp"

namespace pkm::hybrid {

template <class S>
struct Shaft {
  Point3<S> F1, F3;  ///< its universal joints, in O' [m]
  Point3<S> w;       ///< F3 - F1 [m]
  S length;          ///< |w| [m]
  S P, Q, T;         ///< [m]
  S cos_phi1, cos_phi2;
};

/// @param g  of the same scalar, or of numbers
template <class G, class S>
[[gnu::always_inline]] inline Shaft<S> shaft(const Geometry<G>& g, const Pose<S>& pose) {
  const auto [sin_b, cos_b] = sincos(pose.angle);
  const S &x = pose.x, &z = pose.z, zero(0.0);
  Shaft<S> s;
  s.F1 = {zero, g.f, g.h1};
  s.F3 = {x, g.fp * cos_b + g.h2 * sin_b, z + g.fp * sin_b - g.h2 * cos_b};
  s.w = difference(s.F3, s.F1);
  s.length = root_or_zero(dot(s.w, s.w));
  s.Q = s.w[2];
  s.P = (z - g.h1) * cos_b + g.f * sin_b - g.h2;
  s.T = x * sin_b;
  const bool point = !(value_of(s.length) > 0);  // F1 = F3: no axis, as if bent by a right angle
  s.cos_phi1 = point ? zero : S(s.Q / s.length);
  s.cos_phi2 = point ? zero : S(s.P / s.length);
  return s;
}
/// The matrix that takes (sin t, cos t) to (S, C), its sign such that its determinant's root is positive.
template <class S>
struct Forks {
  S ss, sc, cs, cc;    ///< rows S, C [m]
  S PQ;                ///< determinant [m^2]
  bool turns = false;  ///< there is a gamma
};

/// @param zeta  phase of the forks at the two ends of the telescopic shaft [rad]
template <class S>
Forks<S> forks(const Shaft<S>& s, const S& beta, double zeta) {
  const auto [sin_b, cos_b] = sincos(beta);
  const S PQ = s.P * s.Q;
  const bool bent = !(value_of(PQ) > 0);
  const bool mirrored = value_of(s.Q) < 0;
  if (bent || (mirrored && zeta != 0)) return {.PQ = PQ};
  const S &x = s.w[0], &wy = s.w[1], &wz = s.w[2];
  const double sign = mirrored ? -1 : 1;
  const auto [sin, cos] = sincos(zeta);
  const double by_sin = sign * sin, by_cos = sign * cos;
  const S M = wy * cos_b + wz * sin_b;
  return {.ss = s.P * by_cos + x * M / s.length * by_sin,
          .sc = s.T * -by_cos + (s.length * cos_b - wy * M / s.length) * by_sin,
          .cs = (wy * wy + wz * wz) / s.length * -by_sin,
          .cc = s.Q * by_cos - x * wy / s.length * by_sin,
          .PQ = PQ,
          .turns = true};
}

/// Output angle [rad] for an input angle; only where the forks turn.
template <class G, class S>
S output_angle(const Geometry<G>& g, const Forks<S>& k, const S& theta) {
  const S t = theta + g.theta0;
  const auto [sin_t, cos_t] = sincos(t);
  return theta + wrapped(S(atan2(S(k.ss * sin_t + k.sc * cos_t), S(k.cs * sin_t + k.cc * cos_t)) - t));
}

/// Input angle [rad] for an output angle: the inverse of output_angle.
template <class S>
S input_angle(const Geometry<S>& g, const Forks<S>& k, const S& gamma) {
  const S out = gamma + g.theta0;
  const auto [sin_g, cos_g] = sincos(out);
  return gamma + wrapped(S(atan2(S(k.cc * sin_g - k.sc * cos_g), S(k.ss * cos_g - k.cs * sin_g)) - out));
}

/// Extremes of d gamma/d theta over a turn: P Q / sigma^2 with the singular values sigma of the matrix.
template <class S>
struct Ratio {
  S least, greatest;
};

template <class S>
Ratio<S> ratio(const Forks<S>& k) {
  // sigma_1^2 + sigma_2^2 -/+ 2 P Q as sums of squares, so that equal ones lose no digits
  const S minus_1 = k.ss - k.cc, minus_2 = k.sc + k.cs, plus_1 = k.ss + k.cc, plus_2 = k.sc - k.cs;
  const S apart = minus_1 * minus_1 + minus_2 * minus_2, together = plus_1 * plus_1 + plus_2 * plus_2;
  const S sum = k.ss * k.ss + k.sc * k.sc + k.cs * k.cs + k.cc * k.cc;
  const S greatest = (sum + root_or_zero(S(apart * together))) * 0.5 / k.PQ;
  return {S(1.0) / greatest, greatest};
}

/// The chain while the platform and its input move.
/// @param zeta  phase of the forks [rad]
ChainReport inspect_chain(const Geometry<double>& g, const MotionSample& at, double zeta);

}  // namespace pkm::hybrid
