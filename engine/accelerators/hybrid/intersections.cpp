#include "engine/accelerators/hybrid/intersections.hpp"

#include <cmath>

#include "engine/math/roots.hpp"

namespace pkm::hybrid {
namespace {

/// The z at which two edges intersect that are bounds due to the auxiliary chain, on the same side.
double chain_intersection(const Slice<double>& s, const Edge& first, const Edge& second) {
  const std::size_t i = first.curve - std::size_t{kCurveQ}, j = second.curve - std::size_t{kCurveQ};
  return (s.m[j] - s.m[i]) / (s.m_z[i] - s.m_z[j]);
}

/// Difference of the x of two edges at one z, and its derivatives with respect to z.
struct Gap {
  double value, derivative;
  double second;  ///< bound of the magnitude of the second derivative
  double step() const { return -value / derivative; }
  /// Returns true if Newton's method, after step() from the height z, has converged to the rounding accuracy of z.
  bool is_last(double z) const {
    constexpr double kRelative = 1e-17;
    return step() * step() * second <= kRelative * z * std::fabs(derivative);
  }
};
Gap gap(const Slice<double>& s, const Edge& first, const Edge& second, double z) {
  const auto at = [&](const Edge& e) {
    const Curve<double>& c = s.curve[e.curve];
    const double root = c.root(z), derivative = c.derivative(z, root), sign = s.sign(e);
    return Gap{s.constant(e) + root * sign, sign * derivative,
               (std::fabs(c.curvature()) + derivative * derivative) / root};
  };
  const Gap a = at(first), b = at(second);
  return Gap{a.value - b.value, a.derivative - b.derivative, a.second + b.second};
}

/// The z at which two circular edges intersect between two heights; if there are two intersections, the one closer to
/// z. kNoIntersection if there is none, if an edge is not circular, or if the circles are tangent to working precision.
double circle_intersection(const Slice<double>& s, const Edge& first, const Edge& second, double z, double low,
                           double high) {
  const auto circle = [](const Edge& e) { return e.curve != kCurveQ && e.curve != kCurveP; };
  if (!circle(first) || !circle(second)) return kNoIntersection;
  // Compute the centres and radii of the two circles.
  const Curve<double>&c = s.curve[first.curve], &d = s.curve[second.curve];
  const double z1 = 0.5 * (c.a - c.b), r1 = 0.5 * (c.a + c.b), r2 = 0.5 * (d.a + d.b);
  const double dx = s.constant(second) - s.constant(first), dz = 0.5 * (d.a - d.b) - z1,
               inverse2 = 1 / (dx * dx + dz * dz);
  // Components of the intersection along and across the line of centres, relative to the distance of the centres.
  const double along = 0.5 * (1 + (r1 - r2) * (r1 + r2) * inverse2), across2 = r1 * r1 * inverse2 - along * along;
  constexpr double kTangent = 1e-4;
  if (!(across2 >= kTangent * along * along)) return kNoIntersection;
  const double across = std::sqrt(across2);
  double smallest = std::numeric_limits<double>::infinity(), nearest = kNoIntersection;
  for (const double h : {across, -across}) {
    const double at = z1 + along * dz + h * dx, from_first = along * dx - h * dz, from_second = from_first - dx;
    const bool on_both = from_first * s.sign(first) >= 0 && from_second * s.sign(second) >= 0;
    if (!on_both || !(at > low && at < high) || std::fabs(at - z) >= smallest) continue;
    smallest = std::fabs(at - z);
    nearest = at;
  }
  return nearest;
}

}  // namespace

double intersection(const Slice<double>& s, const Edge& first, const Edge& second, double p, double q) {
  if (are_bounds_of_chain(first, second)) return std::fmin(std::fmax(chain_intersection(s, first, second), p), q);
  if (const double z = circle_intersection(s, first, second, 0.5 * (p + q), p, q); z == z) return z;
  const double at_p = gap(s, first, second, p).value, at_q = gap(s, first, second, q).value;
  return refine_root_newton([&](double z) { return gap(s, first, second, z); }, p, q, at_p >= 0,
                            p - at_p * (q - p) / (at_q - at_p),
                            [](const Gap& here, double, double next) { return here.is_last(next); });
}

double intersection_near(const Slice<double>& s, const Edge& first, const Edge& second, double z) {
  if (are_bounds_of_chain(first, second)) return chain_intersection(s, first, second);
  constexpr double kUnbounded = std::numeric_limits<double>::infinity();
  if (const double at = circle_intersection(s, first, second, z, 0, kUnbounded); at == at) return at;
  constexpr int kMaxSteps = 8;
  Gap here{};
  double first_derivative = 0;  // derivative of the gap with respect to z, at the current z
  const auto step = [&](double at) {
    here = gap(s, first, second, at);
    if (first_derivative == 0) first_derivative = here.derivative;
    return first_derivative * here.derivative > 0 ? here.step() : kNoIntersection;
  };
  const auto [at, has_converged] = iterate_newton(step, z, -kUnbounded, kUnbounded, kMaxSteps,
                                                  [&](double next, double) { return here.is_last(next); });
  return has_converged ? at : kNoIntersection;
}

}  // namespace pkm::hybrid
