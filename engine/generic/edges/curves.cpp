#include "engine/generic/edges/curves.hpp"

#include "engine/math/roots.hpp"

namespace pkm::generic::edges {
namespace {

// Quantities of order one that differ by at most this, relatively, are considered equal.
constexpr double kCoincident = 1e-12;

bool is_same(double a, double b) { return std::fabs(a - b) <= kCoincident * (std::fabs(a) + std::fabs(b)); }

/// An arbitrary unit vector that is normal to a given unit vector.
Vector3 any_normal(const Vector3& axis) {
  Vector3 e{};
  std::size_t smallest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::fabs(axis[i]) < std::fabs(axis[smallest])) smallest = i;
  e[smallest] = 1;
  const Vector3 v = cross(axis, e);
  return v * (1 / norm(v));
}

/// Coefficients a of the trigonometric polynomial a[0] + a[1] cos t + a[2] sin t.
using Linear = std::array<double, 3>;
Trigonometric product(const Linear& a, const Linear& b) {
  return {a[0] * b[0] + 0.5 * (a[1] * b[1] + a[2] * b[2]), a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[2] * b[0],
          0.5 * (a[1] * b[1] - a[2] * b[2]), 0.5 * (a[1] * b[2] + a[2] * b[1])};
}

Quadric quadric_of(const Face& face) {
  const Body& body = *face.body;
  const Vector3& c = face.centre;
  if (face.surface == Surface::plane) return {.v = body.axis, .k = -body.radius};
  Quadric q{.square = 1, .v = c * -2.0, .k = dot(c, c) - body.radius * body.radius};
  if (face.surface != Surface::cylinder) return q;
  const double s = dot(c, body.axis);
  q.across = 1;
  q.axis = body.axis;
  q.v += body.axis * (2 * s);
  q.k -= s * s;
  return q;
}

/// On a face that is part of a sphere, |p|^2 is an affine function of the point p: returns this function; std::nullopt
/// for other faces.
std::optional<Affine> square_on(const Face& face) {
  if (face.surface != Surface::sphere) return {};
  const double r = face.body->radius;
  return Affine{face.centre * 2.0, r * r - dot(face.centre, face.centre)};
}

/// The equation of a sphere or plane, rewritten as an equation of the vector from the point c to p.
Quadric relative_to(const Vector3& c, const Quadric& q) {
  return {.square = q.square, .v = q.v + c * (2 * q.square), .k = q.square * dot(c, c) + dot(q.v, c) + q.k};
}

Curve circle(const Face& a, const Face& b, const Vector3& o, const Vector3& normal, double radius) {
  const Vector3 x = any_normal(normal);
  return {.faces = {&a, &b}, .o = o, .x = x * radius, .y = cross(normal, x) * radius, .square = square_on(a)};
}

void sphere_and_plane(const Face& sphere, const Face& other, const Vector3& normal, double distance,
                      std::vector<Curve>& curves) {
  const double r = sphere.body->radius, radius_2 = (r - distance) * (r + distance);
  if (radius_2 > 0)
    curves.push_back(circle(sphere, other, sphere.centre + normal * distance, normal, std::sqrt(radius_2)));
}

/// Adds the intersection curves of a cylinder with another surface. Their points are o(t) + s axis: the point at height
/// s of the straight line on the cylinder at the angle t, where s is a root of A s^2 + 2 B(t) s + C(t) = 0.
void on_cylinder(const Face& cylinder, const Face& other, std::vector<Curve>& curves) {
  const Vector3 &a = cylinder.body->axis, &c = cylinder.centre;
  const Quadric q = quadric_of(other);
  const double r = cylinder.body->radius, slant = dot(a, q.axis);
  const Vector3 x = any_normal(a) * r, y = cross(a, x);
  // For a vector d: p(t) . d as a trigonometric polynomial in t, where p(t) = c + x cos t + y sin t.
  const auto along = [&](const Vector3& d) { return Linear{dot(c, d), dot(x, d), dot(y, d)}; };
  const double A = q.square - q.across * slant * slant;
  const Linear m = along(q.axis), h = along(q.v), g = along(a), e = along(c);
  Linear B{};
  for (std::size_t i = 0; i < 3; ++i) B[i] = q.square * g[i] - q.across * slant * m[i];
  B[0] += 0.5 * dot(q.v, a);
  const Trigonometric mm = product(m, m);
  Trigonometric C{};
  for (std::size_t i = 0; i < 5; ++i) C[i] = -q.across * mm[i];
  for (std::size_t i = 0; i < 3; ++i) C[i] += h[i] + q.square * (i == 0 ? 1.0 : 2.0) * e[i];
  C[0] += q.square * r * r + q.k;
  Curve curve{.faces = {&cylinder, &other}, .square = square_on(other)};
  if (other.surface == Surface::plane) {  // a plane: A = 0 and B is constant, so that s = -C / (2 B)
    const Vector3 shift = a * (-0.5 / B[0]);
    curve.o = c + shift * C[0];
    curve.x = x + shift * C[1];
    curve.y = y + shift * C[2];
  } else {
    const Vector3 shift = a * (-1 / A);
    curve.o = c + shift * B[0];
    curve.x = x + shift * B[1];
    curve.y = y + shift * B[2];
    curve.w = a * (1 / A);
    curve.has_root = true;
    curve.D = product(B, B);
    for (std::size_t i = 0; i < 5; ++i) curve.D[i] -= A * C[i];
  }
  curves.push_back(curve);
}

/// Adds lines parallel to the axis of a cylinder of radius r through `centre`, in the plane normal . p = distance,
/// whose normal is normal to the axis.
void parallel_lines(const Face& a, const Face& b, const Vector3& centre, double r, const Vector3& axis,
                    const Vector3& normal, double distance, std::vector<Curve>& curves) {
  const double d = distance - dot(centre, normal), half_2 = (r - d) * (r + d);
  if (!(half_2 > 0)) return;
  const Vector3 foot = centre + normal * d - axis * dot(centre, axis), across = cross(axis, normal);
  for (const double sign : {1.0, -1.0})
    curves.push_back(
        {.kind = Curve::Kind::line, .faces = {&a, &b}, .o = foot + across * (sign * std::sqrt(half_2)), .x = axis});
}

bool cylinder_and_other(const Face& cylinder, const Face& other, std::vector<Curve>& curves) {
  const Vector3 &a = cylinder.body->axis, &c = cylinder.centre;
  const double r = cylinder.body->radius;
  if (other.surface == Surface::plane && std::fabs(dot(a, other.body->axis)) < kCoincident) {
    parallel_lines(cylinder, other, c, r, a, other.body->axis, other.body->radius, curves);
  } else if (other.surface == Surface::cylinder && norm(cross(a, other.body->axis)) < kCoincident) {
    const Vector3 between = other.centre - c, across = between - a * dot(between, a);
    const double distance = norm(across);
    if (distance < kCoincident * r) return !is_same(r, other.body->radius);
    const Vector3 normal = across * (1 / distance);
    const double from_c = 0.5 * (distance + (r - other.body->radius) * (r + other.body->radius) / distance);
    parallel_lines(cylinder, other, c, r, a, normal, dot(c, normal) + from_c, curves);
  } else {
    on_cylinder(cylinder, other, curves);
  }
  return true;
}

/// Adds the intersection curves of a torus with a sphere or plane, square |p|^2 + v . p + k = 0 for the vector p from
/// the centre of the torus: in general as points of its meridians. On the meridian at the angle q they satisfy
///
///   cos b alpha + sin b beta = gamma,   alpha = xi + 2 square crank,   beta = v . axis,   xi = v . e_r(q),
///   gamma = -(square (crank^2 + rod^2) + k + crank xi) / rod,   D = alpha^2 + beta^2 - gamma^2.
void on_torus(const Face& torus, const Face& other, const Quadric& absolute, const std::optional<Quadric>& cut,
              std::vector<Curve>& curves) {
  const PreparedBody& body = *torus.body;
  const Quadric q = relative_to(torus.centre, absolute);
  const double l = body.crank, rod = body.radius, beta = dot(q.v, body.axis);
  const Vector3 across = q.v - body.axis * beta;
  if (q.square == 0 && dot(across, across) > beta * beta) {
    // A steep plane meets the parallel circle at the height rod sin b, of radius |crank + rod cos b|, in two points.
    // Points of meridians would be singular for a plane through the axis.
    const double size = norm(across);
    const Vector3 e = across * (1 / size);
    const Linear radius{l, rod, 0}, along{-q.k / size, 0, -rod * beta / size};
    Trigonometric D = product(radius, radius);
    const Trigonometric square = product(along, along);
    for (std::size_t i = 0; i < D.size(); ++i) D[i] -= square[i];
    curves.push_back({.faces = {&torus, &other},
                      .o = torus.centre + e * along[0],
                      .y = e * along[2] + body.axis * rod,
                      .w = cross(body.axis, e),
                      .has_root = true,
                      .D = D,
                      .cut = cut});
    return;
  }
  const double a_0 = 2 * q.square * l, g_0 = -(q.square * (l * l + rod * rod) + q.k) / rod, g_1 = -l / rod;
  const Linear xi{0, dot(q.v, body.zero), dot(q.v, body.beside)};
  Trigonometric D = product(xi, xi);
  for (double& each : D) each *= (1 - g_1) * (1 + g_1);
  for (std::size_t i = 1; i < 3; ++i) D[i] += 2 * (a_0 - g_0 * g_1) * xi[i];
  D[0] += a_0 * a_0 + beta * beta - g_0 * g_0;
  curves.push_back(
      {.kind = Curve::Kind::on_torus, .faces = {&torus, &other}, .has_root = true, .D = D, .with = q, .cut = cut});
}

/// Two tori of equal radii whose intersection consists of two curves, in a plane and on a sphere or another plane. With
/// K = |P|^2 + crank^2 - rod^2 and Y = P . axis, the difference of their equations is
/// (K_a - K_b) (4 crank^2 - K_a - K_b) - 4 crank^2 (Y_a - s Y_b) (Y_a + s Y_b), s = +-1, in which K_a - K_b and
/// Y_a - s Y_b are linear. The first is a multiple of the second if the tori are mirror images.
/// @return false if there are no such curves
bool add_curves_of_mirror_images(const Face& a, const Face& b, std::vector<Curve>& curves) {
  const PreparedBody &A = *a.body, &B = *b.body;
  const double l = A.crank, l_2 = l * l, size = l + A.radius;
  if (!is_same(l, B.crank) || !is_same(A.radius, B.radius)) return false;
  const Vector3 &c = a.centre, between = b.centre - a.centre;
  // As functions of P = p - c: K_a - K_b = v . P + k, Y_a - s Y_b = m . P + n.
  const Vector3 v = between * 2.0;
  const double k = -dot(between, between), offset = dot(between, B.axis);
  const auto absolute = [&](const Quadric& q) { return relative_to(c * -1.0, q); };
  for (const double s : {1.0, -1.0}) {
    const Vector3 m = A.axis - B.axis * s, other_m = A.axis + B.axis * s;
    const double n = s * offset, other_n = -s * offset;
    // The factor 4 l^2 - K_a - K_b in the difference of the equations of the tori is -2 |P|^2 + v . P + r; l is crank.
    const double r = 2 * l_2 + 2 * A.radius * A.radius - dot(between, between);
    Quadric plane, rest;
    if (norm(m) < kCoincident && std::fabs(n) < kCoincident * size) {
      if (norm(v) < kCoincident * size) return false;
      plane = {.v = v, .k = k};
      rest = {.square = -2, .v = v, .k = r};
    } else {
      // Factor for which K_a - K_b = factor (Y_a - s Y_b).
      const double factor = (dot(v, m) + k * n) / (dot(m, m) + n * n);
      if (norm(v - m * factor) > kCoincident * size || std::fabs(k - n * factor) > kCoincident * size * size) continue;
      plane = {.v = m, .k = n};
      rest = {.square = -2 * factor, .v = v * factor - other_m * (4 * l_2), .k = r * factor - 4 * l_2 * other_n};
    }
    on_torus(a, b, absolute(plane), absolute(rest), curves);
    on_torus(a, b, absolute(rest), absolute(plane), curves);
    return true;
  }
  return false;
}

/// Adds the intersection of a torus with another surface as an implicit curve. @return false if the surfaces are the
/// same
bool add_implicit(const Face& torus, const Face& other, std::vector<Curve>& curves) {
  const double length = torus.body->crank + torus.body->radius;
  const TorusFunction function(torus, other);
  if (function.size() <= kCoincident * std::pow(length, other.surface == Surface::torus ? 4 : 2)) return false;
  curves.push_back({.kind = Curve::Kind::implicit, .faces = {&torus, &other}, .function = function});
  return true;
}

/// D(t) about t_0: the coefficients of cos k (t - t_0) and of sin k (t - t_0), at index k - 1, for k = 1, 2.
struct Shifted {
  double cosine[2], sine[2];
};
Shifted shifted(const Trigonometric& D, double t_0) {
  Shifted at{};
  for (std::size_t k = 0; k < 2; ++k) {
    const auto [s, c] = portable::sincos(static_cast<double>(k + 1) * t_0);
    at.cosine[k] = D[2 * k + 1] * c + D[2 * k + 2] * s;
    at.sine[k] = D[2 * k + 2] * c - D[2 * k + 1] * s;
  }
  return at;
}

/// D(t_0 + x) / x^order, where t_0 is a root of D with multiplicity `order`.
Enclosure quotient(const Trigonometric& D, double t_0, int order, const Enclosure& x) {
  const auto [cosine, sine] = shifted(D, t_0);
  const Enclosure half = x * 0.5, twice = x * 2.0;
  const SineCosine of_half = sine_cosine(half), of_x = sine_cosine(x);
  const Enclosure sinc_half = sinc(half, of_half), sinc_x = sinc(x, of_x);
  if (order == 1)
    return sinc_half * of_half.sine * -cosine[0] + sinc_x * sine[0] +
           (sinc_x * of_x.sine * -cosine[1] + sinc(twice, sine_cosine(twice)) * sine[1]) * 2.0;
  return square(sinc_half) * (-0.5 * cosine[0]) + square(sinc_x) * (-2 * cosine[1]) -
         of_x.sine * square(sinc_half) * sine[1];
}

Enclosure value_of_D(const Trigonometric& D, const SineCosine& t) {
  const auto& [s, c] = t;
  return c * D[1] + s * D[2] + (square(c) * 2.0 - 1.0) * D[3] + s * c * (2 * D[4]) + D[0];
}

/// Two simple roots at a smaller distance cannot be distinguished from a double root, because of the rounding errors of
/// D.
constexpr double kDoubleRoot = 4e-8;

/// Isolates the roots of D in an interval by bisection. A root that may be double is reported once or several times.
void isolate(const Trigonometric& D, double from, double to, double rounding, std::vector<CurveRoot>& roots) {
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const auto at = [&](double t, double h) { return value_of_D(D, sine_cosine(Enclosure::variable(t, h))); };
  const Enclosure d = at(middle, half);
  if (std::fabs(d.value) > d.reach() + rounding) return;
  if (d.is_monotone()) {
    const bool positive_at_from = at(from, 0).value > 0;
    if (positive_at_from == (at(to, 0).value > 0)) return;
    const auto value_at = [&](double t) {
      const Enclosure f = at(t, 0);
      return ValueAndDerivative{f.value, f.slope};
    };
    const auto converged = [](const ValueAndDerivative&, double t, double next) {
      return std::fabs(next - t) <= 4e-16 * (1 + std::fabs(t));
    };
    roots.push_back({refine_root_newton(value_at, from, to, positive_at_from, middle, converged), 1});
  } else if (half < 0.25 * kDoubleRoot) {
    roots.push_back({middle, 2});
  } else {
    isolate(D, from, middle, rounding, roots);
    isolate(D, middle, to, rounding, roots);
  }
}

/// Merges roots that cannot be distinguished from a double root into one, which is placed at the root of D'.
void merge(const Trigonometric& D, std::vector<CurveRoot>& roots) {
  std::size_t count = 0;
  for (std::size_t i = 0, end = 0; i < roots.size(); i = end) {
    for (end = i + 1; end < roots.size() && roots[end].t - roots[end - 1].t < kDoubleRoot;) ++end;
    double t = 0.5 * (roots[i].t + roots[end - 1].t);
    if (end == i + 1 && roots[i].order == 1) {
      roots[count++] = roots[i];
      continue;
    }
    const Shifted at = shifted(D, t);
    const double d_1 = at.sine[0] + 2 * at.sine[1], d_2 = -at.cosine[0] - 4 * at.cosine[1];
    if (d_2 != 0) t -= std::clamp(d_1 / d_2, -kDoubleRoot, kDoubleRoot);
    roots[count++] = {t, 2};
  }
  roots.resize(count);
}

}  // namespace

