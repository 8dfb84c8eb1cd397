#include "engine/motion/time_law.hpp"

#include <cmath>

#include "engine/math/scalar.hpp"

namespace pkm {

PathState evaluate(TimeLaw law, double time, double duration, double distance) {
  const double u = time / duration;
  if (u <= 0) return {};
  if (u >= 1) return {distance, 0, 0};
  const double rate = distance / duration, rate_2 = rate / duration;
  if (law == TimeLaw::cycloid) {
    const auto [s, c] = sincos(2 * kPi * u);
    return {distance * (u - s / (2 * kPi)), rate * (1 - c), rate_2 * (2 * kPi * s)};
  }
  if (law == TimeLaw::trapezoid) {
    if (3 * u < 1) return {distance * (2.25 * u * u), rate * (4.5 * u), rate_2 * 4.5};
    const double v = 1 - u;
    if (3 * v < 1) return {distance * (1 - 2.25 * v * v), rate * (4.5 * v), rate_2 * -4.5};
    return {distance * (1.5 * u - 0.25), rate * 1.5, 0};
  }
  return {distance * (u * u * u * (10 - u * (15 - 6 * u))), rate * (30 * u * u * (1 - u) * (1 - u)),
          rate_2 * (60 * u * (1 - u) * (1 - 2 * u))};
}

expression::Term path_fraction(TimeLaw law, TimeGraph& graph, const Interval& begin, double duration) {
  using expression::Term, expression::operation;
  const auto number = [&graph](double value) { return graph.number(value); };
  const auto s = [&](const Term& u) {
    if (law == TimeLaw::cycloid) return u - sin(number(2 * kPi) * u) / number(2 * kPi);
    if (law == TimeLaw::trapezoid) {  // this expression applies up to u = 1/2
      const Term beyond = call(operation("max"), u - graph.number(Interval(1.0) / Interval(3.0)), number(0));
      return number(2.25) * (u * u - beyond * beyond);
    }
    return u * u * u * (number(10) - u * (number(15) - number(6) * u));
  };
  // The travelled fraction s of a move is symmetric in the elapsed fraction u of the time: s(1 - u) = 1 - s(u). Each
  // half of the move is computed from its own end, which gives tighter interval enclosures.
  const auto half = [&](const Term& u) {
    return s(call(operation("min"), call(operation("max"), u, number(0)), number(0.5)));
  };
  const Term u = (graph.time - graph.number(begin)) / number(duration);
  return half(u) + number(0.5) - half(number(1) - u);
}

double peak_acceleration(TimeLaw law) {
  if (law == TimeLaw::trapezoid) return 4.5;
  return law == TimeLaw::cycloid ? 2 * kPi : 10 / std::sqrt(3.0);
}

double peak_speed(TimeLaw law) {
  if (law == TimeLaw::trapezoid) return 1.5;
  return law == TimeLaw::cycloid ? 2 : 1.875;
}

double move_duration(TimeLaw law, double distance, double peak) {
  return std::sqrt(peak_acceleration(law) * std::fabs(distance) / peak);
}

}  // namespace pkm
