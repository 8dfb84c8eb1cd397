#include "engine/generic/edges/proven_volume.hpp"

#include <algorithm>

#include "engine/generic/edges/faces.hpp"
#include "engine/generic/edges/interval_series.hpp"
#include "engine/math/portable.hpp"

namespace pkm::generic::edges {
namespace {

template <std::size_t N>
using SeriesVector = Vector<IntervalSeries<N>, 3>;

/// Thrown if no bounds can be proven.
struct Unproven {};

bool is_zero(const Interval& x) { return x.lower == 0 && x.upper == 0; }
/// The sign of all values; 0: unknown.
int sign_of(const Interval& x) { return x.lower > 0 ? 1 : x.upper < 0 ? -1 : 0; }
/// Whether all values are positive. Throws if that is unknown.
bool is_positive(const Interval& x) {
  const int sign = sign_of(x);
  if (sign == 0) throw Unproven{};
  return sign > 0;
}
bool is_finite(const Interval& x) { return std::isfinite(x.lower) && std::isfinite(x.upper); }
Interval length_of(const IntervalVector& v) { return sqrt(square(v[0]) + square(v[1]) + square(v[2])); }
IntervalVector operator-(const IntervalVector& v) { return v * Interval(-1); }

template <std::size_t N>
SeriesVector<N> series(const IntervalVector& v) {
  SeriesVector<N> all;
  for (std::size_t i = 0; i < 3; ++i) all[i] = v[i];
  return all;
}
template <std::size_t N>
IntervalSeries<N> along(const SeriesVector<N>& p, const IntervalVector& v) {
  return p[0] * v[0] + p[1] * v[1] + p[2] * v[2];
}
template <std::size_t N>
IntervalSeries<N> squared_length(const SeriesVector<N>& p) {
  return square(p[0]) + square(p[1]) + square(p[2]);
}

/// A box around a ball about the origin.
IntervalVector within_ball(double radius) {
  const Interval any(-radius, radius);
  return {{any, any, any}};
}

/// A unit vector normal to a unit vector.
IntervalVector normal_to(const IntervalVector& axis) {
  IntervalVector e{};
  std::size_t smallest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::fabs(axis[i].middle()) < std::fabs(axis[smallest].middle())) smallest = i;
  e[smallest] = 1;
  const IntervalVector v = cross(axis, e);
  return v * (Interval(1) / length_of(v));
}

// a[0] + a[1] cos t + a[2] sin t, and with cos 2t and sin 2t
using IntervalLinear = std::array<Interval, 3>;
using IntervalTrigonometric = std::array<Interval, 5>;

IntervalTrigonometric product(const IntervalLinear& a, const IntervalLinear& b) {
  const Interval half(0.5), cosines = a[1] * b[1], sines = a[2] * b[2];
  return {a[0] * b[0] + half * (cosines + sines), a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[2] * b[0],
          half * (cosines - sines), half * (a[1] * b[2] + a[2] * b[1])};
}
/// D(t), or its derivative.
Interval value(const IntervalTrigonometric& D, const Interval& t) {
  const Interval c = cos(t), s = sin(t);
  return D[0] + D[1] * c + D[2] * s + D[3] * (square(c) - square(s)) + D[4] * Interval(2) * s * c;
}
Interval slope(const IntervalTrigonometric& D, const Interval& t) {
  return value({0, D[2], -D[1], Interval(2) * D[4], Interval(-2) * D[3]}, t);
}

struct ProvenFace {
  std::size_t body;
  Part part = Part::first;
  Surface surface = Surface::plane;
  IntervalVector centre{};
  double side = 1;
  IntervalVector away_from_pole{};  ///< sphere: opposite of the point where its form has a pole
};

/// A part of an intersection curve, as a function of u. A line is o + u x. On a torus, u is one of the angles q of the
/// crank and b around the fold, of which the other one is the only solution of f = 0 in `across`, where f is the
/// function of the other face; there may be none. Otherwise p = o + x cos t + y sin t + w sqrt(D(t)), where t = t_0 + 2
/// asin(s), and s = u; if D(t_0) = 0, s = +-u^2.
struct ProvenArc {
  const ProvenFace* a = nullptr;
  const ProvenFace* b = nullptr;
  bool is_line = false, has_root = false, is_on_torus = false;
  IntervalVector o{}, x{}, y{}, w{};
  IntervalTrigonometric D{};         ///< as a function of t - t_0
  Interval cosine = 1, sine = 0;     ///< of t_0
  double direction = 0;              ///< 1, -1: sign of s, if D(t_0) = 0
  Interval from{}, to{};             ///< range of u
  std::size_t along = 0;             ///< on a torus: which angle u is, 0: q, 1: b
  std::array<Interval, 2> across{};  ///< on a torus: limits of the other angle
};

struct ProvenRange {
  std::size_t arc;
  double from, to;
  bool is_certain;  ///< active at all points; otherwise unknown
};

template <std::size_t N>
SeriesVector<N> point_of_closed_form(const ProvenArc& arc, const IntervalSeries<N>& u) {
  SeriesVector<N> p;
  if (arc.is_line) {
    for (std::size_t i = 0; i < 3; ++i) p[i] = u * arc.x[i] + arc.o[i];
    return p;
  }
  using S = IntervalSeries<N>;
  const bool at_root = arc.direction != 0;
  const S s = at_root ? square(u) * Interval(arc.direction) : u;
  const S s_2 = square(s), k = sqrt(S(1.0) - s_2);                      // sine squared and cosine of (t - t_0) / 2
  const S c_1 = S(1.0) - s_2 * Interval(2), s_1 = s * k * Interval(2);  // cosine and sine of t - t_0
  const S c_t = c_1 * arc.cosine - s_1 * arc.sine, s_t = s_1 * arc.cosine + c_1 * arc.sine;
  for (std::size_t i = 0; i < 3; ++i) p[i] = c_t * arc.x[i] + s_t * arc.y[i] + arc.o[i];
  if (!arc.has_root) return p;
  const IntervalTrigonometric& D = arc.D;
  S root;
  if (at_root) {  // D / s, where D[0] + D[1] + D[3] = 0
    const S R = s * (Interval(-2) * D[1]) + k * (Interval(2) * D[2]) + s * (S(1.0) - s_2) * (Interval(-8) * D[3]) +
                k * c_1 * (Interval(4) * D[4]);
    root = u * sqrt(R * Interval(arc.direction));
  } else {
    root = sqrt(c_1 * D[1] + s_1 * D[2] + (S(1.0) - square(s_1) * Interval(2)) * D[3] +
                s_1 * c_1 * (Interval(2) * D[4]) + D[0]);
  }
  for (std::size_t i = 0; i < 3; ++i) p[i] += root * arc.w[i];
  return p;
}

bool has_range(const IntervalBody& body) { return body.kind == Body::Kind::slide || body.kind == Body::Kind::crank; }

/// The path of the end E of a rod: E and the unit vector along the path, at both ends of the range.
struct Path {
  std::array<IntervalVector, 2> end{}, along{};
  IntervalVector beside{};  ///< crank: axis x zero
};

Path path_of(const IntervalBody& body) {
  Path path;
  path.beside = cross(body.axis, body.zero);
  for (std::size_t e = 0; e < 2; ++e) {
    const Interval q = e == 0 ? body.from : body.to;
    if (body.kind == Body::Kind::slide) {
      path.end[e] = body.centre + body.axis * q;
      path.along[e] = body.axis;
    } else if (body.kind == Body::Kind::crank) {
      path.end[e] = body.centre + (body.zero * cos(q) + path.beside * sin(q)) * body.crank;
      path.along[e] = path.beside * cos(q) - body.zero * sin(q);
    }
  }
  return path;
}

class Proof {
 public:
  Proof(const std::vector<IntervalBody>& bodies, double bound) : bodies_(bodies), bound_(bound) {}

