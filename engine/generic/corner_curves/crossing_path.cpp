#include "engine/generic/corner_curves/crossing_path.hpp"

#include <algorithm>

#include "engine/generic/corner_curves/root_isolation.hpp"
#include "engine/generic/polynomial.hpp"

namespace pkm::generic::corner_curves {
namespace {

constexpr int kMaxPathHalvings = 6;
constexpr double kFollowed = 1e-11;  // maximum interpolation error of a path
constexpr double kSmallStep = 1e-8;  // step of Newton's method, which converges quadratically

/// A quadratic form, by its coefficients of W^2, X W, Y W, X^2, X Y and Y^2.
using Form = std::array<double, 6>;

double dot(const Homogeneous& p, const Homogeneous& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
Homogeneous cross(const Homogeneous& p, const Homogeneous& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
Homogeneous normalised(const Homogeneous& p) {
  const double size = std::sqrt(dot(p, p));
  return {p[0] / size, p[1] / size, p[2] / size};
}

Form form_of(const CurveAt& curve) {
  if (curve.is_circle) return {curve.u * curve.u + curve.w * curve.w - curve.c, -2 * curve.u, -2 * curve.w, 1, 0, 1};
  return {curve.c, curve.u, curve.w, curve.xx, curve.xy, curve.yy};
}
double value_of(const Form& f, const Homogeneous& p) {
  const auto [x, y, w] = p;
  return w * (f[0] * w + f[1] * x + f[2] * y) + x * (f[3] * x + f[4] * y) + f[5] * y * y;
}
Homogeneous gradient_of(const Form& f, const Homogeneous& p) {
  const auto [x, y, w] = p;
  return {2 * f[3] * x + f[4] * y + f[1] * w, f[4] * x + 2 * f[5] * y + f[2] * w, f[1] * x + f[2] * y + 2 * f[0] * w};
}
double determinant_of(const Form& f) {
  return f[0] * (f[3] * f[5] - 0.25 * f[4] * f[4]) +
         0.25 * (f[1] * f[2] * f[4] - f[2] * f[2] * f[3] - f[1] * f[1] * f[5]);
}

/// Two conics that have the same crossings as two given conics; they are orthogonal to each other and of magnitude 1,
/// and therefore linearly independent even where the given conics nearly coincide.
struct Pencil {
  Form f{}, g{};
  bool is_defined = false;

  Pencil(const CurveAt& conic, const CurveAt& other) : f(form_of(conic)), g(form_of(other)) {
    const auto normalise = [](Form& form) {
      double square = 0;
      for (const double each : form) square += each * each;
      for (double& each : form) each /= std::sqrt(square);
      return square > 0;
    };
    if (!normalise(f) || !normalise(g)) return;
    double along = 0;
    for (std::size_t i = 0; i < 6; ++i) along += f[i] * g[i];
    for (std::size_t i = 0; i < 6; ++i) g[i] -= along * f[i];
    is_defined = normalise(g);
  }

  /// Improves a crossing by Newton's method until a step is so small that the next one would be below rounding errors.
  /// @return magnitude of the last step
  double improve(Homogeneous& p, int steps) const {
    double size = 1;
    for (int step = 0; step < steps && size > kSmallStep; ++step) {
      const Homogeneous a = gradient_of(f, p), b = gradient_of(g, p), bp = cross(b, p), pa = cross(p, a);
      const double at_f = value_of(f, p), at_g = value_of(g, p), d = dot(a, bp);
      if (d == 0) return 1;
      Homogeneous next;
      size = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double change = -(at_f * bp[i] + at_g * pa[i]) / d;
        next[i] = p[i] + change;
        size = std::max(size, std::fabs(change));
      }
      if (!(size < 1)) return 1;
      p = normalised(next);
    }
    return size;
  }
};

/// Crossings of two conics. In coordinates (X', Y', W') with t = X'/W' and s = Y'/W', one conic of the pencil is linear
/// in s, and its root s(t) leaves a polynomial of degree four in t. The coordinates are rotated by arbitrary angles, so
/// that two crossings of symmetric curves do not have the same t.
std::size_t crossings_of(const Pencil& pencil, std::array<Homogeneous, 4>& points) {
  // Columns of the matrix that rotates the coordinates.
  static constexpr std::array<Homogeneous, 3> kAxes = {
      Homogeneous{-0.727501992768388, -0.17051969862555966, 0.6645779735280675},
      Homogeneous{-0.3756511949969291, -0.7115472605304435, -0.5937900939970288},
      Homogeneous{0.5741315443479861, -0.681632986593423, 0.4535961214255773}};
  const auto rotated = [](const Form& f) {
    Form r;
    constexpr std::size_t kPlaces[6][2] = {{2, 2}, {0, 2}, {1, 2}, {0, 0}, {0, 1}, {1, 1}};
    for (std::size_t i = 0; i < 6; ++i) {
      const auto [a, b] = kPlaces[i];
      r[i] = dot(kAxes[a], gradient_of(f, kAxes[b])) * (a == b ? 0.5 : 1);
    }
    return r;
  };
  Form a = rotated(pencil.f), b = rotated(pencil.g);
  if (std::fabs(a[5]) < std::fabs(b[5])) std::swap(a, b);
  Form d;  // coefficients of the conic d0(t) + d1(t) s = 0, which is linear in s
  for (std::size_t i = 0; i < 6; ++i) d[i] = b[i] * a[5] - a[i] * b[5];
  const std::array<double, 3> d0{d[0], d[1], d[3]}, p0{a[0], a[1], a[3]};
  const std::array<double, 3> d11{d[2] * d[2], 2 * d[2] * d[4], d[4] * d[4]};
  const std::array<double, 3> pd{a[2] * d[2], a[2] * d[4] + a[4] * d[2], a[4] * d[4]};
  std::array<double, 5> r{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) r[i + j] += p0[i] * d11[j] - pd[i] * d0[j] + a[5] * d0[i] * d0[j];
  std::size_t count = 0;
  std::array<double, 8> roots;
  for (const bool reversed : {false, true}) {  // first the roots with |t| < 1, then those with |1/t| < 1
    const std::size_t found = sign_changes(r, roots);
    for (std::size_t i = 0; i < found && count < 4; ++i) {
      const double x = reversed ? 1 : roots[i], w = reversed ? roots[i] : 1;
      const double d1 = d[2] * w + d[4] * x;
      const Homogeneous q = {x * d1, -(d0[0] * w * w + d0[1] * x * w + d0[2] * x * x), w * d1};
      Homogeneous p{};
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) p[k] += kAxes[axis][k] * q[axis];
      points[count] = normalised(p);
      if (pencil.improve(points[count], 4) < 1e-6) ++count;
    }
    std::ranges::reverse(r);
  }
  return count;
}

/// The conic along a line, h = a + b l + c l^2 at the distance l from the line's foot point.
struct AlongLine {
  double a, b, c;
  Vector foot, direction;

