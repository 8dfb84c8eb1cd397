// A solid of planes, spheres, cylinders and tori whose numbers lie in intervals: its faces, and functions, points and
// integrands of its edges, by Taylor series in interval arithmetic (proven_volume.hpp).
#pragma once

#include <algorithm>

#include "engine/generic/edges/faces.hpp"
#include "engine/generic/edges/interval_series.hpp"
#include "engine/generic/edges/proven_volume.hpp"
#include "engine/math/portable.hpp"

namespace pkm::generic::edges::proven {

template <std::size_t N>
using SeriesVector = Vector<IntervalSeries<N>, 3>;

/// Thrown if no bounds of the volume can be proven.
struct Unproven {};

inline bool is_zero(const Interval& x) { return x.lower == 0 && x.upper == 0; }
/// 1 or -1 if all values of the interval have this sign, otherwise 0: the sign is unknown.
inline int sign_of(const Interval& x) { return x.lower > 0 ? 1 : x.upper < 0 ? -1 : 0; }
/// Whether all values of the interval are positive. Throws Unproven if the sign is unknown.
inline bool is_positive(const Interval& x) {
  const int sign = sign_of(x);
  if (sign == 0) throw Unproven{};
  return sign > 0;
}
inline bool is_finite(const Interval& x) { return std::isfinite(x.lower) && std::isfinite(x.upper); }
inline Interval length_of(const IntervalVector& v) { return sqrt(square(v[0]) + square(v[1]) + square(v[2])); }
inline IntervalVector operator-(const IntervalVector& v) { return v * Interval(-1); }

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

/// A box that contains the ball of the given radius about the origin.
inline IntervalVector within_ball(double radius) {
  const Interval any(-radius, radius);
  return {{any, any, any}};
}

/// An arbitrary unit vector that is normal to a given unit vector.
inline IntervalVector normal_to(const IntervalVector& axis) {
  IntervalVector e{};
  std::size_t smallest = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::fabs(axis[i].middle()) < std::fabs(axis[smallest].middle())) smallest = i;
  e[smallest] = 1;
  const IntervalVector v = cross(axis, e);
  return v * (Interval(1) / length_of(v));
}

// Coefficients of a[0] + a[1] cos t + a[2] sin t; with five elements, also those of cos 2t and sin 2t.
using IntervalLinear = std::array<Interval, 3>;
using IntervalTrigonometric = std::array<Interval, 5>;

inline IntervalTrigonometric product(const IntervalLinear& a, const IntervalLinear& b) {
  const Interval half(0.5), cosines = a[1] * b[1], sines = a[2] * b[2];
  return {a[0] * b[0] + half * (cosines + sines), a[0] * b[1] + a[1] * b[0], a[0] * b[2] + a[2] * b[0],
          half * (cosines - sines), half * (a[1] * b[2] + a[2] * b[1])};
}
/// Value of a trigonometric polynomial D at t. slope() returns its derivative D'(t).
inline Interval value(const IntervalTrigonometric& D, const Interval& t) {
  const Interval c = cos(t), s = sin(t);
  return D[0] + D[1] * c + D[2] * s + D[3] * (square(c) - square(s)) + D[4] * Interval(2) * s * c;
}
inline Interval slope(const IntervalTrigonometric& D, const Interval& t) {
  return value({0, D[2], -D[1], Interval(2) * D[4], Interval(-2) * D[3]}, t);
}

struct ProvenFace {
  std::size_t body;
  Part part = Part::first;
  Surface surface = Surface::plane;
  IntervalVector centre{};
  double side = 1;
  /// Sphere only: unit vector from the point at which its differential form is singular, to the centre.
  IntervalVector away_from_pole{};
};

/// A part of the intersection curve of two faces a and b, as a function p(u). A straight line is p = o + u x. On a
/// torus a, with the angles q of the crank and b around the fold, u is one of the angles; for each u, the other one is
/// the only root in `across` of the function f of the second face, or there is no root and no point. Otherwise p = o +
/// x cos t + y sin t + w sqrt(D(t)), where t = t_0 + 2 asin(s), with s = u, or s = +-u^2 if D(t_0) = 0.
struct ProvenArc {
  const ProvenFace* a = nullptr;
  const ProvenFace* b = nullptr;
  bool is_line = false, has_root = false, is_on_torus = false;
  IntervalVector o{}, x{}, y{}, w{};
  IntervalTrigonometric D{};      ///< coefficients of D as a trigonometric polynomial in t - t_0
  Interval cosine = 1, sine = 0;  ///< cosine and sine of t_0, the value of t at u = 0
  double direction = 0;           ///< 1 or -1: sign of s in s = +-u^2; 0: D(t_0) is not 0, and s = u
  Interval from{}, to{};          ///< lower and upper end of the range of u; each is an interval that contains the end
  std::size_t along = 0;          ///< on a torus: which angle is u; 0: q, 1: b
  std::array<Interval, 2> across{};  ///< on a torus: lower and upper limit of the angle that is not u
};