  Interval run() {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      paths_.push_back(path_of(bodies_[i]));
      add_faces(i);
    }
    for (std::size_t i = 0; i < faces_.size(); ++i)
      for (std::size_t j = i + 1; j < faces_.size(); ++j) {
        const ProvenFace &a = faces_[i], &b = faces_[j];
        if (a.body != b.body)
          add_curves(a, b);
        else if (b.part == Part::fold)
          add_circle({&a, &b}, a.centre, paths_[a.body].along[a.part == Part::first ? 0 : 1], bodies_[a.body].radius);
      }
    for (std::size_t i = 0; i < arcs_.size(); ++i) search(i);
    Interval sum = choose_poles();
    for (const ProvenRange& range : ranges_) {
      const ProvenArc& arc = arcs_[range.arc];
      Interval part = range.is_certain ? integral(arc, range.from, range.to, 0) : rough_integral(arc, range);
      part = part * orientation(arc, range);
      sum += range.is_certain ? part : hull(part, 0);
    }
    if (!is_finite(sum)) throw Unproven{};
    return {std::max(sum.lower, 0.0), std::max(sum.upper, 0.0)};
  }

 private:
  void add_faces(std::size_t i) {
    const IntervalBody& body = bodies_[i];
    if (body.kind != Body::Kind::plane && !(body.radius.lower > 0)) throw Unproven{};
    if (has_range(body) && !(body.from.upper < body.to.lower)) throw Unproven{};
    if (body.kind == Body::Kind::crank && !((body.to - body.from).upper < 2 * kPi && body.crank.lower > 0))
      throw Unproven{};
    ProvenFace face{.body = i, .centre = body.centre, .side = body.side};
    switch (body.kind) {
      case Body::Kind::plane:
        face.centre = body.axis * body.radius;
        face.side = 1;
        break;
      case Body::Kind::sphere:
        face.surface = Surface::sphere;
        break;
      case Body::Kind::cylinder:
        face.surface = Surface::cylinder;
        break;
      case Body::Kind::slide:
      case Body::Kind::crank: {
        const double sign = body.is_first_root ? 1 : -1;
        for (const Part part : {Part::first, Part::second}) {
          face.part = part;
          face.surface = Surface::sphere;
          const std::size_t e = part == Part::first ? 0 : 1;
          face.centre = paths_[i].end[e];
          face.side = part == Part::first ? -sign : sign;
          face.away_from_pole = paths_[i].along[e] * Interval(sign);
          faces_.push_back(face);
        }
        face = {.body = i,
                .part = Part::fold,
                .surface = body.kind == Body::Kind::slide ? Surface::cylinder : Surface::torus,
                .centre = body.centre};
        break;
      }
    }
    faces_.push_back(face);
  }

  // Intersection curves, as in curves.cpp.

  void add_curves(const ProvenFace& a, const ProvenFace& b) {
    if (a.surface < b.surface) return add_curves(b, a);
    const IntervalBody &A = bodies_[a.body], &B = bodies_[b.body];
    if (a.surface == Surface::torus) {
      add_curves_on_torus(a, b);
    } else if (a.surface == Surface::cylinder) {
      add_curves_on_cylinder(a, b);
    } else if (a.surface == Surface::sphere && b.surface == Surface::sphere) {
      const IntervalVector between = b.centre - a.centre;
      const Interval distance = length_of(between);
      if (!(distance.lower > 0)) {  // (nearly) concentric
        if (!is_positive(magnitude(A.radius - B.radius) - distance)) throw Unproven{};
        return;
      }
      add_circle({&a, &b}, a, between * (Interval(1) / distance),
                 Interval(0.5) * (distance + (A.radius - B.radius) * (A.radius + B.radius) / distance));
    } else if (a.surface == Surface::sphere) {
      add_circle({&a, &b}, a, B.axis, B.radius - dot(a.centre, B.axis));
    } else {
      const IntervalVector direction = cross(A.axis, B.axis);
      const Interval square = dot(direction, direction);
      if (std::ranges::all_of(direction, is_zero)) {
        if (sign_of(A.radius - dot(A.axis, B.axis) * B.radius) == 0) throw Unproven{};
        return;
      }
      is_positive(square);
      const IntervalVector o =
          (cross(B.axis, direction) * A.radius + cross(direction, A.axis) * B.radius) * (Interval(1) / square);
      add_line({&a, &b}, o, direction * (Interval(1) / sqrt(square)));
    }
  }

