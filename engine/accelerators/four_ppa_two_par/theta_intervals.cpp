#include "engine/accelerators/four_ppa_two_par/theta_intervals.hpp"

#include "engine/math/nonnegative_intervals.hpp"

namespace pkm::four_ppa_two_par {
namespace {

/// Zero of one gap between two theta at which it has different signs, to the last bits.
/// Not bracketed_root(): it stops elsewhere by some last bits, which studies would be resumed with.
double zero_of_gap(const Frame<double>& f, std::size_t index, double low, double at_low, double high, double at_high) {
  Bracket bracket{.a = low, .at_a = -at_low, .b = high, .at_b = -at_high};  // a gap of 0 counts as negative
  for (int step = 0; step < 60 && bracket.width() > 1e-15 * (1 + bracket.b); ++step) {
    const double theta = bracket.guess(), value = gap(f, index, theta);
    if (std::fabs(value) < 1e-16) return theta;
    bracket.take(theta, -value);
  }
  return bracket.b;
}

}  // namespace

Signature signature(const Frame<double>& f, double theta) {
  const auto [s, c] = sincos(theta);
  const Section<double> t = section(f, s, c);
  if (t.empty || !(t.depth[0] > 0)) return {};
  const auto [H1, H2] = strokes(f, f.y, s);
  const bool cuts_2 = H2<f.stroke_free, far_end = f.y + f.g.a * s * 0.5> f.g.L0 * 0.5;
  return {.formula = Formula{.end = t.end,
                             .low = t.delta_low > 0,
                             .cuts_1 = H1 < f.stroke_free,
                             .cuts_2 = cuts_2,
                             .cuts_2_at_far_end = cuts_2 && far_end},
          .gap = gaps(t)};
}

bool stroke_cuts(const Frame<double>& f, double theta) {
  const auto [H1, H2] = strokes(f, f.y, sincos(theta).sin);
  return H1 < f.stroke_free || H2 < f.stroke_free;
}

Crossing find_crossing(const Frame<double>& f, double low, const Signature& at_low, double high,
                       const Signature& at_high) {
  Crossing first{high, 0};
  for (std::size_t i = 0; i < kGaps; ++i) {
    if ((at_low.gap[i] > 0) == (at_high.gap[i] > 0)) continue;
    const double theta = zero_of_gap(f, i, low, at_low.gap[i], high, at_high.gap[i]);
    if (theta <= first.theta) first = {theta, i};
  }
  return first;
}

}  // namespace pkm::four_ppa_two_par
