#include "engine/generic/edges/torus_function.hpp"

#include "engine/math/roots.hpp"

namespace pkm::generic::edges {
namespace {

/// Coefficients [i][j] of the products of the i-th of 1, cos q, sin q and the j-th of 1, cos b, sin b.
using Bilinear = std::array<std::array<double, 3>, 3>;
using Coefficients = std::array<Trigonometric, 5>;

/// kProduct[i][j]: product of the i-th and the j-th of the functions 1, cos t, sin t, as a trigonometric polynomial.
constexpr Trigonometric kProduct[3][3] = {{{1, 0, 0, 0, 0}, {0, 1, 0, 0, 0}, {0, 0, 1, 0, 0}},
                                          {{0, 1, 0, 0, 0}, {0.5, 0, 0, 0.5, 0}, {0, 0, 0, 0, 0.5}},
                                          {{0, 0, 1, 0, 0}, {0, 0, 0, 0, 0.5}, {0.5, 0, 0, -0.5, 0}}};

/// Adds factor times the product of the functions x and y to `to`.
void add_product(const Bilinear& x, const Bilinear& y, double factor, Coefficients& to) {
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < 9; ++j) {
      const double product = factor * x[i / 3][i % 3] * y[j / 3][j % 3];
      if (product == 0) continue;
      const Trigonometric &q = kProduct[i / 3][j / 3], &b = kProduct[i % 3][j % 3];
      for (std::size_t m = 0; m < 5; ++m)
        for (std::size_t n = 0; n < 5 && q[m] != 0; ++n) to[m][n] += product * q[m] * b[n];
    }
}

/// The function P . v + k of a point of a torus as a bilinear polynomial of its angles, where P is the vector from the
/// centre of the torus to the point.
Bilinear along(const PreparedBody& torus, const Vector3& v, double k) {
  const double x = dot(torus.zero, v), y = dot(torus.beside, v);
  return {{{k, 0, torus.radius * dot(torus.axis, v)},
           {torus.crank * x, torus.radius * x, 0},
           {torus.crank * y, torus.radius * y, 0}}};
}

/// Values of 1, cos t, sin t, cos 2t, sin 2t [0], and their derivatives [1].
std::array<Trigonometric, 2> basis(double t) {
  const auto [s, c] = portable::sincos(t);
  const double c_2 = (c - s) * (c + s), s_2 = 2 * s * c;
  return {Trigonometric{1, c, s, c_2, s_2}, Trigonometric{0, -s, c, -2 * s_2, 2 * c_2}};
}

double sum(const Trigonometric& a, const Trigonometric& b) {
  return a[0] * b[0] + (a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4]);
}

}  // namespace

TorusFunction::TorusFunction(const Face& torus, const Face& other) {
  const PreparedBody &own = *torus.body, &body = *other.body;
  const Vector3 d = torus.centre - other.centre;
  // Express the quantities K = |P + d|^2 + k and Y = (P + d) . axis of the other body, with |P|^2 = crank^2 + rod^2 + 2
  // crank rod cos b
  const bool is_torus = other.surface == Surface::torus;
  const double l_2 = is_torus ? body.crank * body.crank : 0;
  Bilinear K = along(own, d * 2.0,
                     dot(d, d) + own.crank * own.crank + own.radius * own.radius + l_2 - body.radius * body.radius);
  K[0][1] += 2 * own.crank * own.radius;
  const Bilinear Y = along(own, body.axis, dot(d, body.axis)), one{{{1, 0, 0}}};
  if (is_torus) {
    add_product(K, one, 4 * l_2, c_);
    add_product(Y, Y, -4 * l_2, c_);
    add_product(K, K, -1, c_);
    c_[0][0] += 4 * l_2 * (body.radius * body.radius - l_2);
  } else {
    add_product(Y, Y, 1, c_);
    add_product(K, one, -1, c_);
  }
  constexpr std::array<double, 5> kDegree{0, 1, 1, 2, 2};
  for (std::size_t i = 0; i < 5; ++i)
    for (std::size_t j = 0; j < 5; ++j) {
      const double c = std::fabs(c_[i][j]);
      size_ += c;
      bend_[0] += c * kDegree[i] * kDegree[i];
      bend_[1] += c * kDegree[i] * kDegree[j];
      bend_[2] += c * kDegree[j] * kDegree[j];
    }
}