  void add_line(ProvenArc arc, const IntervalVector& o, const IntervalVector& direction) {
    arc.is_line = true;
    arc.o = o;
    arc.x = direction;
    arc.from = -bound_;
    arc.to = bound_;
    arcs_.push_back(arc);
  }
  void add_circle(const ProvenArc& arc, const ProvenFace& sphere, const IntervalVector& normal,
                  const Interval& distance) {
    const Interval r = bodies_[sphere.body].radius, square = (r - distance) * (r + distance);
    const IntervalVector o = sphere.centre + normal * distance;
    if (sign_of(square) == 0) {
      set_tests(*arc.a, *arc.b);
      if (is_inactive(o + within_ball(sqrt(square).upper))) return;
    }
    if (is_positive(square)) add_circle(arc, o, normal, sqrt(square));
  }
  void add_circle(ProvenArc arc, const IntervalVector& o, const IntervalVector& normal, const Interval& radius) {
    arc.o = o;
    arc.x = normal_to(normal);
    arc.y = cross(normal, arc.x) * radius;
    arc.x = arc.x * radius;
    add_whole_turn(arc);
  }

  void add_curves_on_cylinder(const ProvenFace& a, const ProvenFace& b) {
    const IntervalBody &A = bodies_[a.body], &B = bodies_[b.body];
    const IntervalVector &axis = A.axis, &c = a.centre;
    const Interval r = A.radius;
    if (b.surface == Surface::plane && is_zero(dot(axis, B.axis)))
      return add_parallel_lines({&a, &b}, c, r, axis, B.axis, B.radius);
    if (b.surface == Surface::cylinder && std::ranges::all_of(cross(axis, B.axis), is_zero)) {
      const IntervalVector between = b.centre - c, across = between - axis * dot(between, axis);
      const Interval distance = length_of(across);
      const IntervalVector normal = across * (Interval(1) / distance);
      const Interval from_c = Interval(0.5) * (distance + (r - B.radius) * (r + B.radius) / distance);
      return add_parallel_lines({&a, &b}, c, r, axis, normal, dot(c, normal) + from_c);
    }
    // generators o(t) + s axis with A s^2 + 2 B(t) s + C(t) = 0
    const bool is_plane = b.surface == Surface::plane;
    const Interval square = is_plane ? 0 : 1, across = b.surface == Surface::cylinder ? 1 : 0;
    const IntervalVector m_axis = B.axis;
    IntervalVector v = is_plane ? B.axis : b.centre * Interval(-2);
    Interval constant = is_plane ? -B.radius : dot(b.centre, b.centre) - pkm::square(B.radius);
    if (b.surface == Surface::cylinder) {
      const Interval s = dot(b.centre, m_axis);
      v += m_axis * (Interval(2) * s);
      constant = constant - pkm::square(s);
    }
    const IntervalVector x = normal_to(axis) * r, y = cross(axis, x);
    const auto along = [&](const IntervalVector& d) { return IntervalLinear{dot(c, d), dot(x, d), dot(y, d)}; };
    const Interval slant = across * dot(axis, m_axis), quadratic = square - slant * dot(axis, m_axis);
    const IntervalLinear m = along(m_axis), h = along(v), g = along(axis), e = along(c);
    IntervalLinear linear{};
    for (std::size_t i = 0; i < 3; ++i) linear[i] = square * g[i] - slant * m[i];
    linear[0] += Interval(0.5) * dot(v, axis);
    const IntervalTrigonometric mm = product(m, m);
    IntervalTrigonometric C{};
    for (std::size_t i = 0; i < 5; ++i) C[i] = -(across * mm[i]);
    for (std::size_t i = 0; i < 3; ++i) C[i] += h[i] + square * Interval(i == 0 ? 1 : 2) * e[i];
    C[0] += square * r * r + constant;
    ProvenArc arc{&a, &b};
    const Interval divisor = is_plane ? Interval(2) * linear[0] : quadratic;
    if (sign_of(divisor) == 0) throw Unproven{};
    const IntervalVector shift = axis * (Interval(-1) / divisor);
    const IntervalLinear s = is_plane ? IntervalLinear{C[0], C[1], C[2]} : linear;
    arc.o = c + shift * s[0];
    arc.x = x + shift * s[1];
    arc.y = y + shift * s[2];
    if (is_plane) return add_whole_turn(arc);
    arc.w = -shift;
    arc.has_root = true;
    IntervalTrigonometric D = product(linear, linear);
    for (std::size_t i = 0; i < 5; ++i) D[i] = D[i] - quadratic * C[i];
    add_arcs_with_roots(arc, D);
  }
  void add_parallel_lines(const ProvenArc& arc, const IntervalVector& centre, const Interval& r,
                          const IntervalVector& axis, const IntervalVector& normal, const Interval& distance) {
    const Interval d = distance - dot(centre, normal), square = (r - d) * (r + d);
    if (!is_positive(square)) return;
    const IntervalVector foot = centre + normal * d - axis * dot(centre, axis), across = cross(axis, normal);
    for (const double sign : {1.0, -1.0}) add_line(arc, foot + across * (sqrt(square) * Interval(sign)), axis);
  }

  // Curves on a torus, in boxes of the angles q and b.

  struct AngleBox {
    std::array<std::array<Interval, 2>, 2> ends;  ///< of q and b; a number, or the interval of a limit
    Interval range(std::size_t i) const { return {ends[i][0].lower, ends[i][1].upper}; }
  };

