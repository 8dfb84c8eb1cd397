// Intersection curves of the faces of a solid, divided into arcs without turning points, in interval arithmetic.
#pragma once

#include "engine/generic/edges/proven_solid.hpp"

namespace pkm::generic::edges::proven {

class ProvenCurves : public ProvenSolid {
 protected:
  ProvenCurves(const std::vector<IntervalBody>& bodies, double bound) : ProvenSolid(bodies, bound) {
    for (std::size_t i = 0; i < faces_.size(); ++i)
      for (std::size_t j = i + 1; j < faces_.size(); ++j) {
        const ProvenFace &a = faces_[i], &b = faces_[j];
        if (a.body != b.body)
          add_curves(a, b);
        else if (b.part == Part::fold)
          add_circle({&a, &b}, a.centre, paths_[a.body].along[a.part == Part::first ? 0 : 1], bodies_[a.body].radius);
      }
  }

  // Decides which points of a curve are active, i.e. belong to all bodies and to both faces.

  struct ProvenTest {
    std::size_t body;
    const Rule* rule;
  };
  using Tests = std::uint64_t;  // set of tests: bit i stands for tests_[i]

  const Rule& rule_of(std::size_t body, const Part* face) const {
    const IntervalBody& b = bodies_[body];
    const Interval range = b.to - b.from;
    if (b.kind == Body::Kind::crank && range.lower <= next_up(kPi) && range.upper > kPi) throw Unproven{};
    return membership({.kind = b.kind, .to = range.upper, .is_first_root = b.is_first_root}, face);
  }

  /// Sets tests_: the tests that points of an intersection curve of two faces have to pass.
  void set_tests(const ProvenFace& a, const ProvenFace& b) {
    tests_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (i != a.body && i != b.body)
        tests_.push_back({i, &rule_of(i, nullptr)});
      else if (a.body != b.body && has_range(bodies_[i]) && !(i == a.body && a.surface == Surface::torus))
        // If the curve is on the torus of face a, its angle q is restricted to the range of q by construction, so that
        // no test is needed.
        tests_.push_back({i, &rule_of(i, i == a.body ? &a.part : &b.part)});
    }
  }
  /// The combinations of signs of a body's functions that are possible for a set of points.
  /// @param sign  sign(k): sign of function k if it is the same at all these points, otherwise 0
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
  /// The combinations of signs of a body's functions that are possible for the points of a box.
  SignSets possible_signs(const ProvenTest& test, const IntervalVector& box) const {
    const SeriesVector<0> p = series<0>(box);
    return possible_signs(*test.rule, [&](std::size_t k) { return sign_of(function(test.body, k, p).c[0]); });
  }
  /// Whether every point of a box fails one of the tests that set_tests() has collected, so that no point of the curve
  /// in it is active.
  bool is_inactive(const IntervalVector& box) const {
    return std::ranges::any_of(
        tests_, [&](const ProvenTest& test) { return (test.rule->holds & possible_signs(test, box)) == 0; });
  }

  /// Counts one more examined interval; throws Unproven if there are too many.
  void count() {
    constexpr long kMaxBoxes = 300'000;
    if (++boxes_ > kMaxBoxes) throw Unproven{};
  }

  std::vector<ProvenArc> arcs_;
  std::vector<ProvenTest> tests_;

 private:
  // Adds the intersection curves of two faces, with the same distinction of cases as in curves.cpp.

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
      if (!(distance.lower > 0)) {  // the spheres are concentric, or nearly so
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
    // the curve consists of points of generators o(t) + s axis with A s^2 + 2 B(t) s + C(t) = 0
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

  // The following functions find curves on a torus, in boxes of the angles q of the crank and b around the fold.

  struct AngleBox {
    /// Lower and upper end of the range of the angle q, and of b. An end is a number, or an interval that contains a
    /// limit which is known only approximately.
    std::array<std::array<Interval, 2>, 2> ends;
    Interval range(std::size_t i) const { return {ends[i][0].lower, ends[i][1].upper}; }
  };

  void add_curves_on_torus(const ProvenFace& a, const ProvenFace& b) {
    set_tests(a, b);
    const IntervalBody& body = bodies_[a.body];
    constexpr double kFirst = 0.8;  // maximum width of the initial boxes of the search [rad]
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
    count();
    const std::array<Interval, 2> angles{box.range(0), box.range(1)};
    if (is_inactive(on_torus(a, angles[0], angles[1]))) return;
    const auto middle = [](const Interval& x) { return IntervalSeries<0>(0.5 * (x.lower + x.upper)); };
    const std::array<Interval, 2> by{slope_on_torus(a, b, 0, angles), slope_on_torus(a, b, 1, angles)};
    Interval f = function_on_torus(a, b, middle(angles[0]), middle(angles[1])).c[0];
    for (std::size_t i = 0; i < 2; ++i) f += by[i] * (angles[i] - middle(angles[i]).c[0]);
    if (sign_of(f) != 0) return;
    // Use the angle along which the curve is flatter as parameter of the curve. The part of the torus in the box must
    // not reach the axis of the torus.
    const IntervalBody& body = bodies_[a.body];
    const std::size_t steeper = std::fabs(by[1].middle()) >= std::fabs(by[0].middle()) ? 1 : 0;
    if (sign_of(body.crank + body.radius * cos(angles[1])) != 0)
      for (const std::size_t other : {steeper, 1 - steeper}) {
        // Enclosures of a curve that is steeper than kSteepest are wide: bisect the box instead, unless its side is
        // shorter than kAnySlope [rad].
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

  // Divides a curve with the parameter t into arcs.

  // Angle at which the division of a closed curve starts [rad]; it is arbitrary, and therefore unlikely to coincide
  // with a special point.
  static constexpr double kStart = 0.1234;
  // maximum length of an arc [rad]: over more than a quarter of a circle enclosures are too wide to decide a test
  static constexpr double kLongest = 1.6;
  static Interval end_of_turn() { return Interval(kPi, next_up(kPi)) * Interval(2) + Interval(kStart); }

  void add_whole_turn(const ProvenArc& arc) { add_arcs(arc, kStart, end_of_turn()); }
  /// Adds the arcs of a curve for t in [from, to], an interval in which the polynomial D has no root.
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

  /// A value of t at which a curve is divided: a root of the polynomial D, or an interval in which no point of the two
  /// branches is active.
  struct Division {
    Interval t;
    bool is_root;
  };

  bool is_inactive(const ProvenArc& arc, const Interval& t, const Interval& D) const {
    const double root = sqrt(D).upper;
    return is_inactive(arc.o + arc.x * cos(t) + arc.y * sin(t) + arc.w * Interval(-root, root));
  }
  /// Divides the interval [from, to] of t, and appends its roots of D and the intervals without active points in
  /// ascending order.
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
      // The sign of D in the middle is not decided: contract the enclosure from both sides.
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

  long boxes_ = 0;
};

}  // namespace pkm::generic::edges::proven
