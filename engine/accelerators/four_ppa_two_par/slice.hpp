// 4PPa-2PaR: the feasible (x, z) of the mode lower,lower at given theta and y, a planar slice, in closed form.
//
// Only the bounds of z_cj depend on z. So for given (x, theta, y) the feasible z form one interval
//
//   lo = max_j(-Z_low - sigma_j) - d,   hi = min_j(-Z_j - sigma_j) - d,
//   Z_low = sqrt(l_u^2 - h_min^2),      Z_j = max(l_u sin alpha_min, sqrt(max(0, l_u^2 - H_j^2))),
//   H_j = min(y_j, L0 - y_j)            (stroke available on the shorter side)
//
// With Delta_j = Z_low - Z_j and delta = |sigma_1 - sigma_2| its length is min(Delta_i, Delta_k - delta), where i is
// the limb with the greater inclination (beta_i >= beta_k), "leaning" in the code. So delta is used as a coordinate
// instead of x. The loop-closure equation x_1 + x_2 = w = b - a cos theta puts A = (x_1, sigma_1) and
// B = (-x_2, sigma_2) on one circle of radius l_d with A - B = (w, delta): a chord of length sqrt(q), q = w^2 +
// delta^2, seen from the centre under the angle 2p = beta_1 + beta_2. Hence, with u = |x - b/2|,
//
//   sin p = sqrt(q) / (2 l_d),   u = delta cot(p) / 2,   integral of u d(delta) = l_d^2 (p + sin p cos p),
//
// every limit is a bound of delta given by a square root, and the area of the slice needs no quadrature:
//
//   area = constant part + [(Delta_k - delta) u] + integral of u d(delta).
#pragma once

#include "engine/accelerators/four_ppa_two_par/model.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::four_ppa_two_par {

/// Ranges to which the limits restrict lengths in the mode lower,lower [m].
template <class S>
struct Ranges {
  S x_min, x_max;   ///< range of x_j: l_d sin(beta_min), l_d sin(beta_max)
  S z_low, z_high;  ///< maximum and minimum of -z_cj for unlimited stroke: sqrt(l_u^2 - h_min^2), l_u sin(alpha_min)
  S stroke_free;    ///< stroke l_u cos(alpha_min) from which on the stroke does not limit z
  /// Range of 2 l_d sin p, with 2p = beta_1 + beta_2, for sin_par_min = sin(phi): 2 l_d sin(phi/2) to 2 l_d cos(phi/2).
  S chord_min, chord_max;
};
template <class S>
Ranges<S> ranges(const Geometry<S>& g, const Limits<S>& l) {
  return {.x_min = g.l_d * l.sin_beta_min,
          .x_max = g.l_d * l.sin_beta_max,
          .z_low = sqrt_or_zero(S((g.l_u - l.h_min) * (g.l_u + l.h_min))),
          .z_high = g.l_u * l.sin_alpha_min,
          .stroke_free = g.l_u * l.cos_alpha_min,
          .chord_min = g.l_d * 2.0 * l.sin_half,
          .chord_max = g.l_d * 2.0 * l.cos_half};
}

/// A design with its limits, on a plane of constant y.
template <class S>
struct SlicedDesign : Ranges<S> {
  Geometry<S> g;
  Limits<S> l;
  S y;         ///< y of the plane, mirrored to y <= L0/2 [m]
  bool empty;  ///< true if no pose is feasible on the plane
};

/// @param y  y of the plane [m]; the workspace on the plane L0 - y is its mirror image (y -> L0 - y, theta -> -theta)
template <class S>
SlicedDesign<S> sliced_design(const Geometry<S>& g, const Limits<S>& l, const S& y) {
  SlicedDesign<S> d{ranges(g, l), g, l, min(y, S(g.L0 - y)), false};
  d.empty = !(value_of(d.z_low) > value_of(d.z_high)) || !(value_of(d.x_max) > value_of(d.x_min)) ||
            !(value_of(d.y) > value_of(l.h_min)) || value_of(l.sin_alpha_min) > 1 || value_of(l.sin_beta_min) > 1;
  return d;
}

/// The limit that determines the upper bound of delta.
enum class EndKind { beta_max, beta_min, parallel };

template <class S>
struct Slice {
  S w;  ///< sum x_1 + x_2 = b - a cos(theta) [m]
  S sin_theta, cos_theta;
  std::array<S, 2> depth;  ///< Delta_1 and Delta_2 [m]; if one is <= 0, its limb has no feasible z
  S delta_low, delta_end;  ///< range of delta = |sigma_1 - sigma_2| that all limits except those of `depth` allow [m]
  EndKind end = EndKind::beta_max;
  bool empty = true;  ///< true if no x is feasible
};

