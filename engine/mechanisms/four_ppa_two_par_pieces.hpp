// 4PPa-2PaR: the pieces of theta on which the section's area is smooth.
//
// The area changes its formula where an end of the delta range changes its kind, where the stroke begins to cut or
// empties a limb, where sin_par begins to cut at x = b/2, and where the depth Delta overtakes an end. All but the last
// have closed forms in cos theta or sin theta; the last has one while the stroke does not cut, and is found by a root
// otherwise. The area is continuous at every break, and everything is even in theta, so only theta >= 0 is listed.
#pragma once

#include <algorithm>

#include "engine/mechanisms/four_ppa_two_par_section.hpp"

namespace pkm::four_ppa_two_par {

/// A break: where, and on which sides the area behaves like a square root.
template <class S>
struct Break {
  S theta;
  bool root_below = false;
  bool root_above = false;
};

/// Everything that tells one formula of the area from another at one theta.
struct Signature {
  int formula = -1;             ///< -1: empty
  std::array<double, 6> gap{};  ///< continuous functions whose signs are part of the formula
  bool operator==(const Signature& other) const {
    if (formula != other.formula) return false;
    if (formula < 0) return true;
    for (std::size_t i = 0; i < gap.size(); ++i)
      if ((gap[i] > 0) != (other.gap[i] > 0)) return false;
    return true;
  }
};

/// The signature at one theta of a frame of doubles.
Signature signature(const Frame<double>& f, double theta);
/// Whether the stroke cuts the depth of either limb at theta.
bool stroke_cuts(const Frame<double>& f, double theta);

/// The first theta in (low, high] where the signature is seen to change from that at `low`, to the last bits.
double find_crossing(const Frame<double>& f, double low, const Signature& at_low, double high,
                     const Signature& at_high);

/// Values of a frame.
template <class S>
Frame<double> values(const Frame<S>& f) {
  const auto& g = f.g;
  const auto& l = f.l;
  const auto v = [](const S& x) { return value_of(x); };
  return {{v(g.a), v(g.b), v(g.l_u), v(g.l_d), v(g.d), v(g.L0), v(g.R_u), v(g.R_d), v(g.d_u), v(g.d_d), v(g.d_0)},
          {v(l.sin_alpha_min), v(l.cos_alpha_min), v(l.sin_beta_min), v(l.cos_beta_min), v(l.sin_beta_max),
           v(l.cos_beta_max), v(l.h_min), v(l.sin_par_min), v(l.sin_half), v(l.cos_half), v(l.cos_theta_min)},
          v(f.x_min),
          v(f.x_max),
          v(f.z_low),
          v(f.z_high),
          v(f.stroke_free),
          v(f.y),
          f.empty};
}

/// Breaks with a closed form, unsorted.
template <class S>
void closed_form_breaks(const Frame<S>& f, std::vector<Break<S>>& breaks) {
  const Geometry<S>& g = f.g;
  const Limits<S>& l = f.l;
  const auto at_w = [&](const S& w, bool root_below, bool root_above) {
    const S c = (g.b - w) / g.a;
    if (value_of(c) > 0 && value_of(c) < 1) breaks.push_back({acos(c), root_below, root_above});
  };
  const auto at_shift = [&](const S& shift, bool root_below, bool root_above) {  // shift = (a/2) sin theta
    const S s = shift * 2.0 / g.a;
    if (value_of(s) > 0 && value_of(s) < 1) breaks.push_back({asin(s), root_below, root_above});
  };
  const auto root = [](const S& x) { return root_or_zero(x); };
  // ends of the range of w
  at_w(f.x_min * 2.0, false, false);
  at_w(f.x_max * 2.0, true, false);
  at_w(g.l_d * 2.0 * l.cos_half, true, false);
  // beta_max hands over to beta_min
  at_w(f.x_max + f.x_min, false, false);
  const bool parallel = value_of(l.sin_par_min) > 0;
  const S sin_phi = l.sin_half * l.cos_half * 2.0, cos_phi = l.cos_half * l.cos_half - l.sin_half * l.sin_half;
  if (parallel) {
    // beta_1 + beta_2 = pi - phi with one limb at its limit
    at_w(g.l_d * (l.sin_beta_max + sin_phi * l.cos_beta_max + cos_phi * l.sin_beta_max), false, false);
    at_w(g.l_d * (l.sin_beta_min + sin_phi * l.cos_beta_min + cos_phi * l.sin_beta_min), false, false);
    // beta_1 + beta_2 = phi begins to cut at x = b/2, and meets a limit
    at_w(g.l_d * 2.0 * l.sin_half, true, false);
    at_w(g.l_d * (l.sin_beta_min + sin_phi * l.cos_beta_min - cos_phi * l.sin_beta_min), false, false);
  }
  // the depth without stroke overtakes an end of delta
  const S depth = f.z_low - f.z_high;
  const S lean = g.l_d * l.cos_beta_max + depth, other = g.l_d * l.cos_beta_min - depth;
  if (value_of(lean) < value_of(g.l_d)) {
    const S x = root(S((g.l_d - lean) * (g.l_d + lean)));
    at_w(f.x_max + x, false, false);
    at_w(f.x_max - x, false, false);
  }
  if (value_of(other) > 0) at_w(f.x_min + root(S((g.l_d - other) * (g.l_d + other))), false, false);
  const S upper = (g.l_d * 2.0 * l.cos_half - depth) * (g.l_d * 2.0 * l.cos_half + depth);
  if (value_of(upper) > 0) at_w(root(upper), false, false);
  const S lower = (g.l_d * 2.0 * l.sin_half - depth) * (g.l_d * 2.0 * l.sin_half + depth);
  if (parallel && value_of(lower) > 0) at_w(root(lower), false, false);
  // the stroke begins to cut (a root on the side where it does), and empties a limb
  at_shift(f.y - f.stroke_free, false, true);
  at_shift(f.stroke_free - f.y, true, false);
  at_shift(g.L0 - f.stroke_free - f.y, false, true);
  at_shift(f.y - l.h_min, false, false);
  at_shift(l.h_min - f.y, false, false);
  at_shift(g.L0 - l.h_min - f.y, false, false);
  at_shift(g.L0 * 0.5 - f.y, false, false);  // the nearer end of the rail changes
}

/// Fills `pieces` with the theta >= 0 on which the area is positive and smooth.
/// @param breaks  reused storage
template <class S>
void find_pieces(const Frame<S>& f, std::vector<Break<S>>& breaks, std::vector<Piece<S>>& pieces) {
  breaks.clear();
  pieces.clear();
  if (f.empty) return;
  const Frame<double> plain = values(f);
  breaks.push_back({S(0.0)});
  closed_form_breaks(f, breaks);
  const S last = acos(f.l.cos_theta_min);
  std::erase_if(breaks, [&](const Break<S>& b) { return !(value_of(b.theta) < value_of(last)); });
  breaks.push_back({last});
  const auto by_theta = [](const Break<S>& a, const Break<S>& b) { return value_of(a.theta) < value_of(b.theta); };
  std::stable_sort(breaks.begin(), breaks.end(), by_theta);

  constexpr double kNear = 1e-13;  // rad; breaks nearer than this are one
  Signature before;                // of the piece before
  Break<S> from = breaks.front();
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const Break<S>& to = breaks[i];
    const double low = value_of(from.theta), high = value_of(to.theta);
    if (high - low < kNear) {
      from.root_above = from.root_above || to.root_above;
      if (!pieces.empty() && value_of(pieces.back().upper) == low)
        pieces.back().root_upper = pieces.back().root_upper || to.root_below;
      continue;
    }
    const auto add = [&](const Break<S>& start, const Break<S>& stop, const Signature& now) {
      const bool joins = !pieces.empty() && before == now && !start.root_above && !start.root_below &&
                         value_of(pieces.back().upper) == value_of(start.theta);
      if (now.formula >= 0 && joins) {
        pieces.back().upper = stop.theta;
        pieces.back().root_upper = stop.root_below;
      } else if (now.formula >= 0) {
        pieces.push_back({start.theta, stop.theta, start.root_above, stop.root_below});
      }
      before = now;
    };
    Signature now = signature(plain, 0.5 * (low + high));
    if (stroke_cuts(plain, 0.5 * (low + high))) {  // ends may cross inside: sample for changes of the signature
      constexpr int kSamples = 8;
      constexpr double kInset = 1e-7;  // off the ends, where a gap may be 0 but for rounding
      double t = low + kInset * (high - low);
      now = signature(plain, t);
      for (int k = 1; k <= kSamples; ++k) {
        const double next = low + (high - low) * (k == kSamples ? 1 - kInset : k / static_cast<double>(kSamples));
        const Signature then = signature(plain, next);
        for (int more = 0; more < 6 && !(now == then); ++more) {  // several gaps may change between two samples
          const double theta = find_crossing(plain, t, now, next, then);
          const Break<S> crossing{S(theta)};
          add(from, crossing, now);
          from = crossing;
          t = theta + 1e-12;
          now = signature(plain, t);
        }
        t = next;
        now = then;
      }
    }
    add(from, to, now);
    from = to;
  }
}

}  // namespace pkm::four_ppa_two_par
