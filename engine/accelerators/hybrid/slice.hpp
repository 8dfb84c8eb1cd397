// Hybrid robot: the feasible (x, z) of one working mode at given beta, a planar slice: the limits of limits.hpp, solved
// for z and x.
//
// z is in one interval [max of lower bounds, min of upper bounds]. For each z, x is between the maximum of its lower
// and the minimum of its upper bounds, except for a hole. The bounds of x are the curves in Slice::curve. Derivation:
// README.md.
#pragma once

#include <cstdint>

#include "engine/accelerators/hybrid/limits.hpp"
#include "engine/math/dual.hpp"

namespace pkm::hybrid {

/// A design with its limits and its working mode, and quantities that are the same for all its slices.
template <class S>
struct SlicedDesign {
  Geometry<S> g;
  Limits<S> l;
  WorkingMode signs;
  int branch;               ///< required sign (+1 or -1) of the term N2 of the loop-closure equations (README.md)
  std::array<S, 3> lo, hi;  ///< s_min and s_max of limbs A, B, C, plus the offsets of their carriages [m]
  S sine_s, cot_c;          ///< sqrt(1 - tau_s^2), sqrt(1 - tau_c^2) / tau_c
  S tan_phi, cot_phi;
  S z_low, z_high;    ///< range of z allowed by the limits that depend on z only [m]
  bool empty = true;  ///< true if the range of z is empty, or if the required sign of N2 is -1
};

/// Computes the members z_low, z_high and empty.
template <class S>
void find_heights(SlicedDesign<S>& d) {
  const Geometry<S>& g = d.g;
  const Limits<S>& l = d.l;
  d.z_low = max(l.z_clear, max(S(g.L1 * l.psiA.cos), S(g.L2 * l.psiA.cos)));
  d.z_high = min(g.L1, g.L2) * d.sine_s;
  std::array<S, 5> values = {d.z_low, d.z_high};  // the values of z at which a limit becomes active
  std::size_t n = 2;
  const auto add = [&](const S& z) {  // inserts z in ascending order
    if (!(value_of(z) > value_of(d.z_low) && value_of(z) < value_of(d.z_high))) return;
    std::size_t i = n++;
    for (; value_of(values[i - 1]) > value_of(z); --i) values[i] = values[i - 1];
    values[i] = z;
  };
  const S sum = g.L1 * g.L1 + g.L2 * g.L2, product = g.L1 * g.L2;
  const S cosine = sqrt_or_zero(S((1.0 - l.tau_p) * (1.0 + l.tau_p)));
  for (const double sign : {-1.0, 1.0}) {  // here the sine of the angle between links A and B equals tau_p
    const S base2 = sum + product * cosine * (2 * sign);
    if (value_of(base2) > 0) add(l.tau_p * product / sqrt(base2));
  }
  const S apart = l.gap - g.a * 2.0;  // n1 - n2 where carriages A and B have their minimum distance
  if (value_of(apart) != 0) {
    const S n1 = (apart + (g.L1 - g.L2) * (g.L1 + g.L2) / apart) * 0.5;
    add(sqrt_or_zero(S((g.L1 - n1) * (g.L1 + n1))));
  }
  const auto holds = [&](double z) {
    const auto along = [&](const S& L, int sign) { return sign * sqrt_or_zero((value_of(L) - z) * (value_of(L) + z)); };
    const double n1 = along(g.L1, d.signs[0]), n2 = along(g.L2, d.signs[1]);
    return z * std::fabs(n1 - n2) >= value_of(l.tau_p) * value_of(product) && n1 - n2 >= value_of(apart);
  };
  d.empty = true;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    if (!(value_of(values[i]) < value_of(values[i + 1]))) continue;
    if (!holds(0.5 * (value_of(values[i]) + value_of(values[i + 1])))) continue;
    if (d.empty) d.z_low = values[i];
    d.z_high = values[i + 1];
    d.empty = false;
  }
}

template <class S>
SlicedDesign<S> sliced_design(const Geometry<S>& g, const Limits<S>& l, const WorkingMode& signs, int branch) {
  const std::array<S, 3> offset = {g.a - g.b1, g.b2 - g.a, g.c};
  const auto cosine_of = [](const S& sine) { return sqrt_or_zero(S((1.0 - sine) * (1.0 + sine))); };
  SlicedDesign<S> d{.g = g,
                    .l = l,
                    .signs = signs,
                    .branch = branch,
                    .sine_s = cosine_of(l.tau_s),
                    .cot_c = cosine_of(l.tau_c) / l.tau_c,
                    .tan_phi = l.phi.sin / l.phi.cos,
                    .cot_phi = l.phi.cos / l.phi.sin};
  for (std::size_t i = 0; i < 3; ++i) {
    d.lo[i] = l.s_min[kDriveOfLimb[i]] + offset[i];
    d.hi[i] = l.s_max[kDriveOfLimb[i]] + offset[i];
  }
  if (branch > 0) find_heights(d);
  return d;
}