/// The slice at one theta, with depths that are not yet set (0).
template <class S>
Slice<S> slice_range(const SlicedDesign<S>& d, const S& sin_theta, const S& cos_theta) {
  const Geometry<S>& g = d.g;
  Slice<S> t;
  t.sin_theta = sin_theta;
  t.cos_theta = cos_theta;
  t.w = g.b - g.a * cos_theta;
  t.depth = {S(0.0), S(0.0)};
  t.delta_low = S(0.0);
  if (!(value_of(t.w) > 2 * value_of(d.x_min) && value_of(t.w) < 2 * value_of(d.x_max) &&
        value_of(t.w) < value_of(d.chord_max)))
    return t;
  // The upper bound of delta is determined by beta_max of the leaning limb, by beta_min of the other limb, or by
  // sin_par_min.
  const S x_lean = t.w - d.x_min;
  if (value_of(x_lean) > value_of(d.x_max)) {
    const S x_other = t.w - d.x_max;
    t.delta_end = sqrt_or_zero(S((g.l_d - x_other) * (g.l_d + x_other))) - g.l_d * d.l.cos_beta_max;
    t.end = EndKind::beta_max;
  } else {  // the difference l_d cos(beta_min) - sqrt(l_d^2 - x_lean^2) without cancellation
    const S sum = g.l_d * d.l.cos_beta_min + sqrt_or_zero(S((g.l_d - x_lean) * (g.l_d + x_lean)));
    t.delta_end = t.w * (t.w - d.x_min * 2.0) / sum;
    t.end = EndKind::beta_min;
  }
  const S parallel = sqrt_or_zero(S((d.chord_max - t.w) * (d.chord_max + t.w)));
  if (value_of(parallel) < value_of(t.delta_end)) {
    t.delta_end = parallel;
    t.end = EndKind::parallel;
  }
  if (value_of(t.w) < value_of(d.chord_min)) t.delta_low = sqrt(S((d.chord_min - t.w) * (d.chord_min + t.w)));
  t.empty = !(value_of(t.delta_end) > value_of(t.delta_low));
  return t;
}

/// Depth Delta_j of one limb [m] if its stroke on the shorter side is H. The stroke limits the depth if H < l_u
/// cos(alpha_min).
template <class S>
S depth(const SlicedDesign<S>& d, const S& H) {
  if (value_of(H) >= value_of(d.stroke_free)) return d.z_low - d.z_high;
  if (value_of(H) > value_of(d.l.h_min)) return d.z_low - sqrt_or_zero(S((d.g.l_u - H) * (d.g.l_u + H)));
  return S(0.0);
}

/// Strokes H_1 and H_2 of the limbs on their shorter sides [m]. On the middle plane they are bit-identical.
template <class S>
std::array<S, 2> strokes(const SlicedDesign<S>& d, const S& y, const S& sin_theta) {
  const S shift = d.g.a * sin_theta * 0.5, rest = d.g.L0 - y;
  return {min(S(y - shift), S(rest + shift)), min(S(y + shift), S(rest - shift))};
}

/// Computes the depths of both limbs on the plane y.
template <class S>
void set_depths(const SlicedDesign<S>& d, const S& y, Slice<S>& t) {
  const std::array<S, 2> H = strokes(d, y, t.sin_theta);
  t.depth = {depth(d, H[0]), depth(d, H[1])};
}

/// The slice at one theta, with the depths on the plane of the design.
template <class S>
Slice<S> slice(const SlicedDesign<S>& d, const S& sin_theta, const S& cos_theta) {
  Slice<S> t = slice_range(d, sin_theta, cos_theta);
  if (!t.empty) set_depths(d, d.y, t);
  return t;
}

/// The half of a slice in which a given limb is the leaning one, i.e. has the greater inclination. At a value of delta
/// = |sigma_1 - sigma_2| in the range [low, end], the feasible interval of z has the length min(flat, slope - delta)
/// [m].
template <class S>
struct HalfSlice {
  S flat, slope;
  S low, knee, end;  ///< range [low, end] of delta; up to the delta `knee`, the length is `flat` [m]
  bool empty = true;
};