TorusFunction::OfOneAngle::OfOneAngle(const TorusFunction& function, std::size_t fixed, double angle)
    : c_(function.c_), fixed_(fixed), own_(basis(angle)) {
  if (fixed_ == 1) set_b(own_[0], own_[1], at_b_, at_db_);
}

void TorusFunction::OfOneAngle::set_b(const Trigonometric& b, const Trigonometric& db, Trigonometric& at_b,
                                      Trigonometric& at_db) const {
  for (std::size_t i = 0; i < 5; ++i) {
    at_b[i] = sum(c_[i], b);
    at_db[i] = sum(c_[i], db);
  }
}

TorusFunction::Value TorusFunction::OfOneAngle::at(double other) const {
  const auto [value, slope] = basis(other);
  if (fixed_ == 1) return {sum(value, at_b_), {sum(slope, at_b_), sum(value, at_db_)}};
  Trigonometric at_b, at_db;
  set_b(value, slope, at_b, at_db);
  return {sum(own_[0], at_b), {sum(own_[1], at_b), sum(own_[0], at_db)}};
}

namespace {

class Examination {
 public:
  Examination(const TorusFunction& function, const TorusBox& box, double rounding_error)
      : f_(function), box_(box), rounding_error_(rounding_error), centre_(function.at(box.middle)) {}

  CurveInBox run() const {
    if (std::fabs(centre_.f) > reach({true, true}) + rounding_error_) return {CurveInBox::State::absent};
    const std::array<double, 2> least{least_slope(0), least_slope(1)};
    // Use the angle along which the curve is flatter as parameter of the curve.
    const std::size_t other = std::fabs(centre_.by[1]) >= std::fabs(centre_.by[0]) ? 1 : 0;
    if (least[other] > 0 && (least[1 - other] > 0 || has_fixed_sides(other))) return found(other, least[other]);
    const std::size_t second = 1 - other;
    if (least[second] > 0 && has_fixed_sides(second)) return found(second, least[second]);
    const auto share = [&](std::size_t i) {
      return (std::fabs(centre_.by[i]) + f_.bend(i, i) * box_.half[i]) * box_.half[i];
    };
    return {CurveInBox::State::unresolved, share(1) > share(0) ? std::size_t{1} : std::size_t{0}};
  }

 private:
  /// Upper bound of |f - f(m)| in the box, where m is its middle, if only the angles i with varies[i] differ from m.
  double reach(const std::array<bool, 2>& varies) const {
    double sum = 0;
    for (std::size_t i = 0; i < 2; ++i)
      if (varies[i])
        for (std::size_t j = 0; j < 2; ++j)
          if (varies[j]) sum += 0.5 * f_.bend(i, j) * box_.half[i] * box_.half[j];
    for (std::size_t i = 0; i < 2; ++i)
      if (varies[i]) sum += std::fabs(centre_.by[i]) * box_.half[i];
    return sum;
  }
  /// Lower bound, in the box, of the magnitude of the derivative of f with respect to angle i; zero or negative if the
  /// derivative may vanish.
  double least_slope(std::size_t i) const {
    return std::fabs(centre_.by[i]) - f_.bend(i, 0) * box_.half[0] - f_.bend(i, 1) * box_.half[1];
  }
  std::array<double, 2> place(std::size_t along, double at, double across) const {
    std::array<double, 2> q_b;
    q_b[along] = at;
    q_b[1 - along] = across;
    return q_b;
  }
  double low(std::size_t i) const { return box_.middle[i] - box_.half[i]; }
  double high(std::size_t i) const { return box_.middle[i] + box_.half[i]; }

  /// Whether f has no zero on the two sides of the box on which the angle `other` has its minimum and its maximum.
  bool has_fixed_sides(std::size_t other) const {
    const std::size_t i = 1 - other;
    for (const double end : {low(other), high(other)}) {
      const TorusFunction::Value at = f_.at(place(i, box_.middle[i], end));
      const double reach = std::fabs(at.by[i]) * box_.half[i] + 0.5 * f_.bend(i, i) * box_.half[i] * box_.half[i];
      if (std::fabs(at.f) <= reach + rounding_error_) return false;
    }
    return true;
  }

