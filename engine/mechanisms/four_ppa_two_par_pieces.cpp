#include "engine/mechanisms/four_ppa_two_par_pieces.hpp"

namespace pkm::four_ppa_two_par {
namespace {

/// Stroke left to limb j on its shorter side [m].
double stroke_left(const Frame<double>& f, double sin_theta, std::size_t j) {
  const double shift = f.g.a * sin_theta * 0.5, y = j == 0 ? f.y - shift : f.y + shift;
  return std::fmin(y, f.g.L0 - y);
}

/// The least theta, to the last bits, at which `holds`, true at `low`, is false.
template <class Predicate>
double halve(double low, double high, const Predicate& holds) {
  while (high - low > 1e-15 * (1 + high)) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return high;
}

/// Zero of one gap between two theta at which it has different signs: false position, Illinois variant.
double zero_of_gap(const Frame<double>& f, std::size_t gap, double low, double at_low, double high, double at_high) {
  int side = 0;
  for (int step = 0; step < 60 && high - low > 1e-15 * (1 + high); ++step) {
    double middle = high - at_high * (high - low) / (at_high - at_low);
    if (!(middle > low && middle < high)) middle = 0.5 * (low + high);
    const Signature here = signature(f, middle);
    if (here.formula < 0) return middle;  // emptied on the way
    const double value = here.gap[gap];
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
  if (t.empty || !(t.depth[1] > 0)) return result;
  const double H1 = stroke_left(f, s, 0), H2 = stroke_left(f, s, 1);
  const bool far_end = f.y + f.g.a * s * 0.5 > f.g.L0 * 0.5;
  result.formula = 16 * static_cast<int>(t.end) + 8 * (t.delta_low > 0) + 4 * (H1 < f.stroke_free) +
                   2 * (H2 < f.stroke_free) + (H2 < f.stroke_free && far_end);
  // Delta_1 <= Delta_2 here, because y <= L0/2 and theta >= 0
  const double D1 = t.depth[0], D2 = t.depth[1];
  result.gap = {D1 - t.delta_end, D2 - t.delta_end,      D1 - t.delta_low,
                D2 - t.delta_low, D2 - D1 - t.delta_end, D2 - D1 - t.delta_low};
  return result;
}

bool stroke_cuts(const Frame<double>& f, double theta) {
  const double s = sincos(theta).sin;
  return stroke_left(f, s, 0) < f.stroke_free || stroke_left(f, s, 1) < f.stroke_free;
}

double find_crossing(const Frame<double>& f, double low, const Signature& at_low, double high,
                     const Signature& at_high) {
  if (at_low.formula != at_high.formula || at_low.formula < 0)
    return halve(low, high, [&](double theta) { return signature(f, theta).formula == at_low.formula; });
  double first = high;
  for (std::size_t i = 0; i < at_low.gap.size(); ++i)
    if ((at_low.gap[i] > 0) != (at_high.gap[i] > 0))
      first = std::fmin(first, zero_of_gap(f, i, low, at_low.gap[i], high, at_high.gap[i]));
  return first;
}

}  // namespace pkm::four_ppa_two_par