  AlongLine(const CurveAt& conic, const CurveAt& line)
      : foot{-line.c * line.u, -line.c * line.w}, direction{line.w, -line.u} {
    const Vector slope = conic.gradient(foot);
    a = conic.h(foot);
    b = slope.x * direction.x + slope.y * direction.y;
    c = conic.quadratic(direction);
  }
  double discriminant() const { return b * b - 4 * a * c; }
  /// The point of the line at the distance l = numerator/denominator from its foot point.
  Homogeneous point(double numerator, double denominator) const {
    return normalised(
        {denominator * foot.x + numerator * direction.x, denominator * foot.y + numerator * direction.y, denominator});
  }
};

}  // namespace

double homogeneous_value(const CurveAt& curve, const Homogeneous& p) { return value_of(form_of(curve), p); }

std::size_t find_crossings(const CurveAt& conic, const CurveAt& other, std::array<Homogeneous, 4>& points) {
  if (other.is_circle || other.is_conic) {
    const Pencil pencil(conic, other);
    return pencil.is_defined ? crossings_of(pencil, points) : 0;
  }
  const AlongLine along(conic, other);
  const double square = along.discriminant();
  if (!(square > 0)) return 0;
  const double q = -0.5 * (along.b + (along.b < 0 ? -1 : 1) * std::sqrt(square));
  points[0] = along.point(q, along.c);
  points[1] = along.point(along.a, q);
  return 2;
}

void conic_discriminant(const BoundaryCurve& conic, const BoundaryCurve& other, Sampled& result) {
  double largest = 0;
  for (std::size_t n = 0; n < kNodes; ++n) {
    const CurveAt f = conic.at_node(n), g = other.at_node(n);
    if (!g.is_circle && !g.is_conic) {
      const AlongLine along(f, g);
      result.values[n] = along.discriminant();
      const double size = 1 + std::fabs(g.c);
      largest = std::max(largest, size * size * (1 + std::fabs(along.b)));
      continue;
    }
    // Discriminant of the cubic polynomial det(x f + g) = a x^3 + b x^2 + c x + d.
    const Pencil pencil(f, g);
    Form sum, difference;
    for (std::size_t i = 0; i < 6; ++i) {
      sum[i] = pencil.g[i] + pencil.f[i];
      difference[i] = pencil.g[i] - pencil.f[i];
    }
    const double a = determinant_of(pencil.f), d = determinant_of(pencil.g), above = determinant_of(sum),
                 below = determinant_of(difference);
    const double b = 0.5 * (above + below) - d, c = 0.5 * (above - below) - a;
    result.values[n] = 18 * a * b * c * d - 4 * b * b * b * d + b * b * c * c - 4 * a * c * c * c - 27 * a * a * d * d;
    const double size = std::fmax(std::fmax(std::fabs(a), std::fabs(b)), std::fmax(std::fabs(c), std::fabs(d)));
    largest = std::max(largest, 30 * size * size * size);
  }
  result.rounding = 32 * kUnitRoundoff * largest;
}

double refine_contact(const BoundaryCurve& conic, const BoundaryCurve& other, double tau) {
  constexpr double kBeside = 1e-6;  // distance from the root at which the two crossings that merge are computed
  constexpr double kStep = 1e-5;    // step of the numerical derivatives with respect to tau
  if (!other.is_circle() && !other.is_conic()) return tau;
  std::array<Homogeneous, 4> points, found;
  std::size_t count = 0;
  for (const double side : {-kBeside, kBeside}) {
    const std::size_t here = find_crossings(conic.at(tau + side), other.at(tau + side), found);
    if (here <= count) continue;
    count = here;
    points = found;
  }
  Homogeneous contact{};  // midpoint of the two crossings that are closest to each other
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = i + 1; k < count; ++k) {
      const double cosine = dot(points[i], points[k]);
      if (std::fabs(cosine) <= largest) continue;
      largest = std::fabs(cosine);
      for (std::size_t axis = 0; axis < 3; ++axis)
        contact[axis] = points[i][axis] + (cosine < 0 ? -1 : 1) * points[k][axis];
    }
  // Newton's method for three equations: h = 0 for both curves, and parallel gradients.
  double at = tau, x = contact[0] / contact[2], y = contact[1] / contact[2];
  for (int step = 0; step < 6; ++step) {
    const CurveAt f = conic.at(at), g = other.at(at);
    const CurveAt f1 = conic.at(at + kStep), f0 = conic.at(at - kStep), g1 = other.at(at + kStep),
                  g0 = other.at(at - kStep);
    const Vector p{x, y}, a = f.gradient(p), b = g.gradient(p);
    const double g_xx = g.is_circle ? 1 : g.xx, g_yy = g.is_circle ? 1 : g.yy;
    const Homogeneous by_f = {a.x, a.y, (f1.h(p) - f0.h(p)) / (2 * kStep)},
                      by_g = {b.x, b.y, (g1.h(p) - g0.h(p)) / (2 * kStep)},
                      by_d = {
                          2 * f.xx * b.y + a.x * g.xy - f.xy * b.x - 2 * a.y * g_xx,
                          f.xy * b.y + 2 * a.x * g_yy - 2 * f.yy * b.x - a.y * g.xy,
                          (determinant(f1.gradient(p), g1.gradient(p)) - determinant(f0.gradient(p), g0.gradient(p))) /
                              (2 * kStep)};
    const double value_f = f.h(p), value_g = g.h(p), value_d = determinant(a, b);
    const Homogeneous fg = cross(by_f, by_g), gd = cross(by_g, by_d), df = cross(by_d, by_f);
    const double volume = dot(by_f, gd);
    Homogeneous change;
    for (std::size_t i = 0; i < 3; ++i) change[i] = -(value_f * gd[i] + value_g * df[i] + value_d * fg[i]) / volume;
    x += change[0];
    y += change[1];
    at += change[2];
    if (!(std::fabs(at - tau) < kBeside)) return tau;
    if (std::fabs(change[2]) < 1e-15) break;
  }
  return at;
}