/// Indices of the curves that bound x, in the order of Slice::curve.
enum CurveIndex { kCurveA, kCurveB, kCurveC, kCurveQ, kCurveP, kCurveL, kCurveH, kCurves };

/// The square root of a product of two linear functions of z; a bound of x is a constant plus or minus such a root.
template <class S>
struct Curve : Product<S> {
  using Product<S>::a, Product<S>::a_z, Product<S>::b, Product<S>::b_z;

  S root(const S& z) const { return sqrt_or_zero(S((a + a_z * z) * (b + b_z * z))); }
  S curvature() const { return a_z * b_z; }  ///< coefficient of z^2 under the root
  /// Derivative of the root with respect to z.
  /// @param root  value of the root at z
  S derivative(const S& z, const S& root) const { return (a_z * (b + b_z * z) + b_z * (a + a_z * z)) / (root * 2.0); }
};

/// Which side of the feasible x an edge bounds: kLeft is a lower bound, kRight an upper one.
enum Side : std::uint8_t { kLeft, kRight };
inline constexpr std::size_t kSides = 2;

/// A bound of x as a function of z: a curve of the slice, as a lower or an upper bound.
struct Edge {
  std::uint8_t curve = 0;
  Side side = kLeft;
  bool operator==(const Edge&) const = default;
};

inline constexpr std::size_t kLowerEnds = 9, kUpperEnds = 9;  ///< number of lower and number of upper bounds of z
/// Indices of those bounds of z at which the square root of a curve vanishes: two for P, one (upper) for L, one (lower)
/// for Q.
inline constexpr std::size_t kEndP1 = 2, kEndP2 = 3, kEndL = 7, kEndQ = 8;

template <class S>
struct Slice {
  std::array<Curve<S>, kCurves> curve;
  /// Sign of the square root in each bound of x, by side and curve: the bound is constants[side][curve] + sign * root
  /// of the curve.
  std::array<std::array<double, kCurves>, kSides> signs;
  /// Constant term of each bound of x [m], by side and curve.
  std::array<std::array<S, kCurves>, kSides> constants;
  std::array<S, kLowerEnds> lower;  ///< lower bounds of z [m]; inactive ones have values below all z in reach
  std::array<S, kUpperEnds> upper;
  S hole_end;  ///< maximum z at which the feasible x has a hole
  /// Coefficients of curves Q, P, L, H: the square of x is ((m + m_z z) / cos(phi_max))^2 minus a common term.
  std::array<double, 4> m, m_z;

  double sign(const Edge& e) const { return signs[e.side][e.curve]; }
  const S& constant(const Edge& e) const { return constants[e.side][e.curve]; }
};