struct ProvenRange {
  std::size_t arc;
  double from, to;
  bool is_certain;  ///< true: all points of the range are active; false: it is unknown which ones are
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
  const S s_2 = square(s), k = sqrt(S(1.0) - s_2);  // square of the sine, and cosine, of (t - t_0) / 2
  const S c_1 = S(1.0) - s_2 * Interval(2), s_1 = s * k * Interval(2);  // cosine and sine of t - t_0
  const S c_t = c_1 * arc.cosine - s_1 * arc.sine, s_t = s_1 * arc.cosine + c_1 * arc.sine;
  for (std::size_t i = 0; i < 3; ++i) p[i] = c_t * arc.x[i] + s_t * arc.y[i] + arc.o[i];
  if (!arc.has_root) return p;
  const IntervalTrigonometric& D = arc.D;
  S root;
  if (at_root) {  // R = D / s; the constant term D[0] + D[1] + D[3] = D(t_0) of D is 0
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

inline bool has_range(const IntervalBody& body) {
  return body.kind == Body::Kind::slide || body.kind == Body::Kind::crank;
}

/// The path of a rod's end E: the point E and the unit vector along the path, at q = from and at q = to.
struct Path {
  std::array<IntervalVector, 2> end{}, along{};
  IntervalVector beside{};  ///< crank only: the unit vector axis x zero
};

inline Path path_of(const IntervalBody& body) {
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

class ProvenSolid {
 protected:
  ProvenSolid(const std::vector<IntervalBody>& bodies, double bound) : bodies_(bodies), bound_(bound) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      paths_.push_back(path_of(bodies_[i]));
      add_faces(i);
    }
  }

  /// An implicit function of a body (function() of faces.hpp) in interval arithmetic: its Taylor series along a curve,
  /// from the series p of the curve's points.
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
  /// The function that is 0 on the surface of `face`, as a Taylor series for points of a torus with the angles q and b.
  template <std::size_t N>
  IntervalSeries<N> function_on_torus(const ProvenFace& torus, const ProvenFace& face, const IntervalSeries<N>& q,
                                      const IntervalSeries<N>& b) const {
    const IntervalBody& body = bodies_[face.body];
    const std::size_t number = !has_range(body) || face.part == Part::first ? 0 : face.part == Part::second ? 1 : 4;
    return function(face.body, number, on_torus(torus, q, b));
  }
  /// Enclosure of the derivative of function_on_torus() with respect to one of the two angles, for all angles in a box.
  /// @param by  the angle; 0: q, 1: b
  Interval slope_on_torus(const ProvenFace& torus, const ProvenFace& face, std::size_t by,
                          const std::array<Interval, 2>& angles) const {
    std::array<IntervalSeries<1>, 2> at{angles[0], angles[1]};
    at[by].c[1] = 1;
    return function_on_torus(torus, face, at[0], at[1]).c[1];
  }

  /// On an arc on a torus, the angle that is not the parameter, as a Taylor series of the parameter u.
  template <std::size_t N>
  IntervalSeries<N> other_angle(const ProvenArc& arc, const IntervalSeries<N>& u) const {
    const auto value = [&]<std::size_t M>(const IntervalSeries<M>& along, const IntervalSeries<M>& other) {
      return arc.along == 0 ? function_on_torus(*arc.a, *arc.b, along, other)
                            : function_on_torus(*arc.a, *arc.b, other, along);
    };
    Interval root(arc.across[0].lower, arc.across[1].upper), slope;
    for (int i = 0; i < 5; ++i) {  // interval Newton method with at most five steps
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

  /// Whether an arc on a torus has a point at every u in an interval. @return 1: at every u, -1: at no u, 0: unknown
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

  IntervalVector outward(const ProvenFace& face, const IntervalVector& p) const {
    const IntervalVector &axis = bodies_[face.body].axis, P = p - face.centre;
    if (face.surface == Surface::plane) return axis;
    if (face.surface == Surface::torus) {  // the normal is minus the gradient of the discriminant
      const Interval l_2 = square(bodies_[face.body].crank);
      return P * (dot(P, P) + l_2 - square(bodies_[face.body].radius)) -
             (P - axis * dot(P, axis)) * (Interval(2) * l_2);
    }
    return (face.surface == Surface::sphere ? P : P - axis * dot(P, axis)) * Interval(face.side);
  }

  /// The integrand of the volume along an arc as a Taylor series. Its order N - 1 is lower by one than that of p,
  /// because it contains the derivative of p. @param p  series of the arc's points
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
  /// The term of three_volumes() that is due to crank and rod of a torus, as in forms() of faces.hpp.
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

  const std::vector<IntervalBody>& bodies_;
  double bound_;
  std::vector<Path> paths_;
  std::vector<ProvenFace> faces_;

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
};

}  // namespace pkm::generic::edges::proven
