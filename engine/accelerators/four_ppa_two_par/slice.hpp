// 4PPa-2PaR: the feasible x-z section of the lower mode at given theta and y, in closed form.
//
// Nothing but the bounds on z_cj depends on z, so for fixed (x, theta, y) the feasible z are one interval
//
//   lo = max_j(-Z_low - sigma_j) - d,   hi = min_j(-Z_j - sigma_j) - d,
//   Z_low = sqrt(l_u^2 - h_min^2),      Z_j = max(l_u sin alpha_min, sqrt(max(0, l_u^2 - H_j^2))),
//   H_j = min(y_j, L0 - y_j)            (the stroke left on the shorter side)
//
// With Delta_j = Z_low - Z_j and delta = |sigma_1 - sigma_2| its length is min(Delta_i, Delta_k - delta), where i is
// the limb that leans more (beta_i >= beta_k). So delta, not x, is the natural coordinate. The loop closure
// x_1 + x_2 = w = b - a cos theta puts A = (x_1, sigma_1) and B = (-x_2, sigma_2) on one circle of radius l_d with
// A - B = (w, delta): a chord of length sqrt(q), q = w^2 + delta^2, seen from the centre under 2p = beta_1 + beta_2.
// Hence, with u = |x - b/2|,
//
//   sin p = sqrt(q) / (2 l_d),   u = delta cot(p) / 2,   integral of u d(delta) = l_d^2 (p + sin p cos p),
//
// every limit is an end in delta by a square root, and the section's area needs no quadrature:
//
//   area = flat part + [(Delta_k - delta) u] + integral of u d(delta).
#pragma once

#include "engine/accelerators/four_ppa_two_par/model.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::four_ppa_two_par {

