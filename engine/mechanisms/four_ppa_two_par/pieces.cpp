#include "engine/mechanisms/four_ppa_two_par/pieces.hpp"

namespace pkm::four_ppa_two_par {
namespace {

/// Zero of one gap between two theta at which it has different signs: false position, Illinois variant.
double zero_of_gap(const Frame<double>& f, std::size_t index, double low, double at_low, double high, double at_high) {
  int side = 0;
  for (int step = 0; step < 60 && high - low > 1e-15 * (1 + high); ++step) {
    double middle = high - at_high * (high - low) / (at_high - at_low);
    if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
    const double value = gap(f, index, middle);
    if (std::fabs(value) < 1e-16) return middle;
    if ((value > 0) == (at_low > 0)) {
      low = middle;
      at_low = value;
      if (side == -1) at_high *= 0.5;
      side = -1;
    } else {
      high = middle;
      at_high = value;
      if (side == 1) at_low *= 0.5;
      side = 1;
    }
  }
  return high;
}

}  // namespace

Signature signature(const Frame<double>& f, double theta) {
  const auto [s, c] = sincos(theta);
  const Section<double> t = section(f, s, c);
  Signature result;
  if (t.empty || !(t.depth[0] > 0)) return result;
  const auto [H1, H2] = strokes(f, f.y, s);
  const bool far_end = f.y + f.g.a * s * 0.5 > f.g.L0 * 0.5;
  result.formula = 16 * static_cast<int>(t.end) + 8 * (t.delta_low > 0) + 4 * (H1 < f.stroke_free) +
                   2 * (H2 < f.stroke_free) + (H2 < f.stroke_free && far_end);
  result.gap = gaps(t);
  return result;
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