/// @param leaning  the leaning limb: 0 for x > b/2, 1 for x < b/2
template <class S>
HalfSlice<S> half_slice(const Slice<S>& t, std::size_t leaning) {
  HalfSlice<S> h;
  h.flat = t.depth[leaning];
  h.slope = t.depth[1 - leaning];
  h.low = t.delta_low;
  h.end = min(t.delta_end, h.slope);
  h.knee = clamp(S(h.slope - h.flat), h.low, max(h.low, h.end));
  h.empty = !(value_of(h.end) > value_of(h.low)) || !(value_of(h.flat) > 0);
  return h;
}

/// sin p, cos p and u = |x - b/2| at a value of delta, where 2p = beta_1 + beta_2.
template <class S>
struct Chord {
  S sin_p, cos_p, u;
};

template <class S>
Chord<S> chord(const SlicedDesign<S>& d, const Slice<S>& t, const S& delta) {
  const S root = sqrt(S(t.w * t.w + delta * delta));
  Chord<S> c;
  c.sin_p = root / (d.g.l_d * 2.0);
  c.cos_p = sqrt_or_zero(S((S(1.0) - c.sin_p) * (S(1.0) + c.sin_p)));
  c.u = delta * d.g.l_d * c.cos_p / root;
  return c;
}

/// The feasible interval of z at one x in a half of a slice.
template <class S>
struct Column {
  std::array<S, 2> x, sigma;  ///< x_j and sigma_j of both limbs [m]
  S length;                   ///< length of the z interval [m]
  S derivative;               ///< derivative of u = |x - b/2| with respect to delta
  std::size_t leaning;

  /// z_c of limb j at the height `rise` above the lower end of the interval, at which z_c of the leaning limb is
  /// -Z_low.
  S z_c(const SlicedDesign<S>& d, const S& rise, std::size_t j) const {
    const S lean = rise - d.z_low;
    return j == leaning ? lean : S(lean + (sigma[j] - sigma[leaning]));
  }
};

template <class S>
Column<S> column(const SlicedDesign<S>& d, const Slice<S>& t, const HalfSlice<S>& h, std::size_t leaning,
                 const S& delta) {
  const Geometry<S>& g = d.g;
  const Chord<S> ch = chord(d, t, delta);
  const S q = t.w * t.w + delta * delta;
  const S ratio = g.l_d * t.w / q;
  Column<S> c;
  c.derivative = (ratio * ratio - 0.25) * 2.0 * ch.sin_p / ch.cos_p;
  c.length = min(h.flat, S(h.slope - delta));
  c.leaning = leaning;
  c.x[leaning] = t.w * 0.5 + ch.u;
  c.x[1 - leaning] = t.w * 0.5 - ch.u;
  for (std::size_t j = 0; j < 2; ++j) c.sigma[j] = sqrt_or_zero(S((g.l_d - c.x[j]) * (g.l_d + c.x[j])));
  return c;
}

/// Area of one half of a slice [m^2].
template <class S>
S half_area(const SlicedDesign<S>& d, const Slice<S>& t, const HalfSlice<S>& h) {
  const Chord<S> low = chord(d, t, h.low);
  const Chord<S> end = chord(d, t, h.end);
  const bool has_flat = value_of(h.knee) > value_of(h.low);
  const Chord<S> knee = has_flat ? chord(d, t, h.knee) : low;
  const S turn =
      atan2(S(end.sin_p * knee.cos_p - end.cos_p * knee.sin_p), S(end.cos_p * knee.cos_p + end.sin_p * knee.sin_p));
  const S under_slope = d.g.l_d * d.g.l_d * (turn + end.sin_p * end.cos_p - knee.sin_p * knee.cos_p);
  S area = (h.slope - h.end) * end.u - (h.slope - h.knee) * knee.u + under_slope;
  if (has_flat) area += h.flat * (knee.u - low.u);
  return area;
}

/// Area of the whole slice [m^2].
template <class S>
S area(const SlicedDesign<S>& d, const Slice<S>& t) {
  if (t.empty) return S(0.0);
  const HalfSlice<S> first = half_slice(t, 0);
  const bool symmetric = value_of(t.depth[0]) == value_of(t.depth[1]);
  if (symmetric) return first.empty ? S(0.0) : S(half_area(d, t, first) * 2.0);
  const HalfSlice<S> second = half_slice(t, 1);
  S sum(0.0);
  if (!first.empty) sum += half_area(d, t, first);
  if (!second.empty) sum += half_area(d, t, second);
  return sum;
}

}  // namespace pkm::four_ppa_two_par