/// What the limits leave of the lower mode's lengths [m].
template <class S>
struct Ranges {
  S x_min, x_max;          ///< of x_j: l_d sin(beta_min), l_d sin(beta_max)
  S z_low, z_high;         ///< of -z_cj, without the stroke: most sqrt(l_u^2 - h_min^2), least l_u sin(alpha_min)
  S stroke_free;           ///< l_u cos(alpha_min): more stroke does not cut
  S chord_min, chord_max;  ///< of 2 l_d sin p, 2p = beta_1 + beta_2, for sin_par_min = sin(phi): 2 l_d sin, cos(phi/2)
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

/// What sections of one design have in common.
template <class S>
struct Frame : Ranges<S> {
  Geometry<S> g;
  Limits<S> l;
  S y;         ///< the plane, mirrored to y <= L0/2 [m]
  bool empty;  ///< no pose can be feasible
};

/// @param y  plane [m]; the workspace at L0 - y is the same (mirror y, theta -> -theta)
template <class S>
Frame<S> frame(const Geometry<S>& g, const Limits<S>& l, const S& y) {
  Frame<S> f{ranges(g, l), g, l, min(y, S(g.L0 - y)), false};
  f.empty = !(value_of(f.z_low) > value_of(f.z_high)) || !(value_of(f.x_max) > value_of(f.x_min)) ||
            !(value_of(f.y) > value_of(l.h_min)) || value_of(l.sin_alpha_min) > 1 || value_of(l.sin_beta_min) > 1;
  return f;
}

/// Which formula gives the inner end of the delta range, for telling pieces apart.
enum class EndKind { beta_max, beta_min, parallel };

template <class S>
struct Section {
  S w;  ///< b - a cos(theta) [m]
  S sin_theta, cos_theta;
  std::array<S, 2> depth;  ///< Delta_1, Delta_2 [m]; <= 0: limb has no feasible z
  S delta_low, delta_end;  ///< range of delta before depth cuts it [m]
  EndKind end = EndKind::beta_max;
  bool empty = true;  ///< no x is feasible
};

/// The range of x at given theta; the depths are left 0.
template <class S>
Section<S> section_range(const Frame<S>& f, const S& sin_theta, const S& cos_theta) {
  const Geometry<S>& g = f.g;
  Section<S> t;
  t.sin_theta = sin_theta;
  t.cos_theta = cos_theta;
  t.w = g.b - g.a * cos_theta;
  t.depth = {S(0.0), S(0.0)};
  t.delta_low = S(0.0);
  if (!(value_of(t.w) > 2 * value_of(f.x_min) && value_of(t.w) < 2 * value_of(f.x_max) &&
        value_of(t.w) < value_of(f.chord_max)))
    return t;
  // upper end of delta: beta_max of the limb that leans more, beta_min of the other, or sin_par
  const S x_lean = t.w - f.x_min;
  if (value_of(x_lean) > value_of(f.x_max)) {
    const S x_other = t.w - f.x_max;
    t.delta_end = sqrt_or_zero(S((g.l_d - x_other) * (g.l_d + x_other))) - g.l_d * f.l.cos_beta_max;
    t.end = EndKind::beta_max;
  } else {  // l_d cos(beta_min) - sqrt(l_d^2 - x_lean^2) without the cancellation
    const S sum = g.l_d * f.l.cos_beta_min + sqrt_or_zero(S((g.l_d - x_lean) * (g.l_d + x_lean)));
    t.delta_end = t.w * (t.w - f.x_min * 2.0) / sum;
    t.end = EndKind::beta_min;
  }
  const S parallel = sqrt_or_zero(S((f.chord_max - t.w) * (f.chord_max + t.w)));
  if (value_of(parallel) < value_of(t.delta_end)) {
    t.delta_end = parallel;
    t.end = EndKind::parallel;
  }
  if (value_of(t.w) < value_of(f.chord_min)) t.delta_low = sqrt(S((f.chord_min - t.w) * (f.chord_min + t.w)));
  t.empty = !(value_of(t.delta_end) > value_of(t.delta_low));
  return t;
}

/// Depth of one limb for a stroke of H on its shorter side [m]: the stroke cuts where H < l_u cos(alpha_min).
template <class S>
S depth(const Frame<S>& f, const S& H) {
  if (value_of(H) >= value_of(f.stroke_free)) return f.z_low - f.z_high;
  if (value_of(H) > value_of(f.l.h_min)) return f.z_low - sqrt_or_zero(S((f.g.l_u - H) * (f.g.l_u + H)));
  return S(0.0);
}

/// Strokes H_1, H_2 left to the limbs on their shorter sides [m]. Written so that on the middle plane both have the
/// same bits.
template <class S>
std::array<S, 2> strokes(const Frame<S>& f, const S& y, const S& sin_theta) {
  const S shift = f.g.a * sin_theta * 0.5, rest = f.g.L0 - y;
  return {min(S(y - shift), S(rest + shift)), min(S(y + shift), S(rest - shift))};
}

/// Adds the depths of both limbs on the plane y.
template <class S>
void set_depths(const Frame<S>& f, const S& y, Section<S>& t) {
  const std::array<S, 2> H = strokes(f, y, t.sin_theta);
  t.depth = {depth(f, H[0]), depth(f, H[1])};
}

/// The section on the frame's plane.
template <class S>
Section<S> section(const Frame<S>& f, const S& sin_theta, const S& cos_theta) {
  Section<S> t = section_range(f, sin_theta, cos_theta);
  if (!t.empty) set_depths(f, f.y, t);
  return t;
}

/// One half of a section: the x on the side on which one limb leans more. Length of the z interval at delta:
/// min(flat, slope - delta), feasible for delta in [low, end].
template <class S>
struct Half {
  S flat, slope;
  S low, knee, end;  ///< flat up to the knee
  bool empty = true;
};

/// @param leaning  limb that leans more, 0 or 1: x > b/2 for 0 and x < b/2 for 1
template <class S>
Half<S> half_section(const Section<S>& t, std::size_t leaning) {
  Half<S> h;
  h.flat = t.depth[leaning];
  h.slope = t.depth[1 - leaning];
  h.low = t.delta_low;
  h.end = min(t.delta_end, h.slope);
  h.knee = clamp(S(h.slope - h.flat), h.low, max(h.low, h.end));
  h.empty = !(value_of(h.end) > value_of(h.low)) || !(value_of(h.flat) > 0);
  return h;
}

/// sin p, cos p and u at one delta.
template <class S>
struct Chord {
  S sin_p, cos_p, u;
};

template <class S>
Chord<S> chord(const Frame<S>& f, const Section<S>& t, const S& delta) {
  const S root = sqrt(S(t.w * t.w + delta * delta));
  Chord<S> c;
  c.sin_p = root / (f.g.l_d * 2.0);
  c.cos_p = sqrt_or_zero(S((S(1.0) - c.sin_p) * (S(1.0) + c.sin_p)));
  c.u = delta * f.g.l_d * c.cos_p / root;
  return c;
}

/// The feasible z at one x of a half section.
template <class S>
struct Column {
  std::array<S, 2> x, sigma;  ///< of the two limbs [m]
  S length;                   ///< of the z interval [m]
  S slope;                    ///< du / d(delta)
  std::size_t leaning;

