#include "engine/motion/time_law.hpp"

#include <cmath>

#include "engine/math/scalar.hpp"

namespace pkm {

Advance advance(TimeLaw law, double time, double duration, double way) {
  const double u = time / duration;
  if (u <= 0) return {};
  if (u >= 1) return {way, 0, 0};
  const double rate = way / duration, rate_2 = rate / duration;
  if (law == TimeLaw::cycloid) {
    const auto [s, c] = sincos(2 * kPi * u);
    return {way * (u - s / (2 * kPi)), rate * (1 - c), rate_2 * (2 * kPi * s)};
  }
  return {way * (u * u * u * (10 - u * (15 - 6 * u))), rate * (30 * u * u * (1 - u) * (1 - u)),
          rate_2 * (60 * u * (1 - u) * (1 - 2 * u))};
}

double peak_acceleration(TimeLaw law) { return law == TimeLaw::cycloid ? 2 * kPi : 10 / std::sqrt(3.0); }

double time_of_move(TimeLaw law, double way, double peak) {
  return std::sqrt(peak_acceleration(law) * std::fabs(way) / peak);
}

}  // namespace pkm