template <class S>
Slice<S> slice(const SlicedDesign<S>& d, const S& beta) {
  const Geometry<S>& g = d.g;
  const Limits<S>& l = d.l;
  const S none(-1.0), all(1e4), zero(0.0), one(1.0);  // none and all: bounds below and above all z in reach
  const auto [sin_b, cos_b] = sincos(beta);
  const S lift = g.e * sin_b;                          // N1 = z + lift
  const S width = (g.d - g.e * cos_b) * home_side(g);  // D; < 0 beyond the constraint singularity
  const S reach2 = (g.L3 - width) * (g.L3 + width);    // n3^2 + N1^2
  const S Q0 = g.fp * sin_b - g.h2 * cos_b - g.h1, w_y = g.fp * cos_b + g.h2 * sin_b - g.f;
  const S P0 = g.f * sin_b - g.h1 * cos_b - g.h2, v_0 = g.fp - g.f * cos_b - g.h1 * sin_b;  // w''_y = v_0 + z sin b
  const S& t = d.tan_phi;
  const bool beyond = value_of(width) < 0;
  Slice<S> s;

  // Sets bound number i of z from the inequality factor * z >= right, which is a lower or an upper bound, depending on
  // the sign of the factor.
  const auto set = [&](std::size_t i, const S& factor, const S& right) {
    const double sign = value_of(factor);
    s.lower[i] = sign > 0 ? S(right / factor) : value_of(right) > 0 && sign == 0 ? all : none;
    s.upper[i] = sign < 0 ? S(right / factor) : all;
  };
  const S mu_sin = l.mu.sin * cos_b, mu_cos = l.mu.cos * sin_b, middle = (g.d * cos_b - g.e) * l.mu.cos;
  const S d_sin = g.d * sin_b * l.mu.sin;
  set(0, S(mu_sin + mu_cos), S(middle - d_sin));
  set(1, S(mu_sin - mu_cos), S(-middle - d_sin));
  set(kEndP1, S(t * cos_b - sin_b), S(v_0 - t * P0));
  set(kEndP2, S(t * cos_b + sin_b), S(-v_0 - t * P0));
  s.lower[4] = d.z_low;
  s.upper[4] = d.z_high;
  const S far2 = reach2 - l.tau_s * l.tau_s * g.L3 * g.L3, near2 = reach2 - l.psiC.sin * l.psiC.sin * g.L3 * g.L3;
  s.lower[5] = value_of(near2) > 0 ? S(sqrt(near2) - lift) : none;
  s.upper[5] = value_of(far2) > 0 ? S(sqrt(far2) - lift) : none;
  s.lower[6] = (l.tau_p * g.L3 - g.d * sin_b) / cos_b;
  s.upper[6] = beyond ? none : S(width * d.cot_c - lift);
  s.lower[7] = max(l.z_clear, S(width * l.lam.cos / l.lam.sin)) - lift;
  const S shaft2 = (l.lw_max - w_y) * (l.lw_max + w_y);  // value of Q^2 + x^2 at the maximum length of the shaft
  s.upper[kEndL] = value_of(shaft2) > 0 ? S(sqrt(shaft2) - Q0) : none;
  s.lower[kEndQ] = magnitude(w_y) * d.cot_phi - Q0;
  const S hole2 = (l.lw_min - w_y) * (l.lw_min + w_y);
  s.hole_end = value_of(hole2) > 0 ? S(sqrt(hole2) - Q0) : none;
  s.upper[kEndQ] = all;

  // Set the curves that bound x.
  const auto circle = [&](const S& radius, const S& foot) {  // a circle with its centre at z = foot
    return Curve<S>{{radius + foot, S(-1.0), radius - foot, one}};
  };
  s.curve = {circle(g.L1, zero),
             circle(g.L2, zero),
             circle(sqrt_or_zero(reach2), S(-lift)),
             Curve<S>{{t * Q0 + w_y, t, t * Q0 - w_y, t}},
             Curve<S>{{t * P0 + v_0, t * cos_b + sin_b, t * P0 - v_0, t * cos_b - sin_b}},
             circle(sqrt_or_zero(shaft2), S(-Q0)),
             circle(sqrt_or_zero(hole2), S(-Q0))};
  for (std::size_t i = 0; i < kCurves; ++i) {
    const bool limb = i < 3;
    s.constants[kLeft][i] = limb ? d.lo[i] : zero;
    s.constants[kRight][i] = limb ? d.hi[i] : zero;
    s.signs[kLeft][i] = limb ? d.signs[i] : -1;
    s.signs[kRight][i] = limb ? d.signs[i] : 1;
  }
  s.m = {value_of(Q0), value_of(P0), value_of(l.lw_max * l.phi.cos), value_of(l.lw_min * l.phi.cos)};
  s.m_z = {1, value_of(cos_b), 0, 0};
  return s;
}

/// Converts a slice with derivatives to one with values only.
inline const Slice<double>& values(const Slice<double>& s) { return s; }
template <class S>
Slice<double> values(const Slice<S>& s) {
  Slice<double> v{.signs = s.signs, .hole_end = value_of(s.hole_end), .m = s.m, .m_z = s.m_z};
  for (std::size_t i = 0; i < kCurves; ++i) {
    const Curve<S>& c = s.curve[i];
    v.curve[i] = {{value_of(c.a), value_of(c.a_z), value_of(c.b), value_of(c.b_z)}};
    for (const Side side : {kLeft, kRight}) v.constants[side][i] = value_of(s.constants[side][i]);
  }
  for (std::size_t i = 0; i < kLowerEnds; ++i) v.lower[i] = value_of(s.lower[i]);
  for (std::size_t i = 0; i < kUpperEnds; ++i) v.upper[i] = value_of(s.upper[i]);
  return v;
}

}  // namespace pkm::hybrid
