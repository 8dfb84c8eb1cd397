// 4PPa-2PaR: the pieces of theta on which the section's area is smooth.
//
// The area changes its formula where an end of the delta range changes its kind, where the stroke begins to cut or
// empties a limb, where sin_par begins to cut at x = b/2, and where the depth Delta overtakes an end. All but the last
// have closed forms in cos theta or sin theta; the last has one while the stroke does not cut, and is found by a root
// otherwise. Breaks move with the design: a closed form carries its derivative along, a root has that of an implicit
// function. The area is continuous at every break, and everything is even in theta, so only theta >= 0 is listed.
#pragma once

#include <algorithm>
#include <optional>
#include <type_traits>

#include "engine/accelerators/four_ppa_two_par/slice.hpp"
#include "engine/math/critical_values.hpp"
#include "engine/math/dual.hpp"

namespace pkm::four_ppa_two_par {

/// Continuous functions of theta whose signs are part of the area's formula: where the depths lie beside the ends of
/// delta. Delta_1 <= Delta_2 here, because y <= L0/2 and theta >= 0.
inline constexpr std::size_t kGaps = 6;
template <class S>
std::array<S, kGaps> gaps(const Section<S>& t) {
  const S &D1 = t.depth[0], &D2 = t.depth[1];
  return {D1 - t.delta_end, D2 - t.delta_end,      D1 - t.delta_low,
          D2 - t.delta_low, D2 - D1 - t.delta_end, D2 - D1 - t.delta_low};
}
template <class S>
S gap(const Frame<S>& f, std::size_t index, const S& theta) {
  const auto [s, c] = sincos(theta);
  return gaps(section(f, s, c))[index];
}

/// Everything that tells one formula of the area from another at one theta.
struct Formula {
  EndKind end;
  bool low;                ///< delta_low > 0
  bool cuts_1, cuts_2;     ///< the stroke cuts the limb's depth
  bool cuts_2_at_far_end;  ///< and it is that to the rail's far end
  bool operator==(const Formula&) const = default;
};
struct Signature {
  std::optional<Formula> formula;  ///< none: empty
  std::array<double, kGaps> gap{};