  void add_curves_on_torus(const ProvenFace& a, const ProvenFace& b) {
    set_tests(a, b);
    const IntervalBody& body = bodies_[a.body];
    constexpr double kFirst = 0.8;  // width of the first boxes
    const auto divisions = [](const Interval& low, const Interval& high) {
      const int count = static_cast<int>((high.upper - low.lower) / kFirst) + 1;
      std::vector<Interval> places{low};
      for (int i = 1; i < count; ++i) places.emplace_back(low.upper + (high.lower - low.upper) * i / count);
      places.push_back(high);
      return places;
    };
    const std::vector<Interval> q = divisions(body.from, body.to), around = divisions(kStart, end_of_turn());
    for (std::size_t i = 0; i + 1 < q.size(); ++i)
      for (std::size_t j = 0; j + 1 < around.size(); ++j)
        trace(a, b, {{{{q[i], q[i + 1]}, {around[j], around[j + 1]}}}});
  }

  void trace(const ProvenFace& a, const ProvenFace& b, const AngleBox& box) {
    if (++boxes_ > kMaxBoxes) throw Unproven{};
    const std::array<Interval, 2> angles{box.range(0), box.range(1)};
    if (is_inactive(on_torus(a, angles[0], angles[1]))) return;
    const auto middle = [](const Interval& x) { return IntervalSeries<0>(0.5 * (x.lower + x.upper)); };
    const std::array<Interval, 2> by{slope_on_torus(a, b, 0, angles), slope_on_torus(a, b, 1, angles)};
    Interval f = function_on_torus(a, b, middle(angles[0]), middle(angles[1])).c[0];
    for (std::size_t i = 0; i < 2; ++i) f += by[i] * (angles[i] - middle(angles[i]).c[0]);
    if (sign_of(f) != 0) return;
    // The parameter is the coordinate along which the curve is flatter; the torus must not cross its axis.
    const IntervalBody& body = bodies_[a.body];
    const std::size_t steeper = std::fabs(by[1].middle()) >= std::fabs(by[0].middle()) ? 1 : 0;
    if (sign_of(body.crank + body.radius * cos(angles[1])) != 0)
      for (const std::size_t other : {steeper, 1 - steeper}) {
        // Steep curves have wide enclosures.
        constexpr double kSteepest = 3, kAnySlope = 1e-3;
        const double least = std::min(std::fabs(by[other].lower), std::fabs(by[other].upper));
        const bool is_flat = magnitude(by[1 - other]).upper <= kSteepest * least;
        if (sign_of(by[other]) == 0 || !(is_flat || angles[other].width() < kAnySlope)) continue;
        ProvenArc arc{&a, &b};
        arc.is_on_torus = true;
        arc.along = 1 - other;
        arc.across = box.ends[other];
        arc.from = box.ends[arc.along][0];
        arc.to = box.ends[arc.along][1];
        arcs_.push_back(arc);
        return;
      }
    constexpr double kNarrow = 1e-7;
    const std::size_t longer = angles[0].width() > angles[1].width() ? 0 : 1;
    if (angles[longer].width() < kNarrow) throw Unproven{};
    for (const std::size_t side : {0, 1}) {
      AngleBox part = box;
      part.ends[longer][1 - side] = 0.5 * (angles[longer].lower + angles[longer].upper);
      trace(a, b, part);
    }
  }

  template <std::size_t N>
  SeriesVector<N> on_torus(const ProvenFace& torus, const IntervalSeries<N>& q, const IntervalSeries<N>& b) const {
    const IntervalBody& body = bodies_[torus.body];
    const auto of_q = sine_cosine(q), of_b = sine_cosine(b);
    const IntervalSeries<N> distance = of_b.cosine * body.radius + body.crank, x = distance * of_q.cosine,
                            y = distance * of_q.sine, height = of_b.sine * body.radius;
    SeriesVector<N> p;
    for (std::size_t i = 0; i < 3; ++i)
      p[i] = x * body.zero[i] + y * paths_[torus.body].beside[i] + height * body.axis[i] + torus.centre[i];
    return p;
  }
  IntervalVector on_torus(const ProvenFace& torus, const Interval& q, const Interval& b) const {
    const SeriesVector<0> p = on_torus(torus, IntervalSeries<0>(q), IntervalSeries<0>(b));
    return {{p[0].c[0], p[1].c[0], p[2].c[0]}};
  }
  /// The function of a face's surface, at a point of a torus.
  template <std::size_t N>
  IntervalSeries<N> function_on_torus(const ProvenFace& torus, const ProvenFace& face, const IntervalSeries<N>& q,
                                      const IntervalSeries<N>& b) const {
    const IntervalBody& body = bodies_[face.body];
    const std::size_t number = !has_range(body) || face.part == Part::first ? 0 : face.part == Part::second ? 1 : 4;
    return function(face.body, number, on_torus(torus, q, b));
  }
  /// Its derivative by one of the angles, in a box.
  Interval slope_on_torus(const ProvenFace& torus, const ProvenFace& face, std::size_t by,
                          const std::array<Interval, 2>& angles) const {
    std::array<IntervalSeries<1>, 2> at{angles[0], angles[1]};
    at[by].c[1] = 1;
    return function_on_torus(torus, face, at[0], at[1]).c[1];
  }

  /// Encloses the other angle of an arc on a torus.
  template <std::size_t N>
  IntervalSeries<N> other_angle(const ProvenArc& arc, const IntervalSeries<N>& u) const {
    const auto value = [&]<std::size_t M>(const IntervalSeries<M>& along, const IntervalSeries<M>& other) {
      return arc.along == 0 ? function_on_torus(*arc.a, *arc.b, along, other)
                            : function_on_torus(*arc.a, *arc.b, other, along);
    };
    Interval root(arc.across[0].lower, arc.across[1].upper), slope;
    for (int i = 0; i < 5; ++i) {  // interval Newton method
      slope = value(IntervalSeries<1>(u.c[0]), IntervalSeries<1>::variable(root)).c[1];
      const double middle = root.middle();
      const Interval next = Interval(middle) - value(IntervalSeries<0>(u.c[0]), IntervalSeries<0>(middle)).c[0] / slope;
      const Interval both = intersection(root, next);
      if (both.is_empty() || !(both.width() < root.width())) break;
      root = both;
    }
    IntervalSeries<N> other(root);
    for (std::size_t k = 1; k <= N; ++k) other.c[k] = -value(u, other).c[k] / slope;
    return other;
  }