bool add_intersection(const Face& a, const Face& b, double bound, std::vector<Curve>& curves) {
  if (a.surface < b.surface) return add_intersection(b, a, bound, curves);
  if (a.surface == Surface::torus) {
    if (b.surface == Surface::torus) return add_curves_of_mirror_images(a, b, curves) || add_implicit(a, b, curves);
    if (b.surface == Surface::cylinder) return add_implicit(a, b, curves);
    on_torus(a, b, quadric_of(b), {}, curves);
  } else if (a.surface == Surface::cylinder) {
    return cylinder_and_other(a, b, curves);
  } else if (a.surface == Surface::sphere && b.surface == Surface::sphere) {
    const Vector3 between = b.centre - a.centre;
    const double distance = norm(between), r = a.body->radius, r_b = b.body->radius;
    if (distance < kCoincident * (r + r_b)) return !is_same(r, r_b);
    sphere_and_plane(a, b, between * (1 / distance), 0.5 * (distance + (r - r_b) * (r + r_b) / distance), curves);
  } else if (a.surface == Surface::sphere) {
    sphere_and_plane(a, b, b.body->axis, b.body->radius - dot(a.centre, b.body->axis), curves);
  } else {
    const Vector3 &m = a.body->axis, &n = b.body->axis, direction = cross(m, n);
    const double sine_2 = dot(direction, direction);
    if (sine_2 < kCoincident * kCoincident)
      return std::fabs(a.body->radius - dot(m, n) * b.body->radius) > kCoincident * bound;
    const Vector3 o = (cross(n, direction) * a.body->radius + cross(direction, m) * b.body->radius) * (1 / sine_2);
    curves.push_back({.kind = Curve::Kind::line, .faces = {&a, &b}, .o = o, .x = direction * (1 / std::sqrt(sine_2))});
  }
  return true;
}

