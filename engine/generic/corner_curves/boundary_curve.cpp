#include "engine/generic/corner_curves/boundary_curve.hpp"

#include <algorithm>

#include "engine/generic/corner_curves/root_isolation.hpp"

namespace pkm::generic::corner_curves {
namespace {

/// size_of_b(), size_of_c(): upper bounds of the magnitudes of the coefficients b and c in a curve's equation a |p|^2 +
/// b . p + c = 0.
double size_of_b(const BoundaryCurve& curve) {
  return (curve.is_circle() ? 2 : 1) * std::fmax(curve.size[0], curve.size[1]);
}
double size_of_c(const BoundaryCurve& curve) {
  if (!curve.is_circle()) return curve.size[2];
  return curve.size[0] * curve.size[0] + curve.size[1] * curve.size[1] + curve.size[2];
}

/// The line b . (p - m) + e = 0 through the two points in which a circle with centre m crosses another curve.
struct Chord {
  double bx, by, e;
};
Chord chord_of(const CurveAt& circle, const CurveAt& other) {
  if (!other.is_circle) return {other.u, other.w, other.u * circle.u + other.w * circle.w + other.c};
  const double bx = 2 * (other.u - circle.u), by = 2 * (other.w - circle.w);
  return {bx, by, -0.25 * (bx * bx + by * by) - circle.c + other.c};
}

}  // namespace

bool BoundaryCurve::interpolate(double tolerance) {
  terms = 1;
  tail = error = 0;
  bool has_converged = true;
  /// Computes the Chebyshev coefficients of a function from its values.
  /// @return maximum magnitude of the values
  const auto interpolate_function = [&](const Samples& of, Samples& coefficients) {
    double largest = 0;
    for (const double value : of) largest = std::max(largest, std::fabs(value));
    if (!std::isfinite(largest)) return largest;
    to_coefficients(of, coefficients);
    const double scale = is_circle() ? 1 + largest : 1;
    const double own_tail = interpolation_error(coefficients, 0);
    has_converged = has_converged && own_tail <= tolerance * scale;
    // Trailing coefficients of the series that are smaller than the rounding errors of the values are not used.
    const double rounding = 8 * kUnitRoundoff * scale;
    tail = std::max(tail, own_tail);
    error = std::max(error, own_tail + rounding);
    terms = std::max(terms, significant_terms(coefficients, kNodes, rounding));
    return largest;
  };
  for (std::size_t f = 0; f < 3; ++f) {
    size[f] = interpolate_function(values[f], series[f]);
    if (!std::isfinite(size[f])) return false;
    if (quadratic && !std::isfinite(interpolate_function(quadratic->values[f], quadratic->series[f]))) return false;
  }
  equation = values;
  if (is_circle())
    for (std::size_t n = 0; n < kNodes; ++n) {
      const double u = values[0][n], w = values[1][n];
      equation[0][n] = -2 * u;
      equation[1][n] = -2 * w;
      equation[2][n] = u * u + w * w - values[2][n];
    }
  return has_converged;
}

bool BoundaryCurve::find_graphs(const std::array<double, 2>& half_widths) {
  const auto& [xx, xy, yy] = quadratic->values;
  const auto bounds_of = [](const Samples& function) {
    Samples coefficients;
    to_coefficients(function, coefficients);
    double rest = interpolation_error(coefficients, 64 * kUnitRoundoff);
    for (std::size_t k = 1; k < kNodes; ++k) rest += std::fabs(coefficients[k]);
    return std::array{coefficients[0] - rest, coefficients[0] + rest};
  };
  for (const bool swapped : {false, true}) {
    swaps = swapped;
    // With (t, s) = (x, y) or (y, x), the discriminant of the conic's function h as a polynomial in s is q0 + q1 t + q2
    // t^2.
    const Samples &tt = swapped ? yy : xx, &ss = swapped ? xx : yy, &linear_t = values[swapped ? 1 : 0],
                  &linear_s = values[swapped ? 0 : 1];
    Samples q0, q1, q2, of_t;
    for (std::size_t n = 0; n < kNodes; ++n) {
      q0[n] = linear_s[n] * linear_s[n] - 4 * ss[n] * values[2][n];
      q1[n] = 2 * linear_s[n] * xy[n] - 4 * ss[n] * linear_t[n];
      q2[n] = xy[n] * xy[n] - 4 * ss[n] * tt[n];
      of_t[n] = q1[n] * q1[n] - 4 * q0[n] * q2[n];
    }
    const auto [low, high] = bounds_of(q1);
    const double smallest_q2 = bounds_of(q2)[0];
    const double t = half_widths[swapped ? 1 : 0];
    if (bounds_of(q0)[0] - t * std::fmax(-low, high) + t * t * std::fmin(0, smallest_q2) > 0) return true;
    // The polynomial q0 + q1 t + q2 t^2 is also positive if q2 > 0 and its own discriminant q1^2 - 4 q0 q2 is negative,
    // or 0 at single values of tau, at which the conic consists of two lines.
    if (!(smallest_q2 > 0) || !(of_t[kNodes / 2] < 0)) continue;
    Samples coefficients;
    to_coefficients(of_t, coefficients);
    std::vector<Root> roots;
    isolate_roots(coefficients, interpolation_error(coefficients, 64 * kUnitRoundoff), roots);
    const auto touches = [&](const Root& root) {
      const auto is_negative = [&](double tau) {
        return std::fabs(tau) >= 1 || evaluate_series(coefficients.data(), kNodes, tau) < 0;
      };
      return root.width > 0 && is_negative(root.at - root.width) && is_negative(root.at + root.width);
    };
    if (std::ranges::all_of(roots, touches)) return true;
  }
  return false;
}

void discriminant(const BoundaryCurve& i, const BoundaryCurve& j, Sampled& result) {
  const double b = size_of_b(i) + size_of_b(j);
  if (!i.is_circle() && !j.is_circle()) {
    for (std::size_t n = 0; n < kNodes; ++n)
      result.values[n] = i.values[0][n] * j.values[1][n] - i.values[1][n] * j.values[0][n];
    result.rounding = 4 * kUnitRoundoff * b * b;
    return;
  }
  const BoundaryCurve &circle = i.is_circle() ? i : j, &other = i.is_circle() ? j : i;
  const double share = other.is_circle() ? 1 : 0;
  double largest = 0;
  for (std::size_t n = 0; n < kNodes; ++n) {
    const double x = share * circle.equation[0][n] - other.equation[0][n],
                 y = share * circle.equation[1][n] - other.equation[1][n],
                 chord = share * circle.equation[2][n] - other.equation[2][n];
    const double at_centre = x * circle.values[0][n] + y * circle.values[1][n] + chord, bb = x * x + y * y;
    result.values[n] = bb * circle.values[2][n] - at_centre * at_centre;
    const double size = bb * circle.size[2] + std::fabs(at_centre);
    largest = size > largest ? size : largest;
  }
  const double c = b * b + size_of_c(i) + size_of_c(j);
  result.rounding = 8 * kUnitRoundoff * (b * b * circle.size[2] + largest * c);
}

void concurrence(const BoundaryCurve& i, const BoundaryCurve& j, const BoundaryCurve& k, Sampled& result) {
  const BoundaryCurve* curves[3] = {&i, &j, &k};
  if (!curves[1]->is_circle() && curves[2]->is_circle()) std::swap(curves[1], curves[2]);
  if (!curves[0]->is_circle() && curves[1]->is_circle()) std::swap(curves[0], curves[1]);
  if (!curves[1]->is_circle() && curves[2]->is_circle()) std::swap(curves[1], curves[2]);
  const auto& [p, q, r] = curves;
  const double b = std::fmax(1, size_of_b(i) + size_of_b(j) + size_of_b(k)),
               c = size_of_c(i) + size_of_c(j) + size_of_c(k);
  const auto &f = p->equation, &g = q->equation, &h = r->equation;
  if (!p->is_circle()) {
    for (std::size_t n = 0; n < kNodes; ++n)
      result.values[n] = f[0][n] * (g[1][n] * h[2][n] - h[1][n] * g[2][n]) +
                         f[1][n] * (g[2][n] * h[0][n] - h[2][n] * g[0][n]) +
                         f[2][n] * (g[0][n] * h[1][n] - h[0][n] * g[1][n]);
    result.rounding = 16 * kUnitRoundoff * b * b * c;
    return;
  }
  const auto rows = [](const std::array<Samples, 3>& equation, const double** to) {
    for (std::size_t coefficient = 0; coefficient < 3; ++coefficient) to[coefficient] = equation[coefficient].data();
  };
  ConcurrenceArguments arguments{{}, {}, {}, q->is_circle() ? 1.0 : 0.0, r->is_circle() ? 1.0 : 0.0};
  rows(f, arguments.first);
  rows(g, arguments.second);
  rows(h, arguments.third);
  const double largest = with_instruction_set(
      [&]<InstructionSet set> { return concurrence_at_nodes<set>(arguments, result.values.data()); });
  result.rounding = 16 * kUnitRoundoff * (largest * b * c + largest * b * b * (b + c));
}

bool has_crossing(const CurveAt& i, const CurveAt& j) {
  const CurveAt &circle = i.is_circle ? i : j, &other = i.is_circle ? j : i;
  const auto [bx, by, e] = chord_of(circle, other);
  return (bx * bx + by * by) * circle.c > e * e;
}

Vector crossing(const CurveAt& i, const CurveAt& j, double branch) {
  if (!i.is_circle && !j.is_circle) {
    const double d = i.u * j.w - i.w * j.u;
    return {(i.w * j.c - j.w * i.c) / d, (i.c * j.u - j.c * i.u) / d};
  }
  const CurveAt &circle = i.is_circle ? i : j, &other = i.is_circle ? j : i;
  const auto [bx, by, e] = chord_of(circle, other);
  const double bb = bx * bx + by * by, d = bb * circle.c - e * e, root = branch * std::sqrt(d > 0 ? d : 0);
  return {circle.u + (-bx * e - by * root) / bb, circle.w + (-by * e + bx * root) / bb};
}

}  // namespace pkm::generic::corner_curves
