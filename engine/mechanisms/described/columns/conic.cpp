#include "engine/mechanisms/described/columns/conic.hpp"

#include <cmath>

#include "engine/math/quadrature.hpp"
#include "engine/math/root_integral.hpp"

namespace pkm::described {
namespace {

double value(std::span<const double> c, double x) {
  double sum = 0;
  for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
  return sum;
}

/// The root of a monotone polynomial between ends of different signs: Newton's method, kept inside by halving.
double root_between(std::span<const double> c, double low, double high, double at_low) {
  double x = 0.5 * (low + high);
  for (int step = 0; step < 80; ++step) {
    double f = 0, slope = 0;
    for (std::size_t i = c.size(); i-- > 0;) {
      slope = slope * x + f;
      f = f * x + c[i];
    }
    if (f == 0) return x;
    ((f > 0) == (at_low > 0) ? low : high) = x;
    double next = x - f / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::fabs(next - x) <= 2e-16) return next;
    x = next;
  }
  return x;
}

/// Whether the Bernstein coefficients on [-1, 1] have one sign: then there is no root.
bool has_one_sign(std::span<const double> c) {
  // of (1 - x)^(n-k) (1 + x)^k, up to positive factors, by c_j sum over i of (-1)^(j-i) C(k, i) C(n-k, j-i)
  static constexpr int kBinomial[5][5] = {
      {1, 0, 0, 0, 0}, {1, 1, 0, 0, 0}, {1, 2, 1, 0, 0}, {1, 3, 3, 1, 0}, {1, 4, 6, 4, 1}};
  static const auto table = [] {
    std::array<std::array<std::array<double, 5>, 5>, 5> b{};  // by degree, k, j: x^j over Bernstein number k
    for (int n = 0; n < 5; ++n)
      for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j) {
          double sum = 0;  // polar form of x^j at k ones and n - k minus ones
          for (int i = 0; i <= j; ++i)
            if (i <= k && j - i <= n - k) sum += kBinomial[k][i] * kBinomial[n - k][j - i] * ((j - i) % 2 ? -1 : 1);
          b[static_cast<std::size_t>(n)][static_cast<std::size_t>(k)][static_cast<std::size_t>(j)] =
              sum / kBinomial[n][j];
        }
    return b;
  }();
  const std::size_t n = c.size() - 1;
  bool positive = true, negative = true;
  for (std::size_t k = 0; k <= n; ++k) {
    double b = 0;
    for (std::size_t j = 0; j <= n; ++j) b += table[n][k][j] * c[j];
    positive = positive && b > 0;
    negative = negative && b < 0;
  }
  return positive || negative;
}

constexpr double kNothing = 1e-14;  // of the greatest coefficient
constexpr double kStraight = 1e-5;  // of a conic's coefficients: s^2 counts that little, and formulas divide by it

bool bends(const Conic& P) { return std::fabs(P.c[5]) > kStraight * P.scale; }

/// 12 nodes are as good as the last bit where conics bend little.
const GaussRule& rule() {
  static const GaussRule gauss = gauss_legendre(12);
  return gauss;
}

/// Integrals of R = sqrt(q), 1/R, w/R and w^2/R over [-h/2, h/2].
struct Moments {
  double F, J0, J1, J2;
};

/// @param r, r2      R at both ends
/// @param curvature  the coefficient of w^2 in q
/// With y = q_2 h^2 / s^2, s = r + r2, d = r2 - r, and Y = y / (1 + sqrt(1 - y))^2,
///
///   w = (h/2 (1 - Y) u + c (1 - u^2)) / (1 - Y u^2),  dw/R = k du / (1 - Y u^2),  k = h (1 + Y) / s,  c = -k d / 4
///
/// for u in [-1, 1]: rational functions of u, which a rule with 12 nodes integrates to the last digits for |Y| < 0.3.
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
  Moments sum{root_integral(h, r, r2, curvature), 0, 0, 0};
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
  const auto root = [&](double w) {  // 0 at an end that is a root but for rounding
    const double t = middle + w, square = q[0] + t * (q[1] + t * q[2]);
    return square > noise ? std::sqrt(square) : 0;
  };
  const double h = arc.to - arc.from;
  return moments(h, root(-h / 2), root(h / 2), q[2], root);
}

}  // namespace

Roots roots_of(const std::array<double, 3>& c) {
  const auto [c0, b, a] = c;
  if (a == 0) {
    if (b == 0) return {};
    return {{-c0 / b, 0}, 1};
  }
  const double discriminant = b * b - 4 * a * c0;
  if (!(discriminant >= 0)) return {};
  const double q = -0.5 * (b + (b < 0 ? -1 : 1) * std::sqrt(discriminant));
  const double r1 = q / a, r2 = q == 0 ? r1 : c0 / q;
  return {{r1 < r2 ? r1 : r2, r1 < r2 ? r2 : r1}, 2};
}