Curve equator(const Face& end, const Face& fold) {
  return circle(end, fold, end.centre, end.body->along[static_cast<std::size_t>(end.part)], end.body->radius);
}

bool add_arcs(const Curve& curve, double bound, std::vector<CurveRoot>& roots, std::vector<Arc>& arcs) {
  if (curve.kind == Curve::Kind::line) {
    arcs.push_back({.curve = &curve, .t_0 = -bound, .length = 2 * bound});
    return true;
  }
  if (!curve.has_root) {
    arcs.push_back({.curve = &curve, .length = 2 * kPi});
    return true;
  }
  double size = 0;
  for (const double d : curve.D) size = std::max(size, std::fabs(d));
  if (!(size > 0)) return false;
  // On a torus, meridians outside of its range are not needed. On other surfaces the starting angle is arbitrary; with
  // this number a turning point is unlikely to be exactly there.
  const bool on_torus = curve.kind == Curve::Kind::on_torus;
  const double start = on_torus ? curve.faces[0]->body->from : 0.1234;
  const double length = on_torus ? curve.faces[0]->body->to - start : 2 * kPi;
  roots.clear();
  isolate(curve.D, start, start + length, 4e-16 * size, roots);
  merge(curve.D, roots);
  const auto add = [&](const Arc& arc) {
    for (const double branch : {1.0, -1.0}) {
      arcs.push_back(arc);
      arcs.back().branch = branch;
    }
  };
  const auto is_positive = [&](double t) { return value_of_D(curve.D, sine_cosine(Enclosure(t))).value > 0; };
  if (!on_torus && !roots.empty()) {  // begin and end the closed curve at the same root
    roots.push_back({roots.front().t + length, roots.front().order});
  } else {
    roots.insert(roots.begin(), {start, 0});
    roots.push_back({start + length, 0});
  }
  for (std::size_t i = 0; i + 1 < roots.size(); ++i) {
    const CurveRoot &from = roots[i], &to = roots[i + 1];
    const double middle = 0.5 * (from.t + to.t);
    if (!is_positive(middle)) continue;
    const auto add_from = [&](const CurveRoot& root, double end) {
      const double distance = std::fabs(end - root.t);
      add({.curve = &curve,
           .t_0 = root.t,
           .direction = end > root.t ? 1.0 : -1.0,
           .order = root.order,
           .length = root.order == 1 ? std::sqrt(distance) : distance});
    };
    const double end = to.order == 0 ? to.t : from.order == 0 ? from.t : middle;
    if (end != from.t) add_from(from, end);
    if (end != to.t) add_from(to, end);
  }
  return true;
}

