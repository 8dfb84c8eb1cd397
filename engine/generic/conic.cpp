#include "engine/generic/conic.hpp"

#include <cmath>

#include "engine/math/quadrature.hpp"
#include "engine/math/sqrt_quadratic_integral.hpp"

namespace pkm::generic {
namespace {

// Coefficients of s^2 that are smaller, relative to Conic::scale, are treated as 0, because formulas divide by them.
constexpr double kStraight = 1e-5;

bool bends(const Conic& P) { return std::fabs(P.c[5]) > kStraight * P.scale; }

/// Gauss-Legendre rule with 12 nodes; its error for arcs of small curvature is below the rounding errors.
const GaussRule& rule() {
  static const GaussRule gauss = gauss_legendre(12);
  return gauss;
}

/// Integrals over w in [-h/2, h/2] of R = sqrt(q), 1/R, w/R and w^2/R, where q is a quadratic polynomial in w.
struct Moments {
  double F, J0, J1, J2;
};

/// Computes the integrals F, J0, J1 and J2 of R = sqrt(q), 1/R, w/R and w^2/R over w in [-h/2, h/2], where q is a
/// quadratic polynomial in w.
/// @param r, r2  values of R at the lower and the upper endpoint
/// @param curvature  the coefficient of w^2 in q
/// With y = q_2 h^2 / s^2, s = r + r2, d = r2 - r, and Y = y / (1 + sqrt(1 - y))^2,
///
///   w = (h/2 (1 - Y) u + c (1 - u^2)) / (1 - Y u^2),  dw/R = k du / (1 - Y u^2),  k = h (1 + Y) / s,  c = -k d / 4
///
/// for u in [-1, 1]: the integrands are rational functions of u, which a Gauss rule with 12 nodes integrates to
/// rounding accuracy for |Y| < 0.3.
template <class RootAt>
Moments moments(double h, double r, double r2, double curvature, const RootAt& root_at, double centre = 0,
                int depth = 0) {
  const double s = r + r2, d = r2 - r, y = curvature * h * h / (s * s);
  if (depth < 40 && !(y >= -1.1 && y <= 0.7)) {
    const double middle = root_at(centre);
    if (middle > 0) {
      const Moments a = moments(h / 2, r, middle, curvature, root_at, centre - h / 4, depth + 1);
      const Moments b = moments(h / 2, middle, r2, curvature, root_at, centre + h / 4, depth + 1);
      const double m = h / 4;
      return {a.F + b.F, a.J0 + b.J0, a.J1 + b.J1 + m * (b.J0 - a.J0),
              a.J2 + b.J2 + 2 * m * (b.J1 - a.J1) + m * m * (a.J0 + b.J0)};
    }
  }
  if (!(s > 0)) return {0, 0, 0, 0};
  const double Y = y / ((1 + std::sqrt(1 - y)) * (1 + std::sqrt(1 - y))), k = h * (1 + Y) / s, c = -k * d / 4;
  Moments sum{sqrt_quadratic_integral(h, r, r2, curvature), 0, 0, 0};
  for (std::size_t i = 6; i < 12; ++i) {
    const double u = 2 * rule().node[i] - 1, weight = 4 * rule().weight[i], v = 1 - u * u, D = 1 / (1 - Y * u * u);
    sum.J0 += weight * D;
    sum.J1 += weight * v * D * D;
    sum.J2 += weight * (h * h / 4 * (1 - Y) * (1 - Y) * u * u + c * c * v * v) * D * D * D;
  }
  sum.J0 *= k;
  sum.J1 *= k * c;
  sum.J2 *= k;
  return sum;
}

Moments moments_of(const Conic& P, const Arc& arc) {
  const auto q = P.discriminant();
  const double middle = 0.5 * (arc.from + arc.to);
  const double noise = 4e-15 * (std::fabs(q[0]) + std::fabs(q[1]) + std::fabs(q[2]));
  // Square root of q at w; 0 if w is an endpoint that is a root of q up to rounding errors.
  const auto root = [&](double w) {
    const double t = middle + w, square = q[0] + t * (q[1] + t * q[2]);
    return square > noise ? std::sqrt(square) : 0;
  };
  const double h = arc.to - arc.from;
  return moments(h, root(-h / 2), root(h / 2), q[2], root);
}

}  // namespace

std::size_t crossings(const Conic& P, const Conic& Q, std::array<Point, 16>& points) {
  std::size_t count = 0;
  const auto keep = [&](double t, double s) {
    if (std::fabs(s) <= 1 + 1e-9 && count < points.size()) points[count++] = {t, s};
  };
  std::array<double, 8> at{};
  // The linear combination of the conics without s^2, d0(t) + d1(t) s = 0, is substituted into the conic with the
  // larger curvature.
  const bool first = std::fabs(P.c[5]) * Q.scale >= std::fabs(Q.c[5]) * P.scale;
  const Conic &A = first ? P : Q, &B = first ? Q : P;
  std::array<double, 6> d = B.c;
  double size = B.scale;
  if (B.c[5] != 0) {
    for (std::size_t i = 0; i < 6; ++i) d[i] = B.c[i] * A.c[5] - A.c[i] * B.c[5];
    size = B.scale * A.scale;
  }
  const double d1 = std::fabs(d[2]) + std::fabs(d[4]);
  // If the linear combination d0(t) + d1(t) s has no zero in the square, the conics do not intersect there.
  if (std::fabs(d[0]) > std::fabs(d[1]) + std::fabs(d[3]) + d1 * (1 + 1e-9)) return 0;
  if (d1 <= kNegligibleCoefficient * size) {
    if (std::fabs(d[1]) + std::fabs(d[3]) <= kNegligibleCoefficient * size)
      return 0;  // the conics do not intersect, or are identical
    const std::array<double, 3> of_t{d[0], d[1], d[3]};
    const std::size_t found = roots_between(of_t, at);
    for (std::size_t i = 0; i < found; ++i) {
      const Roots roots = roots_of(A.along(at[i]));
      for (int k = 0; k < roots.count; ++k) keep(at[i], roots.s[static_cast<std::size_t>(k)]);
    }
    return count;
  }
  // coefficients R of the polynomial in t whose roots are the intersections: p0 d1^2 - p1 d0 d1 + p2 d0^2
  const std::array<double, 3> d0{d[0], d[1], d[3]}, p0{A.c[0], A.c[1], A.c[3]};
  const std::array<double, 3> d11{d[2] * d[2], 2 * d[2] * d[4], d[4] * d[4]};
  const std::array<double, 3> pd{A.c[2] * d[2], A.c[2] * d[4] + A.c[4] * d[2], A.c[4] * d[4]};
  std::array<double, 5> R{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) R[i + j] += p0[i] * d11[j] - pd[i] * d0[j] + A.c[5] * d0[i] * d0[j];
  const std::size_t found = roots_between(R, at);
  for (std::size_t i = 0; i < found; ++i) {
    const double t = at[i], below = d[2] + t * d[4];
    if (std::fabs(below) > 1e-6 * size) {
      keep(t, -(d[0] + t * (d[1] + t * d[3])) / below);
      continue;
    }
    const Roots roots = roots_of(A.along(t));
    for (int k = 0; k < roots.count; ++k) keep(t, roots.s[static_cast<std::size_t>(k)]);
  }
  return count;
}

double place_on(const Conic& P, int root, double t) {
  const auto [c0, b, a] = P.along(t);
  if (a == 0) return -c0 / b;
  const double square = b * b - 4 * a * c0, R = square > 0 ? std::sqrt(square) : 0;
  const double q = -0.5 * (b + (b < 0 ? -R : R));
  const double r1 = q / a, r2 = q == 0 ? r1 : c0 / q;
  return (root == 0) == (r1 < r2) ? r1 : r2;
}

double area_below(const Conic& P, const Arc& arc) {
  const double h = arc.to - arc.from;
  if (!bends(P)) {
    double sum = 0;
    for (std::size_t i = 0; i < rule().node.size(); ++i)
      sum += rule().weight[i] * place_on(P, arc.root, arc.from + h * rule().node[i]);
    return sum * h;
  }
  const double middle = -0.5 * (P.c[2] + 0.5 * (arc.from + arc.to) * P.c[4]) / P.c[5];
  return middle * h + (arc.root == 0 ? -0.5 : 0.5) / std::fabs(P.c[5]) * moments_of(P, arc).F;
}

void add_gradient_of_area(const Conic& P, const Arc& arc, double factor, std::array<double, 6>& gradient) {
  const double h = arc.to - arc.from;
  if (!bends(P)) {
    for (std::size_t i = 0; i < rule().node.size(); ++i) {
      const double t = arc.from + h * rule().node[i], s = place_on(P, arc.root, t);
      const double g = -factor * h * rule().weight[i] / (P.c[2] + t * P.c[4] + 2 * s * P.c[5]);
      const double powers[6] = {1, t, s, t * t, t * s, s * s};
      for (std::size_t k = 0; k < 6; ++k) gradient[k] += g * powers[k];
    }
    return;
  }
  // On the arc, s = a + a1 w + b R with w = t - m; the derivative of P with respect to s is 2 c5 b R.
  const auto [F, J0, J1, J2] = moments_of(P, arc);
  const double m = 0.5 * (arc.from + arc.to), a = -0.5 * (P.c[2] + m * P.c[4]) / P.c[5], a1 = -0.5 * P.c[4] / P.c[5];
  const double b = (arc.root == 0 ? -0.5 : 0.5) / std::fabs(P.c[5]), g = -factor / (2 * P.c[5] * b);
  gradient[0] += g * J0;
  gradient[1] += g * (m * J0 + J1);
  gradient[2] += g * (a * J0 + a1 * J1 + b * h);
  gradient[3] += g * (m * m * J0 + 2 * m * J1 + J2);
  gradient[4] += g * (m * a * J0 + (m * a1 + a) * J1 + a1 * J2 + b * m * h);
  gradient[5] += g * (a * a * J0 + 2 * a * a1 * J1 + a1 * a1 * J2 + 2 * a * b * h + b * b * F);
}

}  // namespace pkm::generic