void sample_curve(const BoundaryCurve& curve, const Subinterval<double>& range, const Samples& tau,
                  std::array<CurveAt, kNodes>& at) {
  if (range.lower == -1 && range.upper == 1 && !range.sqrt_at_lower && !range.sqrt_at_upper) {
    for (std::size_t n = 0; n < kNodes; ++n) at[n] = curve.at_node(n);
    return;
  }
  std::array<double, 3 * kPoints> linear, quadratic{};
  for (std::size_t first = 0; first < kNodes; first += kPoints) {
    evaluate_at_points(curve.series, curve.terms, &tau[first], linear.data());
    if (curve.is_conic()) evaluate_at_points(curve.quadratic->series, curve.terms, &tau[first], quadratic.data());
    for (std::size_t q = 0; q < kPoints; ++q)
      at[first + q] = {curve.is_circle(),         linear[q],   linear[kPoints + q], linear[2 * kPoints + q],
                       curve.is_conic(),          curve.swaps, quadratic[q],        quadratic[kPoints + q],
                       quadratic[2 * kPoints + q]};
  }
}

Vector CrossingPath::at(double tau, const CurveAt& first, const CurveAt& second) const {
  const double y = (tau - range.lower) / (range.upper - range.lower);
  const double s = range.sqrt_at_lower   ? std::sqrt(std::fmax(0, y))
                   : range.sqrt_at_upper ? 1 - std::sqrt(std::fmax(0, 1 - y))
                                         : y;
  const double w = evaluate_series(series[2].data(), terms, 2 * s - 1);
  Vector p{evaluate_series(series[0].data(), terms, 2 * s - 1) / w,
           evaluate_series(series[1].data(), terms, 2 * s - 1) / w};
  for (int step = 0; step < 2; ++step) {
    const Vector g = first.gradient(p), h = second.gradient(p);
    const double at_first = first.h(p), at_second = second.h(p), d = determinant(g, h);
    const Vector change{(at_second * g.y - at_first * h.y) / d, (at_first * h.x - at_second * g.x) / d};
    // Where the two curves touch each other, a step of Newton's method would magnify rounding errors.
    if (!(std::fabs(change.x) + std::fabs(change.y) < 1e-6)) break;
    p = {p.x + change.x, p.y + change.y};
  }
  return p;
}