CurvePoint point_on(const Face& torus, const Enclosure& q, const Enclosure& b) {
  const PreparedBody& body = *torus.body;
  const Vector3& c = torus.centre;
  const double l = body.crank, rod = body.radius;
  const SineCosine of_q = sine_cosine(q), of_b = sine_cosine(b);
  const Enclosure along = of_b.cosine * rod + l, height = of_b.sine * rod;
  const Enclosure x = along * of_q.cosine, y = along * of_q.sine;
  CurvePoint at;
  for (std::size_t i = 0; i < 3; ++i) at.p[i] = x * body.zero[i] + y * body.beside[i] + height * body.axis[i] + c[i];
  at.square = along * (2 * l) + dot(at.p, c) * 2.0 + (rod * rod - l * l - dot(c, c));
  return at;
}

CurvePoint point(const Arc& arc, const Enclosure& u) {
  const Curve& curve = *arc.curve;
  if (curve.kind == Curve::Kind::implicit) {
    const Enclosure t = u + arc.t_0, other = other_coordinate(curve.function, arc.implicit, t);
    return arc.implicit.along == 0 ? point_on(*curve.faces[0], t, other) : point_on(*curve.faces[0], other, t);
  }
  const Enclosure x = (arc.order == 1 ? square(u) : u) * arc.direction, t = x + arc.t_0;
  CurvePoint at;
  // Computes p = o + s a + r b.
  const auto combine = [&](const Vector3& o, const Vector3& a, const Enclosure& s, const Vector3& b,
                           const Enclosure& r) {
    for (std::size_t i = 0; i < 3; ++i) at.p[i] = s * a[i] + r * b[i] + o[i];
  };
  const auto add = [&](const Vector3& a, const Enclosure& s) {
    for (std::size_t i = 0; i < 3; ++i) at.p[i] += s * a[i];
  };
  if (curve.kind == Curve::Kind::line) {
    for (std::size_t i = 0; i < 3; ++i) at.p[i] = t * curve.x[i] + curve.o[i];
    at.square = square(t) * dot(curve.x, curve.x) + t * (2 * dot(curve.o, curve.x)) + dot(curve.o, curve.o);
    return at;
  }
  const SineCosine angle = sine_cosine(t);
  const auto& [sine, cosine] = angle;
  Enclosure root;
  if (curve.has_root) {
    root = arc.order == 0 ? sqrt(value_of_D(curve.D, angle))
                          : u * sqrt(quotient(curve.D, arc.t_0, arc.order, x) * (arc.order == 1 ? arc.direction : 1.0));
    root = root * arc.branch;
  }
  if (curve.kind == Curve::Kind::trigonometric) {
    combine(curve.o, curve.x, cosine, curve.y, sine);
    if (curve.has_root) add(curve.w, root);
    at.square = curve.square ? dot(at.p, curve.square->v) + curve.square->k
                             : square(at.p[0]) + square(at.p[1]) + square(at.p[2]);
    return at;
  }
  const Face& torus = *curve.faces[0];
  const PreparedBody& body = *torus.body;
  const Quadric& q = curve.with;
  const double l = body.crank, rod = body.radius, beta = dot(q.v, body.axis);
  const Enclosure xi = cosine * dot(q.v, body.zero) + sine * dot(q.v, body.beside);
  const Enclosure alpha = xi + 2 * q.square * l;
  const Enclosure gamma = (xi * l + (q.square * (l * l + rod * rod) + q.k)) * (-1 / rod);
  const Enclosure scale = inverse(square(alpha) + beta * beta) * rod;
  const Enclosure along = (alpha * gamma - root * beta) * scale + l, height = (gamma * beta + alpha * root) * scale;
  combine(torus.centre, body.zero, along * cosine, body.beside, along * sine);
  add(body.axis, height);
  at.square = along * (2 * l) + dot(at.p, torus.centre) * 2.0 + (rod * rod - l * l - dot(torus.centre, torus.centre));
  return at;
}

Enclosure evaluate(const Quadric& quadric, const CurvePoint& at) {
  Enclosure f = dot(at.p, quadric.v) + at.square * quadric.square + quadric.k;
  if (quadric.across != 0) f = f - square(dot(at.p, quadric.axis)) * quadric.across;
  return f;
}

}  // namespace pkm::generic::edges
