#include "engine/generic/edges/proven_volume.hpp"

#include "engine/generic/edges/proven_curves.hpp"

namespace pkm::generic::edges {
namespace proven {

class Proof : public ProvenCurves {
 public:
  Proof(const std::vector<IntervalBody>& bodies, double bound) : ProvenCurves(bodies, bound) {}

  Interval run() {
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
  void search(std::size_t index) {
    const ProvenArc& arc = arcs_[index];
    set_tests(*arc.a, *arc.b);
    const Tests all = (Tests{1} << tests_.size()) - 1;
    // Each end of the arc is known only to within an interval: examine these two intervals separately.
    if (arc.from.lower < arc.from.upper) search(index, arc.from.lower, arc.from.upper, kMaxDepth, all);
    search(index, arc.from.upper, arc.to.lower, 0, all);
    if (arc.to.lower < arc.to.upper) search(index, arc.to.lower, arc.to.upper, kMaxDepth, all);
  }

  void search(std::size_t index, double from, double to, int depth, Tests tests) {
    count();
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
        // If there may be no point at `middle`, the mean value theorem cannot be applied.
        if (sign_of(f.c[0]) != 0 || !exists) return sign_of(f.c[0]);
        const Interval at_centre = function(body, k, centre).c[0], change = f.c[1] * shift;
        const int sign = sign_of(at_centre + change);
        // Bisection is useless if the value at `middle`, a single point, is already as uncertain as its change over the
        // interval.
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

  // Integrals along the edges of the solid.

  /// Chooses for each whole sphere the point at which its differential form is singular (away_from_pole), far from the
  /// edges.
  /// @return the sum of `side` times the volume of the sphere, over the spheres whose singular point belongs to the
  ///         boundary of the solid
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
  /// Whether a point of a face belongs to the bodies of all other faces; std::nullopt if this is unknown.
  /// @param at  the point
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
  /// 1 if, in the direction of increasing u, the first face of an arc is on the left; -1 if the second face is. The
  /// value is the same on the whole arc, because the surfaces do not touch. [-1, 1] if it is unknown, which is possible
  /// only in a range that is not certain to be active.
  Interval orientation(const ProvenArc& arc, const ProvenRange& range) const {
    if (arc.is_on_torus && !range.is_certain) return {-1, 1};  // the arc may have no point in this range
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
  Interval rough_integral(const ProvenArc& arc, const ProvenRange& range) const {
    const Interval u(range.from, range.to);
    return integrand(arc, point(arc, IntervalSeries<1>::variable(u))).c[0] *
           (Interval(range.to) - Interval(range.from));
  }

  // Order of the last term of the Taylor series that is integrated; it must be even.
  static constexpr std::size_t kOrder = 14;

  Interval integral(const ProvenArc& arc, double from, double to, int depth) {
    const double middle = 0.5 * (from + to);
    const Interval left = Interval(from) - Interval(middle), right = Interval(to) - Interval(middle);
    const auto wide = integrand(arc, point(arc, IntervalSeries<kOrder + 1>::variable(Interval(from, to))));
    std::optional<Interval> sum;
    if (is_finite(wide.c[kOrder])) {
      const auto centre = integrand(arc, point(arc, IntervalSeries<kOrder + 1>::variable(middle)));
      Interval of_left = left, of_right = right;
      sum = 0;
      double rest = 0;  // width of the integral of the constant term, which bisection does not reduce
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

  static constexpr double kAccuracy = 1e-13;  // accepted width of an integral, relative to the cube of bound_
  static constexpr int kMaxDepth = 42;

  std::vector<ProvenRange> ranges_;
};

}  // namespace proven

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
  if (dot(body.axis, body.axis) > 0) made.axis = made.axis * (Interval(1) / proven::length_of(made.axis));
  if (body.kind == Body::Kind::crank) {
    made.zero = made.zero - made.axis * dot(made.axis, made.zero);
    made.zero = made.zero * (Interval(1) / proven::length_of(made.zero));
  }
  return made;
}

std::optional<Interval> proven_volume(const std::vector<IntervalBody>& bodies, double bound) {
  constexpr std::size_t kMaxBodies = 63;
  if (bodies.size() > kMaxBodies) return {};
  try {
    return proven::Proof(bodies, bound).run();
  } catch (const proven::Unproven&) {
    return {};
  }
}

}  // namespace pkm::generic::edges