bool follow_crossings(const BoundaryCurve& conic, const BoundaryCurve& other, const Subinterval<double>& range,
                      std::vector<CrossingPath>& paths) {
  const auto follow = [&](const auto& self, const Subinterval<double>& part, int halvings) -> bool {
    Samples tau;
    for (std::size_t n = 0; n < kNodes; ++n) tau[n] = map_node(part, 0.5 * (1 + chebyshev_nodes()[n])).point;
    std::array<CurveAt, kNodes> f, g;
    sample_curve(conic, part, tau, f);
    sample_curve(other, part, tau, g);
    std::array<std::array<Homogeneous, 4>, kNodes> points;
    const bool is_line = !g[0].is_circle && !g[0].is_conic;
    const std::size_t count = find_crossings(f[0], g[0], points[0]);
    bool is_followed = true;
    for (std::size_t n = 1; n < kNodes && is_followed; ++n) {
      const auto& before = points[n - 1];
      auto& here = points[n];
      bool is_improved = !is_line && n + 1 < kNodes;
      // If is_improved, start from the crossings at the previous node; at the last node, all crossings are computed
      // without start values.
      if (is_improved) {
        const Pencil pencil(f[n], g[n]);
        for (std::size_t k = 0; k < count && is_improved; ++k) {
          here[k] = before[k];
          is_improved = pencil.improve(here[k], 8) <= kSmallStep && dot(here[k], before[k]) > 0.9;
          for (std::size_t other_path = 0; other_path < k; ++other_path)
            is_improved = is_improved && std::fabs(dot(here[k], here[other_path])) < 1 - 1e-12;
        }
      }
      if (is_improved) continue;
      std::array<Homogeneous, 4> found;
      is_followed = find_crossings(f[n], g[n], found) == count;
      std::array<bool, 4> is_taken{};
      for (std::size_t k = 0; k < count && is_followed; ++k) {
        std::size_t nearest = 0;
        for (std::size_t i = 1; i < count; ++i)
          if (std::fabs(dot(found[i], before[k])) > std::fabs(dot(found[nearest], before[k]))) nearest = i;
        is_followed = !is_taken[nearest];
        is_taken[nearest] = true;
        here[k] = found[nearest];
        if (dot(here[k], before[k]) < 0)
          for (double& each : here[k]) each = -each;
      }
    }
    const std::size_t first = paths.size();
    for (std::size_t k = 0; k < count && is_followed; ++k) {
      CrossingPath& path = paths.emplace_back();
      path.range = part;
      path.terms = 1;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t n = 0; n < kNodes; ++n) path.values[i][n] = points[n][k][i];
        to_coefficients(path.values[i], path.series[i]);
        path.error = std::max(path.error, interpolation_error(path.series[i], 1e-15));
        path.terms = std::max(path.terms, significant_terms(path.series[i], kNodes, 1e-15));
      }
      is_followed = path.error <= kFollowed;
    }
    if (is_followed) return true;
    paths.resize(first);
    if (halvings == kMaxPathHalvings) return false;
    for (const Subinterval<double>& half : halves(part))
      if (!self(self, half, halvings + 1)) return false;
    return true;
  };
  return follow(follow, range, 0);
}

}  // namespace pkm::generic::corner_curves
