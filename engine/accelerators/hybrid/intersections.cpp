#include "engine/accelerators/hybrid/intersections.hpp"

#include <cmath>

namespace pkm::hybrid {
namespace {

/// Where the chain's edges meet on one side.
double chain_meeting(const Section<double>& s, const Edge& first, const Edge& second) {
  const std::size_t i = first.curve - std::size_t{kCurveQ}, j = second.curve - std::size_t{kCurveQ};
  return (s.m[j] - s.m[i]) / (s.m_z[i] - s.m_z[j]);
}

/// How far one edge is right of another.
struct Gap {
  double value, slope, bend;  ///< the last bounds the second derivative
  double step() const { return -value / slope; }
  /// Whether what Newton's method does after this step is below rounding.
  bool last(double z) const {
    constexpr double kRelative = 1e-17;
    return step() * step() * bend <= kRelative * z * std::fabs(slope);
  }
};
Gap gap(const Section<double>& s, const Edge& first, const Edge& second, double z) {
  const auto at = [&](const Edge& e) {
    const Curve<double>& c = s.curve[e.curve];
    const double root = c.root(z), slope = c.slope(z, root), sign = s.sign(e);
    return Gap{s.constant(e) + root * sign, sign * slope, (std::fabs(c.curvature()) + slope * slope) / root};
  };
  const Gap a = at(first), b = at(second);
  return Gap{a.value - b.value, a.slope - b.slope, a.bend + b.bend};
}

/// Where two edges on circles meet, as near z as there is a place between two heights; NaN: nowhere, they are no
/// circles, or so near to touching that rounding counts.
double circles_meeting(const Section<double>& s, const Edge& first, const Edge& second, double z, double low,
                       double high) {
  const auto circle = [](const Edge& e) { return e.curve != kCurveQ && e.curve != kCurveP; };
  if (!circle(first) || !circle(second)) return kNowhere;
  // centres and radii
  const Curve<double>&c = s.curve[first.curve], &d = s.curve[second.curve];
  const double foot = 0.5 * (c.a - c.b), r1 = 0.5 * (c.a + c.b), r2 = 0.5 * (d.a + d.b);
  const double dx = s.constant(second) - s.constant(first), dz = 0.5 * (d.a - d.b) - foot,
               apart = 1 / (dx * dx + dz * dz);
  const double along = 0.5 * (1 + (r1 - r2) * (r1 + r2) * apart), across2 = r1 * r1 * apart - along * along;
  constexpr double kTouch = 1e-4;
  if (!(across2 >= kTouch * along * along)) return kNowhere;
  const double across = std::sqrt(across2);
  double least = std::numeric_limits<double>::infinity(), nearest = kNowhere;
  for (const double h : {across, -across}) {
    const double at = foot + along * dz + h * dx, from_first = along * dx - h * dz, from_second = from_first - dx;
    const bool on_both = from_first * s.sign(first) >= 0 && from_second * s.sign(second) >= 0;
    if (!on_both || !(at > low && at < high) || std::fabs(at - z) >= least) continue;
    least = std::fabs(at - z);
    nearest = at;
  }
  return nearest;
}

}  // namespace

double meeting(const Section<double>& s, const Edge& first, const Edge& second, double p, double q) {
  if (of_chain(first, second)) return std::fmin(std::fmax(chain_meeting(s, first, second), p), q);
  if (const double z = circles_meeting(s, first, second, 0.5 * (p + q), p, q); z == z) return z;
  const double at_p = gap(s, first, second, p).value, at_q = gap(s, first, second, q).value;
  double z = p - at_p * (q - p) / (at_q - at_p);
  for (int step = 0; step < 80; ++step) {
    if (!(z > p && z < q)) z = 0.5 * (p + q);
    const Gap here = gap(s, first, second, z);
    ((here.value >= 0) == (at_p >= 0) ? p : q) = z;
    if (!(q - p > 4e-16 * z)) break;
    z += here.step();
    if (here.last(z)) return std::fmin(std::fmax(z, p), q);
  }
  return z;
}

double meeting_near(const Section<double>& s, const Edge& first, const Edge& second, double z) {
  if (of_chain(first, second)) return chain_meeting(s, first, second);
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  if (const double at = circles_meeting(s, first, second, z, 0, kAnywhere); at == at) return at;
  double rises = 0;
  for (int step = 0; step < 8; ++step) {
    const Gap here = gap(s, first, second, z);
    if (step == 0) rises = here.slope;
    if (!(rises * here.slope > 0)) return kNowhere;
    z += here.step();
    if (here.last(z)) return z;
  }
  return kNowhere;
}

}  // namespace pkm::hybrid