  template <std::size_t N>
  SeriesVector<N> point(const ProvenArc& arc, const IntervalSeries<N>& u) const {
    if (!arc.is_on_torus) return point_of_closed_form(arc, u);
    const IntervalSeries<N> other = other_angle(arc, u);
    return arc.along == 0 ? on_torus(*arc.a, u, other) : on_torus(*arc.a, other, u);
  }

  /// Whether an arc on a torus has a point at all u of an interval (1) or at none (-1); 0: unknown.
  int existence(const ProvenArc& arc, const Interval& u) const {
    const auto sign_at = [&](const Interval& across) {
      const Interval middle = 0.5 * (u.lower + u.upper);
      std::array<Interval, 2> wide{u, u}, centre{middle, middle};
      wide[1 - arc.along] = centre[1 - arc.along] = across;
      const Interval slope = slope_on_torus(*arc.a, *arc.b, arc.along, wide);
      const Interval f =
          function_on_torus(*arc.a, *arc.b, IntervalSeries<0>(centre[0]), IntervalSeries<0>(centre[1])).c[0];
      return sign_of(f + slope * (u - middle));
    };
    return -sign_at(arc.across[0]) * sign_at(arc.across[1]);
  }

  // Arcs of a curve with the parameter t.

  static constexpr double kStart = 0.1234;  // arbitrary, so that no special point is there
  static constexpr double kLongest = 1.6;   // enclosures over more than a quarter of a circle decide nothing
  static Interval end_of_turn() { return Interval(kPi, next_up(kPi)) * Interval(2) + Interval(kStart); }

  void add_whole_turn(const ProvenArc& arc) { add_arcs(arc, kStart, end_of_turn()); }
  /// Adds [from, to], in which D has no root.
  void add_arcs(ProvenArc arc, double from, const Interval& to) {
    const int parts = static_cast<int>((to.upper - from) / kLongest) + 1;
    const IntervalTrigonometric D = arc.D;
    Interval low = from;
    for (int i = 1; i <= parts; ++i) {
      const Interval high = i == parts ? to : Interval(from + (to.lower - from) * i / parts);
      const Interval middle = 0.5 * (low.lower + high.upper);
      set_origin(arc, D, middle);
      arc.from = sin((low - middle) * Interval(0.5));
      arc.to = sin((high - middle) * Interval(0.5));
      add_branches(arc);
      low = high;
    }
  }
  static void set_origin(ProvenArc& arc, const IntervalTrigonometric& D, const Interval& t) {
    arc.cosine = cos(t);
    arc.sine = sin(t);
    const Interval c_2 = cos(t * Interval(2)), s_2 = sin(t * Interval(2));
    arc.D = {D[0], D[1] * arc.cosine + D[2] * arc.sine, D[2] * arc.cosine - D[1] * arc.sine, D[3] * c_2 + D[4] * s_2,
             D[4] * c_2 - D[3] * s_2};
  }
  void add_branches(ProvenArc arc) {
    arcs_.push_back(arc);
    if (!arc.has_root) return;
    arc.w = -arc.w;
    arcs_.push_back(arc);
  }

  /// A root of D, or an interval in which no point of either branch is active.
  struct Division {
    Interval t;
    bool is_root;
  };

  bool is_inactive(const ProvenArc& arc, const Interval& t, const Interval& D) const {
    const double root = sqrt(D).upper;
    return is_inactive(arc.o + arc.x * cos(t) + arc.y * sin(t) + arc.w * Interval(-root, root));
  }
  /// Appends the divisions of [from, to], in ascending order.
  void isolate(const ProvenArc& arc, const IntervalTrigonometric& D, double from, double to,
               std::vector<Division>& divisions) {
    const double middle = 0.5 * (from + to);
    const Interval t(from, to), derivative = slope(D, t);
    const Interval mean = value(D, middle) + derivative * (t - Interval(middle));
    const Interval values = intersection(mean, value(D, t));
    if (sign_of(values) != 0) return;
    constexpr double kWide = 0.1, kNarrow = 1e-9;
    if (to - from < kWide && is_inactive(arc, t, values)) {
      if (!divisions.empty() && !divisions.back().is_root && divisions.back().t.upper == from)
        divisions.back().t.upper = to;
      else
        divisions.push_back({t, false});
      return;
    }
    if (sign_of(derivative) != 0) {
      const int at_from = sign_of(value(D, from)), at_to = sign_of(value(D, to));
      if (at_from == 0 || at_to == 0) throw Unproven{};
      if (at_from == at_to) return;
      while (true) {
        const double between = 0.5 * (from + to);
        const int sign = sign_of(value(D, between));
        if (!(from < between && between < to) || sign == 0) break;
        (sign == at_from ? from : to) = between;
      }
      // The middle is not decided; the enclosure shrinks towards it from both sides.
      for (double width = 0.25 * (to - from); width > 1e-16; width *= 0.5) {
        if (sign_of(value(D, from + width)) == at_from && from + width < to) from += width;
        if (sign_of(value(D, to - width)) == at_to && to - width > from) to -= width;
      }
      divisions.push_back({{from, to}, true});
      return;
    }
    if (to - from < kNarrow) throw Unproven{};
    isolate(arc, D, from, middle, divisions);
    isolate(arc, D, middle, to, divisions);
  }