  /// The curve f = 0 inside the box, as a function of the angle that is not `other`. It ends where it leaves the box
  /// through one of the sides on which `other` is constant; f is monotone along those sides on which it can be 0.
  /// @param least  lower bound of the magnitude of the derivative of f with respect to `other`
  CurveInBox found(std::size_t other, double least) const {
    const std::size_t along = 1 - other;
    const auto is_positive = [&](double at, double across) { return f_.at(place(along, at, across)).f > 0; };
    std::array<double, 4> ends{low(along), high(along), high(along), high(along)};
    std::size_t count = 2;
    for (const double side : {low(other), high(other)}) {
      const bool below = is_positive(ends[0], side);
      if (below == is_positive(ends[1], side)) continue;
      const auto value_at = [&](double x) {
        const TorusFunction::Value at = f_.at(place(along, x, side));
        return ValueAndDerivative{at.f, at.by[along]};
      };
      ends[count++] = refine_root_newton(
          value_at, ends[0], ends[1], below, box_.middle[along],
          [](const ValueAndDerivative&, double x, double next) { return std::fabs(next - x) <= 1e-15; });
    }
    std::ranges::sort(ends);
    for (std::size_t i = 0; i + 1 < count; ++i) {
      if (!(ends[i] < ends[i + 1])) continue;
      const double middle = 0.5 * (ends[i] + ends[i + 1]);
      if (is_positive(middle, low(other)) == is_positive(middle, high(other))) continue;
      const double steepest =
          std::fabs(centre_.by[along]) + f_.bend(along, 0) * box_.half[0] + f_.bend(along, 1) * box_.half[1];
      return {CurveInBox::State::found, 0,
              TorusArc{.along = along,
                       .from = ends[i],
                       .to = ends[i + 1],
                       .across = {low(other), high(other)},
                       .max_slope = steepest / least,
                       .least = least}};
    }
    return {CurveInBox::State::absent};
  }

  const TorusFunction& f_;
  const TorusBox& box_;
  double rounding_error_;
  TorusFunction::Value centre_;
};

}  // namespace

CurveInBox find_curve_in(const TorusFunction& function, const TorusBox& box, double rounding_error) {
  return Examination(function, box, rounding_error).run();
}

Enclosure other_coordinate(const TorusFunction& function, const TorusArc& arc, const Enclosure& parameter) {
  const std::size_t along = arc.along, other = 1 - along;
  const TorusFunction::OfOneAngle across_arc(function, along, parameter.value);
  const auto at = [&](double x) { return across_arc.at(x); };
  const auto [low, high] = arc.across;
  const double at_low = at(low).f, at_high = at(high).f;
  // At an end of the arc f can have the same sign at both limits of the other angle: the root is then at one of these
  // limits.
  double root = std::fabs(at_low) < std::fabs(at_high) ? low : high;
  if ((at_low > 0) != (at_high > 0))
    root = refine_root_newton(
        [&](double x) {
          const TorusFunction::Value here = at(x);
          return ValueAndDerivative{here.f, here.by[other]};
        },
        low, high, at_low > 0, low - at_low * (high - low) / (at_high - at_low),
        [](const ValueAndDerivative&, double x, double next) { return std::fabs(next - x) <= 1e-12; });
  const TorusFunction::Value here = at(root);
  const double slope = -here.by[along] / here.by[other], h = parameter.reach();
  if (h == 0) return {root, slope * parameter.slope, 0, parameter.h};
  // Compute bounds for a neighbourhood of the point. The bounds of the box are valid, too; use the smaller ones.
  const double reach = arc.max_slope * h;
  const double least = std::max(
      arc.least, std::fabs(here.by[other]) - function.bend(other, along) * h - function.bend(other, other) * reach);
  const double steepest = std::min(
      arc.max_slope,
      (std::fabs(here.by[along]) + function.bend(along, along) * h + function.bend(along, other) * reach) / least);
  const double bend = (function.bend(along, along) + 2 * function.bend(along, other) * steepest +
                       function.bend(other, other) * steepest * steepest) /
                      least;
  return parameter.through(root, slope, steepest, bend);
}

}  // namespace pkm::generic::edges