  explicit operator bool() const { return formula.has_value(); }
  bool operator==(const Signature& other) const {
    if (formula != other.formula) return false;
    for (std::size_t i = 0; formula && i < kGaps; ++i)
      if ((gap[i] > 0) != (other.gap[i] > 0)) return false;
    return true;
  }
};

/// The signature at one theta of a frame of doubles.
Signature signature(const Frame<double>& f, double theta);
/// Whether the stroke cuts the depth of either limb at theta.
bool stroke_cuts(const Frame<double>& f, double theta);

/// A zero of one of the gaps.
struct Crossing {
  double theta;
  std::size_t gap;
};
/// The first theta in (low, high] where a gap is seen to have another sign than at `low`, to the last bits. The two
/// signatures differ by gaps alone.
Crossing find_crossing(const Frame<double>& f, double low, const Signature& at_low, double high,
                       const Signature& at_high);

/// The frame of the same section for another scalar, which does not move with the design.
template <class To, class From>
Frame<To> constant_frame(const Frame<From>& f) {
  return frame(constant<To>(f.g), constant<To>(f.l), To(value_of(f.y)));
}

/// The theta of a crossing with its derivatives: gap(p, theta(p)) = 0 gives theta' = -(d gap/d p) / (d gap/d theta).
template <class S>
S follow(const Frame<S>& f, const Crossing& crossing) {
  if constexpr (!std::is_same_v<S, double>) {
    const S moves = gap(f, crossing.gap, S(crossing.theta));
    using Slope = Dual<1>;
    const double slope = gap(constant_frame<Slope>(f), crossing.gap, Slope::variable(crossing.theta, 0)).v[0];
    return implicit_root(crossing.theta, moves, slope);  // a gap that only touches 0 opens and closes a piece there
  } else {
    return crossing.theta;
  }
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
  const auto root = [](const S& x) { return sqrt_or_zero(x); };
  // ends of the range of w
  at_w(f.x_min * 2.0, false, false);
  at_w(f.x_max * 2.0, true, false);
  at_w(f.chord_max, true, false);
  // beta_max hands over to beta_min: a root where sigma of the limb that leans more gets to 0
  at_w(f.x_max + f.x_min, value_of(l.cos_beta_max) < 0.1, false);
  const bool parallel = value_of(l.sin_par_min) > 0;
  const S sin_phi = l.sin_half * l.cos_half * 2.0, cos_phi = l.cos_half * l.cos_half - l.sin_half * l.sin_half;
  if (parallel) {
    // beta_1 + beta_2 = pi - phi with one limb at its limit
    at_w(g.l_d * (l.sin_beta_max + sin_phi * l.cos_beta_max + cos_phi * l.sin_beta_max), false, false);
    at_w(g.l_d * (l.sin_beta_min + sin_phi * l.cos_beta_min + cos_phi * l.sin_beta_min), false, false);
    // beta_1 + beta_2 = phi begins to cut at x = b/2, and meets a limit
    at_w(f.chord_min, true, false);
    at_w(g.l_d * (l.sin_beta_min + sin_phi * l.cos_beta_min - cos_phi * l.sin_beta_min), false, false);
    at_w(g.l_d * (l.sin_beta_max + sin_phi * l.cos_beta_max - cos_phi * l.sin_beta_max), false, false);
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
  const S upper = (f.chord_max - depth) * (f.chord_max + depth);
  if (value_of(upper) > 0) at_w(root(upper), false, false);
  const S lower = (f.chord_min - depth) * (f.chord_min + depth);
  if (parallel && value_of(lower) > 0) at_w(root(lower), false, false);
  // the stroke begins to cut (a root on the side where it does), and empties a limb
  at_shift(f.y - f.stroke_free, false, true);
  at_shift(f.stroke_free - f.y, true, false);
  at_shift(g.L0 - f.stroke_free - f.y, false, true);
  at_shift(f.y - l.h_min, false, false);
  at_shift(g.L0 * 0.5 - f.y, false, false);  // the nearer end of the rail changes
}

/// Calls `split(break, signature below it)` wherever gaps change their signs between two closed-form breaks, and
/// returns the signature above the last one. Every change of the formula has a closed form: a sample with another
/// formula than that in the middle lies within rounding of an end and tells nothing.
template <class S, class Split>
Signature split_at_crossings(const Frame<S>& f, const Frame<double>& plain, double low, double high,
                             const Signature& middle, const Split& split) {
  constexpr int kSamples = 8;
  constexpr double kInset = 1e-7;  // off the ends, where a gap may be 0 but for rounding
  Signature now = middle;
  double at = low;
  bool started = false;
  for (int k = 0; k <= kSamples; ++k) {
    const double share = k == 0 ? kInset : k == kSamples ? 1 - kInset : k / static_cast<double>(kSamples);
    const double next = low + (high - low) * share;
    const Signature then = signature(plain, next);
    if (then.formula != middle.formula) continue;
    for (int more = 0; started && more < 6 && !(now == then); ++more) {  // several gaps may change in between
      const Crossing crossing = find_crossing(plain, at, now, next, then);
      split(Break<S>{follow(f, crossing)}, now);
      at = crossing.theta + 1e-12;
      now = signature(plain, at);
      if (now.formula != middle.formula) now = then;
    }
    at = next;
    now = then;
    started = true;
  }
  return now;
}

/// Fills `pieces` with the theta >= 0 on which the area is positive and smooth.
/// @param breaks  reused storage
template <class S>
void find_pieces(const Frame<S>& f, std::vector<Break<S>>& breaks, std::vector<Piece<S>>& pieces) {
  breaks.clear();
  pieces.clear();
  if (f.empty) return;
  const Frame<double> plain = constant_frame<double>(f);
  breaks.push_back({S(0.0)});
  closed_form_breaks(f, breaks);
  const S last = acos(f.l.cos_theta_min);
  std::erase_if(breaks, [&](const Break<S>& b) { return !(value_of(b.at) < value_of(last)); });
  breaks.push_back({last});
  const auto in_order = [](const Break<S>& a, const Break<S>& b) { return value_of(a.at) < value_of(b.at); };
  for (auto next = breaks.begin(); next != breaks.end(); ++next)  // std::stable_sort allocates
    std::rotate(std::upper_bound(breaks.begin(), next, *next, in_order), next, next + 1);

  constexpr double kNear = 1e-13;  // rad
  const auto changes = [&](double low, double high, const auto& split) {
    const Signature middle = signature(plain, 0.5 * (low + high));
    if (!middle || !stroke_cuts(plain, 0.5 * (low + high))) return middle;
    return split_at_crossings(f, plain, low, high, middle, split);
  };
  pkm::find_pieces<Signature>(breaks, kNear, false, changes, pieces);
}

}  // namespace pkm::four_ppa_two_par