  void add_arcs_with_roots(ProvenArc arc, const IntervalTrigonometric& D) {
    std::vector<Division> divisions;
    set_tests(*arc.a, *arc.b);
    isolate(arc, D, kStart, end_of_turn().upper, divisions);
    if (divisions.empty()) {
      arc.D = D;
      if (is_positive(value(D, kStart))) add_whole_turn(arc);
      return;
    }
    divisions.push_back({divisions.front().t + (end_of_turn() - Interval(kStart)), divisions.front().is_root});
    for (std::size_t i = 0; i + 1 < divisions.size(); ++i) {
      const auto& [from, from_root] = divisions[i];
      const auto& [to, to_root] = divisions[i + 1];
      const double low = from.upper, high = to.lower;
      if (!(low < high)) continue;
      if (!is_positive(value(D, 0.5 * (low + high)))) continue;
      const double reach = std::min(0.4, 0.25 * (high - low));
      const double after = from_root ? low + reach : low, before = to_root ? high - reach : high;
      const auto add_from = [&](const Interval& root, double end, double direction) {
        set_origin(arc, D, root);
        arc.direction = direction;
        arc.from = 0;
        arc.to = sqrt(sin((Interval(end) - root) * Interval(0.5 * direction)));
        add_branches(arc);
      };
      if (from_root) add_from(from, after, 1);
      if (to_root) add_from(to, before, -1);
      arc.direction = 0;
      arc.D = D;
      add_arcs(arc, after, before);
    }
  }

  // Activity.

  struct ProvenTest {
    std::size_t body;
    const Rule* rule;
  };
  using Tests = std::uint64_t;  // one bit each

  const Rule& rule_of(std::size_t body, const Part* face) const {
    const IntervalBody& b = bodies_[body];
    const Interval range = b.to - b.from;
    if (b.kind == Body::Kind::crank && range.lower <= next_up(kPi) && range.upper > kPi) throw Unproven{};
    return membership({.kind = b.kind, .to = range.upper, .is_first_root = b.is_first_root}, face);
  }