  /// z_c of limb j at a height over the interval's lower end, where that of the leaning limb is -Z_low.
  S z_c(const Frame<S>& f, const S& rise, std::size_t j) const {
    const S lean = rise - f.z_low;
    return j == leaning ? lean : S(lean + (sigma[j] - sigma[leaning]));
  }
};

template <class S>
Column<S> column(const Frame<S>& f, const Section<S>& t, const Half<S>& h, std::size_t leaning, const S& delta) {
  const Geometry<S>& g = f.g;
  const Chord<S> ch = chord(f, t, delta);
  const S q = t.w * t.w + delta * delta;
  const S ratio = g.l_d * t.w / q;
  Column<S> c;
  c.slope = (ratio * ratio - 0.25) * 2.0 * ch.sin_p / ch.cos_p;
  c.length = min(h.flat, S(h.slope - delta));
  c.leaning = leaning;
  c.x[leaning] = t.w * 0.5 + ch.u;
  c.x[1 - leaning] = t.w * 0.5 - ch.u;
  for (std::size_t j = 0; j < 2; ++j) c.sigma[j] = sqrt_or_zero(S((g.l_d - c.x[j]) * (g.l_d + c.x[j])));
  return c;
}

/// Area of one half [m^2].
template <class S>
S half_area(const Frame<S>& f, const Section<S>& t, const Half<S>& h) {
  const Chord<S> low = chord(f, t, h.low);
  const Chord<S> end = chord(f, t, h.end);
  const bool has_flat = value_of(h.knee) > value_of(h.low);
  const Chord<S> knee = has_flat ? chord(f, t, h.knee) : low;
  const S turn =
      atan2(S(end.sin_p * knee.cos_p - end.cos_p * knee.sin_p), S(end.cos_p * knee.cos_p + end.sin_p * knee.sin_p));
  const S under_slope = f.g.l_d * f.g.l_d * (turn + end.sin_p * end.cos_p - knee.sin_p * knee.cos_p);
  S area = (h.slope - h.end) * end.u - (h.slope - h.knee) * knee.u + under_slope;
  if (has_flat) area += h.flat * (knee.u - low.u);
  return area;
}

/// Area of the section [m^2].
template <class S>
S area(const Frame<S>& f, const Section<S>& t) {
  if (t.empty) return S(0.0);
  const Half<S> first = half_section(t, 0);
  const bool symmetric = value_of(t.depth[0]) == value_of(t.depth[1]);
  if (symmetric) return first.empty ? S(0.0) : S(half_area(f, t, first) * 2.0);
  const Half<S> second = half_section(t, 1);
  S sum(0.0);
  if (!first.empty) sum += half_area(f, t, first);
  if (!second.empty) sum += half_area(f, t, second);
  return sum;
}

}  // namespace pkm::four_ppa_two_par