std::size_t roots_between(std::span<const double> coefficients, std::array<double, 8>& roots) {
  double scale = 0;
  for (const double c : coefficients) scale = std::fabs(c) > scale ? std::fabs(c) : scale;
  while (!coefficients.empty() && std::fabs(coefficients.back()) <= kNothing * scale)
    coefficients = coefficients.first(coefficients.size() - 1);
  const std::size_t degree = coefficients.empty() ? 0 : coefficients.size() - 1;
  std::size_t count = 0;
  const auto keep = [&](double x) {
    if (std::fabs(x) <= 1 && count < roots.size()) roots[count++] = x;
  };
  if (degree == 0 || has_one_sign(coefficients)) return 0;
  if (degree == 1) {
    keep(-coefficients[0] / coefficients[1]);
    return count;
  }
  if (degree == 2) {
    const Roots found = roots_of({coefficients[0], coefficients[1], coefficients[2]});
    for (int i = 0; i < found.count; ++i) keep(found.s[static_cast<std::size_t>(i)]);
    if (found.count == 0) {  // it may be a double one
      const double x = -0.5 * coefficients[1] / coefficients[2];
      if (std::fabs(value(coefficients, x)) <= 1e-13 * scale) keep(x);
    }
    return count;
  }
  std::array<double, 4> slope{};
  for (std::size_t i = 1; i <= degree; ++i) slope[i - 1] = static_cast<double>(i) * coefficients[i];
  std::array<double, 8> turns{};
  const std::size_t turn_count = roots_between(std::span(slope).first(degree), turns);
  double low = -1, at_low = value(coefficients, low);
  for (std::size_t i = 0; i <= turn_count; ++i) {
    const double high = i < turn_count ? turns[i] : 1, at_high = value(coefficients, high);
    if ((at_low < 0) != (at_high < 0))
      keep(root_between(coefficients, low, high, at_low));
    else if (i < turn_count && std::fabs(at_high) <= 1e-13 * scale)
      keep(high);
    low = high;
    at_low = at_high;
  }
  return count;
}

std::size_t crossings(const Conic& P, const Conic& Q, std::array<Point, 16>& points) {
  std::size_t count = 0;
  const auto keep = [&](double t, double s) {
    if (std::fabs(s) <= 1 + 1e-9 && count < points.size()) points[count++] = {t, s};
  };
  std::array<double, 8> at{};
  // Of the pencil, the one without s^2: d0(t) + d1(t) s = 0. It is put into the one that bends more.
  const bool first = std::fabs(P.c[5]) * Q.scale >= std::fabs(Q.c[5]) * P.scale;
  const Conic &A = first ? P : Q, &B = first ? Q : P;
  std::array<double, 6> d = B.c;
  double size = B.scale;
  if (B.c[5] != 0) {
    for (std::size_t i = 0; i < 6; ++i) d[i] = B.c[i] * A.c[5] - A.c[i] * B.c[5];
    size = B.scale * A.scale;
  }
  const double d1 = std::fabs(d[2]) + std::fabs(d[4]);
  if (std::fabs(d[0]) > std::fabs(d[1]) + std::fabs(d[3]) + d1 * (1 + 1e-9)) return 0;  // nowhere in the square
  if (d1 <= kNothing * size) {
    if (std::fabs(d[1]) + std::fabs(d[3]) <= kNothing * size) return 0;  // nowhere, or everywhere
    const std::array<double, 3> of_t{d[0], d[1], d[3]};
    const std::size_t found = roots_between(of_t, at);
    for (std::size_t i = 0; i < found; ++i) {
      const Roots roots = roots_of(A.along(at[i]));
      for (int k = 0; k < roots.count; ++k) keep(at[i], roots.s[static_cast<std::size_t>(k)]);
    }
    return count;
  }
  // p0 d1^2 - p1 d0 d1 + p2 d0^2
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

void add_slopes_of_area(const Conic& P, const Arc& arc, double factor, std::array<double, 6>& slopes) {
  const double h = arc.to - arc.from;
  if (!bends(P)) {
    for (std::size_t i = 0; i < rule().node.size(); ++i) {
      const double t = arc.from + h * rule().node[i], s = place_on(P, arc.root, t);
      const double g = -factor * h * rule().weight[i] / (P.c[2] + t * P.c[4] + 2 * s * P.c[5]);
      const double powers[6] = {1, t, s, t * t, t * s, s * s};
      for (std::size_t k = 0; k < 6; ++k) slopes[k] += g * powers[k];
    }
    return;
  }
  // On the arc, s = a + a1 w + b R with w = t - m, and P_s = 2 c5 b R.
  const auto [F, J0, J1, J2] = moments_of(P, arc);
  const double m = 0.5 * (arc.from + arc.to), a = -0.5 * (P.c[2] + m * P.c[4]) / P.c[5], a1 = -0.5 * P.c[4] / P.c[5];
  const double b = (arc.root == 0 ? -0.5 : 0.5) / std::fabs(P.c[5]), g = -factor / (2 * P.c[5] * b);
  slopes[0] += g * J0;
  slopes[1] += g * (m * J0 + J1);
  slopes[2] += g * (a * J0 + a1 * J1 + b * h);
  slopes[3] += g * (m * m * J0 + 2 * m * J1 + J2);
  slopes[4] += g * (m * a * J0 + (m * a1 + a) * J1 + a1 * J2 + b * m * h);
  slopes[5] += g * (a * a * J0 + 2 * a * a1 * J1 + a1 * a1 * J2 + 2 * a * b * h + b * b * F);
}

}  // namespace pkm::described