  /// Collects the conditions on the points of an intersection curve.
  void set_tests(const ProvenFace& a, const ProvenFace& b) {
    tests_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (i != a.body && i != b.body)
        tests_.push_back({i, &rule_of(i, nullptr)});
      else if (a.body != b.body && has_range(bodies_[i]) && !(i == a.body && a.surface == Surface::torus))
        tests_.push_back({i, &rule_of(i, i == a.body ? &a.part : &b.part)});  // q on the first torus is in its range
    }
  }
  /// The combinations of signs that are possible in a set of points. @param sign  that of a function, 0: unknown
  template <class Sign>
  static SignSets possible_signs(const Rule& rule, const Sign& sign) {
    SignSets possible = ~SignSets{0};
    for (std::size_t k = 0; k < kFunctions; ++k) {
      if ((rule.depends[k] & possible) == 0) continue;
      const int is = sign(k);
      if (is != 0) possible &= is > 0 ? kPositive[k] : ~kPositive[k];
    }
    return possible;
  }
  /// The same for all points of a box.
  SignSets possible_signs(const ProvenTest& test, const IntervalVector& box) const {
    const SeriesVector<0> p = series<0>(box);
    return possible_signs(*test.rule, [&](std::size_t k) { return sign_of(function(test.body, k, p).c[0]); });
  }
  /// Whether no point of a box is active on the curve for which set_tests() was called.
  bool is_inactive(const IntervalVector& box) const {
    return std::ranges::any_of(
        tests_, [&](const ProvenTest& test) { return (test.rule->holds & possible_signs(test, box)) == 0; });
  }

  void search(std::size_t index) {
    const ProvenArc& arc = arcs_[index];
    set_tests(*arc.a, *arc.b);
    const Tests all = (Tests{1} << tests_.size()) - 1;
    // The ends are known to rounding errors.
    if (arc.from.lower < arc.from.upper) search(index, arc.from.lower, arc.from.upper, kMaxDepth, all);
    search(index, arc.from.upper, arc.to.lower, 0, all);
    if (arc.to.lower < arc.to.upper) search(index, arc.to.lower, arc.to.upper, kMaxDepth, all);
  }

  void search(std::size_t index, double from, double to, int depth, Tests tests) {
    if (++boxes_ > kMaxBoxes) throw Unproven{};
    const ProvenArc& arc = arcs_[index];
    const double middle = 0.5 * (from + to);
    const Interval u(from, to), shift = u - Interval(middle);
    const SeriesVector<1> wide = point(arc, IntervalSeries<1>::variable(u));
    const SeriesVector<0> centre = point(arc, IntervalSeries<0>(middle));
    bool can_improve = false, exists = true;
    if (arc.is_on_torus) {
      const int existing = existence(arc, u);
      if (existing < 0) return;
      exists = existing > 0;
      can_improve = !exists && to - from > 1e-14;
    }
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      if ((tests >> i & 1) == 0) continue;
      const Rule& rule = *tests_[i].rule;
      const std::size_t body = tests_[i].body;
      bool is_sharp = false;
      const SignSets possible = possible_signs(rule, [&](std::size_t k) {
        const IntervalSeries<1> f = function(body, k, wide);
        if (sign_of(f.c[0]) != 0) return sign_of(f.c[0]);
        const Interval at_centre = function(body, k, centre).c[0], change = f.c[1] * shift;
        const int sign = sign_of(at_centre + change);
        // Shorter intervals help unless the value at a single point is as uncertain.
        is_sharp = is_sharp || (sign == 0 && !(at_centre.width() > change.width()));
        return sign;
      });
      if ((rule.holds & possible) == 0) return;
      if ((~rule.holds & possible) == 0)
        tests &= ~(Tests{1} << i);
      else
        can_improve = can_improve || is_sharp;
    }
    const bool is_active = exists && tests == 0;
    if (is_active || !can_improve || depth >= kMaxDepth || !(from < middle && middle < to)) {
      const bool is_certain = is_active && depth < kMaxDepth;
      if (!ranges_.empty() && ranges_.back().arc == index && ranges_.back().to == from &&
          ranges_.back().is_certain == is_certain)
        ranges_.back().to = to;
      else
        ranges_.push_back({index, from, to, is_certain});
      return;
    }
    search(index, from, middle, depth + 1, tests);
    search(index, middle, to, depth + 1, tests);
  }

  /// As function() of faces.hpp, at the points of a series.
  template <std::size_t N>
  IntervalSeries<N> function(std::size_t index, std::size_t number, const SeriesVector<N>& p) const {
    const IntervalBody& body = bodies_[index];
    if (body.kind == Body::Kind::plane) return IntervalSeries<N>(body.radius) - along(p, body.axis);
    SeriesVector<N> P = p - series<N>(body.centre);
    const Interval r_2 = square(body.radius), side(body.side);
    if (body.kind == Body::Kind::sphere) return (IntervalSeries<N>(r_2) - squared_length(P)) * side;
    if (has_range(body) && number < 4) {
      const Path& path = paths_[index];
      P = p - series<N>(path.end[number % 2]);
      return number < 2 ? squared_length(P) - r_2 : along(P, path.along[number % 2]);
    }
    if (body.kind == Body::Kind::crank) {
      const Interval l_2 = square(body.crank);
      const IntervalSeries<N> K = squared_length(P) + (l_2 - r_2);
      if (number == 5) return K;
      return (K - square(along(P, body.axis)) + (r_2 - l_2)) * (Interval(4) * l_2) - square(K);
    }
    if (number == 5) return {1.0};
    return (square(along(P, body.axis)) - squared_length(P) + r_2) * side;
  }

  // Integrals.

  /// Places the pole of each whole sphere far from the edges. @return three times the volume of the spheres whose poles
  /// belong to the boundary, divided by three
  Interval choose_poles() {
    Interval sum;
    for (ProvenFace& face : faces_) {
      const IntervalBody& body = bodies_[face.body];
      if (body.kind != Body::Kind::sphere) continue;
      double best = -1;
      bool is_active = false;
      for (int i = 0; i < 27; ++i) {
        const IntervalVector v{{i % 3 - 1.1, i / 3 % 3 - 0.9, i / 9 - 1.2}};
        const IntervalVector t = v * (Interval(1) / length_of(v));
        double least = 2;
        for (const ProvenRange& range : ranges_) {
          const ProvenArc& arc = arcs_[range.arc];
          if (arc.a != &face && arc.b != &face) continue;
          for (int k = 0; k <= 4; ++k) {
            const SeriesVector<0> p = point(arc, IntervalSeries<0>(range.from + 0.25 * k * (range.to - range.from)));
            least = std::min(least, 1 + along(p - series<0>(face.centre), t).c[0].middle() / body.radius.middle());
          }
        }
        if (least <= best) continue;
        const auto active = holds(face, face.centre - t * body.radius);
        if (!active) continue;
        best = least;
        is_active = *active;
        face.away_from_pole = t;
      }
      if (best < 0) throw Unproven{};
      if (is_active)
        sum += Interval(4 * face.side) / Interval(3) * Interval(kPi, next_up(kPi)) * body.radius * square(body.radius);
    }
    return sum;
  }
  /// Whether a point of a face belongs to all other bodies; std::nullopt: unknown.
  std::optional<bool> holds(const ProvenFace& face, const IntervalVector& at) const {
    bool is_known = true;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (i == face.body) continue;
      const Rule& rule = rule_of(i, nullptr);
      const SignSets possible = possible_signs({i, &rule}, at);
      if ((rule.holds & possible) == 0) return false;
      is_known = is_known && (~rule.holds & possible) == 0;
    }
    return is_known ? std::optional(true) : std::nullopt;
  }

  IntervalVector outward(const ProvenFace& face, const IntervalVector& p) const {
    const IntervalVector &axis = bodies_[face.body].axis, P = p - face.centre;
    if (face.surface == Surface::plane) return axis;
    if (face.surface == Surface::torus) {  // minus the gradient of the discriminant
      const Interval l_2 = square(bodies_[face.body].crank);
      return P * (dot(P, P) + l_2 - square(bodies_[face.body].radius)) -
             (P - axis * dot(P, axis)) * (Interval(2) * l_2);
    }
    return (face.surface == Surface::sphere ? P : P - axis * dot(P, axis)) * Interval(face.side);
  }
  /// 1 if the first face is on the left of the direction of increasing u, -1 if the second one is: the same on the
  /// whole arc, because the surfaces do not touch. [-1, 1] if that is not known in a range that may not be active.
  Interval orientation(const ProvenArc& arc, const ProvenRange& range) const {
    const auto p = point(arc, IntervalSeries<1>::variable(0.5 * (range.from + range.to)));
    IntervalVector at, dp;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = p[i].c[0];
      dp[i] = p[i].c[1];
    }
    const IntervalVector n = outward(*arc.a, at);
    const int sign = sign_of(arc.a->body == arc.b->body ? dot(cross(arc.a->away_from_pole, n), dp)
                                                        : dot(cross(n, outward(*arc.b, at)), dp));
    if (sign != 0) return sign;
    if (range.is_certain) throw Unproven{};
    return {-1, 1};
  }

  /// The integrand of the volume, of one order less than p.
  template <std::size_t N>
  IntervalSeries<N - 1> integrand(const ProvenArc& arc, const SeriesVector<N>& p) const {
    SeriesVector<N - 1> at, dp;
    for (std::size_t i = 0; i < 3; ++i) {
      at[i] = truncated(p[i]);
      dp[i] = derivative(p[i]);
    }
    return (three_volumes(*arc.a, at, dp) - three_volumes(*arc.b, at, dp)) * (Interval(1) / Interval(3));
  }
  template <std::size_t N>
  IntervalSeries<N> three_volumes(const ProvenFace& face, const SeriesVector<N>& p, const SeriesVector<N>& dp) const {
    const IntervalBody& body = bodies_[face.body];
    const SeriesVector<N> P = p - series<N>(face.centre);
    const IntervalSeries<N> sum = along(cross(P, dp), face.centre) * Interval(0.5);
    switch (face.surface) {
      case Surface::sphere:
        return sum + dot(cross(series<N>(face.away_from_pole), P), dp) * body.radius /
                         (along(P, face.away_from_pole) * (Interval(1) / body.radius) + IntervalSeries<N>(1.0));
      case Surface::cylinder:
        return sum - along(P, body.axis) * dot(cross(series<N>(body.axis), P), dp);
      case Surface::torus:
        return sum + three_volumes_of_torus(face, P, dp);
      case Surface::plane:
        break;
    }
    return sum;
  }
  /// The part of a torus that is due to its radii, as in forms() of faces.hpp.
  template <std::size_t N>
  IntervalSeries<N> three_volumes_of_torus(const ProvenFace& face, const SeriesVector<N>& P,
                                           const SeriesVector<N>& dp) const {
    const IntervalBody& body = bodies_[face.body];
    const IntervalVector& beside = paths_[face.body].beside;
    const Interval turn = 0.5 * (body.from.middle() + body.to.middle()), s = sin(turn), c = cos(turn);
    const IntervalVector x = body.zero * c + beside * s, y = beside * c - body.zero * s;
    const int outer = sign_of((squared_length(P).c[0] + square(body.crank)) - square(body.radius));
    if (outer == 0) return Interval::everything(Decoration::partial);
    const IntervalSeries<N> u = along(P, x) * Interval(outer), w = along(P, y) * Interval(outer),
                            du = along(dp, x) * Interval(outer), dw = along(dp, y) * Interval(outer),
                            square_of_distance = square(u) + square(w), rate = (u * dw - w * du) / square_of_distance;
    IntervalSeries<N> q(atan2(w.c[0], u.c[0]));
    for (std::size_t k = 1; k <= N; ++k) q.c[k] = rate.c[k - 1] / Interval(static_cast<double>(k));
    const IntervalSeries<N> distance = sqrt(square_of_distance) * Interval(outer),
                            rise = along(P, body.axis) * (Interval(1) / body.radius),
                            cosine = (distance - body.crank) * (Interval(1) / body.radius),
                            db = cosine * along(dp, body.axis) - rise * ((u * du + w * dw) / distance);
    return q * distance * db * (cosine * body.crank + body.radius);
  }

  Interval rough_integral(const ProvenArc& arc, const ProvenRange& range) const {
    const Interval u(range.from, range.to);
    return integrand(arc, point(arc, IntervalSeries<1>::variable(u))).c[0] *
           (Interval(range.to) - Interval(range.from));
  }

  static constexpr std::size_t kOrder = 14;  // of the last term of the integrals, even

  Interval integral(const ProvenArc& arc, double from, double to, int depth) {
    const double middle = 0.5 * (from + to);
    const Interval left = Interval(from) - Interval(middle), right = Interval(to) - Interval(middle);
    const auto wide = integrand(arc, point(arc, IntervalSeries<kOrder + 1>::variable(Interval(from, to))));
    std::optional<Interval> sum;
    if (is_finite(wide.c[kOrder])) {
      const auto centre = integrand(arc, point(arc, IntervalSeries<kOrder + 1>::variable(middle)));
      Interval of_left = left, of_right = right;
      sum = 0;
      double rest = 0;  // width of the first term, which bisection does not reduce
      for (std::size_t k = 0; k <= kOrder; ++k) {
        if (k == 1) rest = sum->width();
        const Interval& c = k == kOrder ? wide.c[k] : centre.c[k];
        *sum += c * (of_right - of_left) * (Interval(1) / Interval(static_cast<double>(k + 1)));
        of_left = of_left * left;
        of_right = of_right * right;
      }
      if (sum->width() <= std::max(kAccuracy * bound_ * bound_ * bound_, 2 * rest)) return *sum;
    }
    if (depth > 30 || !(from < middle && middle < to)) {
      if (!sum) throw Unproven{};
      return *sum;
    }
    return integral(arc, from, middle, depth + 1) + integral(arc, middle, to, depth + 1);
  }

  static constexpr double kAccuracy = 1e-13;  // width of an integral, relative to the cube of the bound
  static constexpr int kMaxDepth = 42;
  static constexpr long kMaxBoxes = 300'000;

  const std::vector<IntervalBody>& bodies_;
  double bound_;
  std::vector<Path> paths_;
  std::vector<ProvenFace> faces_;
  std::vector<ProvenArc> arcs_;
  std::vector<ProvenRange> ranges_;
  std::vector<ProvenTest> tests_;
  long boxes_ = 0;
};

}  // namespace

IntervalBody enclosed(const Body& body) {
  IntervalBody made{.kind = body.kind, .side = body.side, .is_first_root = body.is_first_root};
  made.radius = body.radius;
  made.crank = body.crank;
  made.from = body.from;
  made.to = body.to;
  for (std::size_t i = 0; i < 3; ++i) {
    made.centre[i] = body.centre[i];
    made.axis[i] = body.axis[i];
    made.zero[i] = body.zero[i];
  }
  if (dot(body.axis, body.axis) > 0) made.axis = made.axis * (Interval(1) / length_of(made.axis));
  if (body.kind == Body::Kind::crank) {
    made.zero = made.zero - made.axis * dot(made.axis, made.zero);
    made.zero = made.zero * (Interval(1) / length_of(made.zero));
  }
  return made;
}

std::optional<Interval> proven_volume(const std::vector<IntervalBody>& bodies, double bound) {
  constexpr std::size_t kMaxBodies = 63;
  if (bodies.size() > kMaxBodies) return {};
  try {
    return Proof(bodies, bound).run();
  } catch (const Unproven&) {
    return {};
  }
}

}  // namespace pkm::generic::edges
