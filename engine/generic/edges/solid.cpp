#include "engine/generic/edges/solid.hpp"

#include "engine/generic/edges/curves.hpp"
#include "engine/math/quadrature.hpp"
#include "engine/math/roots.hpp"

namespace pkm::generic::edges {
namespace {

// Bound of the rounding error of a body's function, relative to the size of the solid raised to the power degree().
constexpr double kFunctionRounding = 4e-15;
constexpr int kMaxBisections = 36;
constexpr long kMaxBoxes = 400'000;

/// A test that all points of an intersection curve have to pass: to belong to a body or, if the curve lies on the
/// surface of one of the body's faces, to that face.
struct Test {
  std::size_t body;
  const Rule* rule;
};

/// An interval of u in which all points of an arc are active, i.e. belong to the boundary of the solid.
struct Range {
  const Arc* arc;
  double from, to;
  double sign;  ///< 1: in the direction of increasing u, the first face is on the left; -1: the second face is
};

/// A subinterval of an active range, for quadrature.
struct Panel {
  std::size_t range;
  Subinterval<double> interval;
  double value = 0, error = 0;
  /// Integrals along this subinterval for the moments of the first and of the second face.
  std::array<Moments, 2> moments{};
};

Vector3 values(const Enclosure3& p) { return {{p[0].value, p[1].value, p[2].value}}; }
Vector3 slopes(const Enclosure3& p) { return {{p[0].slope, p[1].slope, p[2].slope}}; }
double largest(const Vector3& v) { return std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])}); }

}  // namespace

class Evaluator {
 public:
  EdgeVolume run(const Solid& solid, double tolerance, std::vector<Body>* gradient) {
    reset(solid);
    constexpr std::size_t kMaxBodies = 63;
    if (bodies_.size() > kMaxBodies || !add_curves()) {
      result_.is_supported = false;
      return result_;
    }
    for (const Arc& arc : arcs_) search(arc);
    close();
    choose_poles();
    integrate(tolerance);
    if (gradient) differentiate(*gradient);
    return result_;
  }

 private:
  void reset(const Solid& solid) {
    bodies_.clear();
    faces_.clear();
    curves_.clear();
    arcs_.clear();
    ranges_.clear();
    undecided_ = 0;
    result_ = {};
    for (const Body& body : solid.bodies) bodies_.emplace_back(body);
    size_ = bound_ = solid.bound;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      add_faces(bodies_[i], i, faces_);
      size_ = std::max(size_, std::fabs(bodies_[i].radius) + bodies_[i].crank + largest(bodies_[i].centre));
    }
    for (std::size_t i = 1; i < powers_.size(); ++i) powers_[i] = powers_[i - 1] * size_;
  }

  bool add_curves() {
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      for (std::size_t j = i + 1; j < faces_.size(); ++j) {
        const Face &a = faces_[i], &b = faces_[j];
        if (a.number != b.number) {
          if (!add_intersection(a, b, bound_, curves_)) return false;
        } else if (b.part == Part::fold) {
          curves_.push_back(equator(a, b));
        }
      }
    }
    for (const Curve& curve : curves_) {
      if (curve.kind == Curve::Kind::implicit)
        trace(curve);
      else if (!add_arcs(curve, bound_, roots_, arcs_))
        result_.is_closed = false;
    }
    return true;
  }

  /// Adds the arcs of an implicit curve on a torus, except those that cannot be active.
  void trace(const Curve& curve) {
    const PreparedBody& torus = *curve.faces[0]->body;
    set_tests(curve);
    long boxes = 0;
    constexpr double kFirst = 0.8;  // maximum width of the initial boxes of the search [rad]
    // Value at which the range of the angle b starts [rad]; it is arbitrary, so that a symmetric solid is unlikely to
    // have a special point there.
    constexpr double kStart = 2.9;
    const double width = torus.to - torus.from;
    const int along_q = static_cast<int>(width / kFirst) + 1, along_b = static_cast<int>(2 * kPi / kFirst) + 1;
    const std::array<double, 2> half{0.5 * width / along_q, kPi / along_b};
    for (int i = 0; i < along_q; ++i)
      for (int j = 0; j < along_b; ++j)
        trace(curve, {{torus.from + (2 * i + 1) * half[0], kStart + (2 * j + 1) * half[1]}, half}, boxes);
  }

  void trace(const Curve& curve, const TorusBox& box, long& boxes) {
    constexpr long kMaxTraced = 20'000;
    if (!result_.is_closed) return;
    if (++boxes > kMaxTraced) {
      result_.is_closed = false;
      return;
    }
    ++result_.boxes;
    const CurveInBox found = find_curve_in(curve.function, box, kFunctionRounding * curve.function.size());
    if (found.state == CurveInBox::State::absent || is_inactive(curve, box)) return;
    if (found.state == CurveInBox::State::unresolved) {
      const std::size_t i = found.longer;
      TorusBox part = box;
      part.half[i] *= 0.5;
      for (const double side : {-1.0, 1.0}) {
        part.middle[i] = box.middle[i] + side * part.half[i];
        trace(curve, part, boxes);
      }
    } else {
      arcs_.push_back(
          {.curve = &curve, .t_0 = found.arc->from, .length = found.arc->to - found.arc->from, .implicit = *found.arc});
    }
  }

  /// Whether every point of a box of the torus's angles fails one of the tests, so that no part of the curve in the box
  /// is active.
  bool is_inactive(const Curve& curve, const TorusBox& box) const {
    const PreparedBody& torus = *curve.faces[0]->body;
    CurvePoint at = point_on(*curve.faces[0], box.middle[0], box.middle[1]);
    const double distance = (torus.crank + torus.radius) * box.half[0] + torus.radius * box.half[1];
    // Enclose the coordinates of all points in the box: as functions, with slope 0 at the middle, of a variable in [-1,
    // 1].
    for (Enclosure& x : at.p) x = {x.value, 0, 2 * distance, 1};
    at.square = {at.square.value, 0, 2 * distance * (2 * norm(values(at.p)) + distance), 1};
    std::array<Enclosure, kFunctions> values;
    return std::ranges::any_of(tests_, [&](const Test& test) {
      const SignSets possible = examine(test, at, values, [&](const Enclosure& f, std::size_t k) {
        return sign(f, powers_[degree(bodies_[test.body], k)], 0);
      });
      return (test.rule->holds & possible) == 0;
    });
  }

  // Search for the active intervals of arcs.

  using Tests = std::uint64_t;  // set of tests: bit i stands for tests_[i]

  /// Sets tests_: the tests that points of a curve have to pass.
  void set_tests(const Curve& curve) {
    const auto& [a, b] = curve.faces;
    tests_.clear();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (i != a->number && i != b->number) {
        tests_.push_back({i, &membership(bodies_[i], nullptr)});
      } else if (a->number != b->number && bodies_[i].kind >= Body::Kind::slide) {
        // A curve on a torus lies in the range of this torus by construction, so that no test is needed.
        const Face& face = i == a->number ? *a : *b;
        if (curve.kind < Curve::Kind::on_torus || &face != a)
          tests_.push_back({i, &membership(bodies_[i], &face.part)});
      }
    }
  }

  void search(const Arc& arc) {
    set_tests(*arc.curve);
    arc_ = &arc;
    first_range_ = ranges_.size();
    // Divide long arcs: enclosures over more than a quarter of a circle are too wide to decide any test.
    const int parts = std::max(1, static_cast<int>(arc.length / 1.6));
    for (int i = 0; i < parts; ++i)
      search(arc.length * i / parts, arc.length * (i + 1) / parts, 0, (Tests{1} << tests_.size()) - 1);
  }

  struct Undecided {
    std::size_t test, function;
  };

  void search(double from, double to, int depth, Tests tests) {
    if (++result_.boxes > kMaxBoxes) {
      result_.is_closed = false;
      return;
    }
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    const CurvePoint at = point(*arc_, Enclosure::variable(middle, half));
    undecided_functions_.clear();
    bool is_monotone = true;
    const auto keep = [&](std::size_t test, std::size_t number, const Enclosure& f) {
      undecided_functions_.push_back({test, number});
      is_monotone = is_monotone && f.is_monotone();
    };
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      if ((tests >> i & 1) == 0) continue;
      const Rule& rule = *tests_[i].rule;
      std::array<Enclosure, kFunctions> values;
      const SignSets possible = examine(tests_[i], at, values, [&](const Enclosure& f, std::size_t k) {
        return sign(f, powers_[degree(bodies_[tests_[i].body], k)], half);
      });
      if ((rule.holds & possible) == 0) {
        // Try this test first in the next interval, because it often decides that interval, too.
        if (i > 0 && depth == 0) std::swap(tests_[i], tests_[0]);
        return;
      }
      if ((~rule.holds & possible) == 0) {
        tests &= ~(Tests{1} << i);
        continue;
      }
      for (std::size_t k = 0; k < kFunctions; ++k)
        if ((rule.depends[k] & possible) != 0 && (kPositive[k] & possible) != 0 && (~kPositive[k] & possible) != 0)
          keep(i, k, values[k]);
    }
    if (arc_->curve->cut) {
      const Enclosure f = edges::evaluate(*arc_->curve->cut, at);
      if (!(std::fabs(f.value) > f.reach() + kFunctionRounding * powers_[2])) keep(tests_.size(), 0, f);
    }
    if (undecided_functions_.empty()) {
      emit(from, to);
      return;
    }
    if (!is_monotone && depth < kMaxBisections) {
      search(from, middle, depth + 1, tests);
      search(middle, to, depth + 1, tests);
      return;
    }
    std::vector<double>& ends = ends_;
    ends.assign({from, to});
    if (is_monotone) {
      for (const auto& [test, number] : undecided_functions_)
        if (const auto root = find_root(test, number, from, to)) ends.push_back(*root);
    } else {
      undecided_ += (to - from) * norm(slopes(at.p)) * powers_[2];
    }
    std::ranges::sort(ends);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      if (ends[i] < ends[i + 1] && is_active(0.5 * (ends[i] + ends[i + 1]), tests)) emit(ends[i], ends[i + 1]);
  }

  /// The combinations of signs of a body's functions that are possible at a point or in an interval of a curve.
  /// Evaluates only the functions that matter for the test, and stores them in `values`.
  /// @param sign_of  sign_of(f, k): sign of the function f with index k, 0 if it is unknown
  template <class Sign>
  SignSets examine(const Test& test, const CurvePoint& at, std::array<Enclosure, kFunctions>& values,
                   const Sign& sign_of) const {
    const Rule& rule = *test.rule;
    SignSets possible = ~SignSets{0};
    for (std::size_t k = 0; k < kFunctions; ++k) {
      if ((rule.depends[k] & possible) == 0) continue;
      values[k] = function(bodies_[test.body], k, at);
      const int is = sign_of(values[k], k);
      if (is != 0) possible &= is > 0 ? kPositive[k] : ~kPositive[k];
    }
    return possible;
  }

  /// Sign of a function on an interval; 0 if unknown. A function that vanishes on the whole curve counts as positive:
  /// it has no sign change, so that both signs are correct.
  static int sign(const Enclosure& f, double power, double half) {
    const double reach = f.reach();
    if (f.value - reach > kFunctionRounding * power) return 1;
    if (f.value + reach < -kFunctionRounding * power) return -1;
    constexpr double kWide = 1e-3, kVanishing = 1e-12;
    return half > kWide && std::fabs(f.value) + reach < kVanishing * power ? 1 : 0;
  }

  Enclosure function_at(std::size_t test, std::size_t number, double u) const {
    const CurvePoint at = point(*arc_, Enclosure::variable(u, 0));
    return test == tests_.size() ? edges::evaluate(*arc_->curve->cut, at)
                                 : function(bodies_[tests_[test].body], number, at);
  }

  /// The value of u in [from, to] at which a monotone function changes its sign; std::nullopt if it does not change it.
  std::optional<double> find_root(std::size_t test, std::size_t number, double from, double to) const {
    const auto at = [&](double u) { return function_at(test, number, u); };
    const double first = at(from).value, last = at(to).value;
    const bool rises = last > 0;
    if (rises == (first > 0)) return {};
    const auto value_at = [&](double u) {
      const Enclosure f = at(u);
      return ValueAndDerivative{f.value, f.slope};
    };
    // After a step, the error of Newton's method is of the order of the square of this step.
    const auto converged = [this](const ValueAndDerivative&, double u, double next) {
      return std::fabs(next - u) < 1e-9 * arc_->length;
    };
    return refine_root_newton(value_at, from, to, first > 0, from - first * ((to - from) / (last - first)), converged);
  }

  bool is_active(double u, Tests tests) const {
    const CurvePoint at = point(*arc_, Enclosure::variable(u, 0));
    for (std::size_t i = 0; i < tests_.size(); ++i)
      if ((tests >> i & 1) != 0 && !is_in(tests_[i], at)) return false;
    return true;
  }

  bool is_in(const Test& test, const CurvePoint& at) const {
    std::array<Enclosure, kFunctions> values;
    const auto sign_of = [](const Enclosure& f, std::size_t) { return f.value >= 0 ? 1 : -1; };
    return (~test.rule->holds & examine(test, at, values, sign_of)) == 0;
  }

  void emit(double from, double to) {
    const Enclosure3 at = point(*arc_, Enclosure::variable(0.5 * (from + to), 0)).p;
    const Vector3 p = values(at), dp = slopes(at);
    const auto& [a, b] = arc_->curve->faces;
    const Vector3 n = outward(*a, p);
    const double side =
        a->number == b->number ? dot(cross(a->away_from_pole, n), dp) : dot(cross(n, outward(*b, p)), dp);
    const double sign = side > 0 ? 1 : -1;
    if (ranges_.size() > first_range_ && ranges_.back().to == from && ranges_.back().sign == sign)
      ranges_.back().to = to;
    else
      ranges_.push_back({arc_, from, to, sign});
  }

  // The following functions compute sums over the active intervals of the arcs.

  /// Checks whether the directed edges of each face form closed curves, and sets `gap` and `is_closed` of the result.
  void close() {
    std::vector<Vector3>& gaps = gaps_;
    gaps.assign(faces_.size(), {});
    for (const Range& range : ranges_) {
      const Vector3 chord = values(point(*range.arc, range.to).p) - values(point(*range.arc, range.from).p);
      gaps[index(range, 0)] += chord * range.sign;
      gaps[index(range, 1)] += chord * -range.sign;
    }
    for (const Vector3& gap : gaps) result_.gap = std::max(result_.gap, largest(gap));
    // Where surfaces touch, as those of limbs with a common axis of symmetry do, the ends of edges are known to the
    // square root of the rounding errors. Gap and undecided length are part of the error.
    constexpr double kClosed = 1e-7;
    if (result_.gap > kClosed * size_ || undecided_ > kClosed * powers_[3]) result_.is_closed = false;
  }

  std::size_t index(const Range& range, std::size_t which) const {
    return static_cast<std::size_t>(range.arc->curve->faces[which] - faces_.data());
  }

  /// Chooses for each whole sphere the point at which its differential form is singular (away_from_pole), far from the
  /// edges.
  void choose_poles() {
    for (Face& face : faces_) {
      if (face.body->kind != Body::Kind::sphere) continue;
      double best = -1;
      for (int i = 0; i < 27; ++i) {
        const Vector3 v{{i % 3 - 1.1, i / 3 % 3 - 0.9, i / 9 - 1.2}};
        const Vector3 t = v * (1 / norm(v));
        double least = 2;
        for (const Range& range : ranges_) {
          if (range.arc->curve->faces[0] != &face && range.arc->curve->faces[1] != &face) continue;
          for (int k = 0; k <= 4; ++k) {
            const Vector3 p = values(point(*range.arc, range.from + 0.25 * k * (range.to - range.from)).p);
            least = std::min(least, 1 + dot(t, p - face.centre) / face.body->radius);
          }
        }
        if (least <= best) continue;
        best = least;
        face.away_from_pole = t;
      }
    }
  }

  void integrate(double tolerance) {
    moments_.assign(faces_.size(), {});
    double sum = 0, error = 0, magnitude = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Face& face = faces_[i];
      if (face.body->kind != Body::Kind::sphere) continue;
      const Vector3 pole = face.centre - face.away_from_pole * face.body->radius;
      CurvePoint at{.p = {}, .square = Enclosure(dot(pole, pole))};
      std::ranges::copy(pole, at.p.begin());
      bool is_active = true;
      for (std::size_t k = 0; k < bodies_.size() && is_active; ++k)
        is_active = k == face.number || is_in({k, &membership(bodies_[k], nullptr)}, at);
      if (!is_active) continue;
      moments_[i].radius[0] = face.side * 4 * kPi * face.body->radius * face.body->radius;
      sum += three_volumes(face, moments_[i]) / 3;
    }
    std::vector<Panel>& panels = panels_;
    panels.clear();
    for (std::size_t i = 0; i < ranges_.size(); ++i) panels.push_back({i, {ranges_[i].from, ranges_[i].to}});
    for (Panel& panel : panels) evaluate(panel);
    const auto total = [&](auto member) {
      double all = 0;
      for (const Panel& panel : panels) all += std::fabs(panel.*member);
      return all;
    };
    magnitude = std::fabs(sum);
    for (const Panel& panel : panels) sum += panel.value;
    magnitude += total(&Panel::value);
    error = total(&Panel::error);
    constexpr std::size_t kMaxPanels = 2000;
    while (error > std::max(tolerance * std::fabs(sum), 1e-15 * magnitude) && panels.size() < kMaxPanels) {
      const auto worst = std::ranges::max_element(panels, {}, &Panel::error);
      const auto index = static_cast<std::size_t>(worst - panels.begin());
      const double before = worst->value;
      bisect_cell(panels, index, [&](Panel& panel) { evaluate(panel); });
      sum += panels[index].value + panels.back().value - before;
      error = total(&Panel::error);
    }
    for (const Panel& panel : panels)
      for (std::size_t k = 0; k < 2; ++k) moments_[index(ranges_[panel.range], k)].add(panel.moments[k], 1);
    result_.value = std::max(sum, 0.0);
    result_.error = error + undecided_ + result_.gap * powers_[2] + 1e-15 * magnitude;
    if (!std::isfinite(sum + result_.error)) result_.is_closed = false;
  }

  void evaluate(Panel& panel) {
    const Range& range = ranges_[panel.range];
    const NestedRule& rule = kronrod_rule();
    const NestedRule::Level& level = rule.level.front();
    const auto& faces = range.arc->curve->faces;
    std::array<double, NestedRule::kNodes> f{};
    const double length = panel.interval.upper - panel.interval.lower;
    panel.value = 0;
    panel.moments = {};
    for (std::size_t i = 0; i < level.nodes; ++i) {
      const Enclosure3 at = point(*range.arc, Enclosure::variable(panel.interval.lower + length * rule.node[i], 0)).p;
      const Vector3 p = values(at), dp = slopes(at) * (length * range.sign);
      for (std::size_t k = 0; k < 2; ++k) {
        const double sign = k == 0 ? 1 : -1;
        const Moments m = forms(*faces[k], p, dp);
        panel.moments[k].add(m, sign * level.weight[i]);
        f[i] += sign * three_volumes(*faces[k], m) / 3;
      }
      panel.value += level.weight[i] * f[i];
    }
    panel.error = rule_error(level, f, panel.value);
    result_.nodes += static_cast<long>(level.nodes);
  }

  /// Computes the derivatives of the volume. The derivative with respect to a parameter is the integral of the normal
  /// speed of the faces.
  void differentiate(std::vector<Body>& gradient) const {
    gradient.assign(bodies_.size(), Body{});
    for (std::size_t i = 0; i < bodies_.size(); ++i) gradient[i].side = gradient[i].radius = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Face& face = faces_[i];
      const PreparedBody& body = *face.body;
      const Moments& m = moments_[i];
      Body& by = gradient[face.number];
      // The normal speed of a plane is the change of `radius` minus (change of `axis`) . p.
      if (face.surface == Surface::plane) {
        const double area = dot(body.axis, m.normal);
        by.radius = area;
        by.axis = cross(m.rotation, body.axis) - body.axis * (area * body.radius);
        continue;
      }
      by.centre += m.normal;
      by.radius += m.radius[0];
      if (face.surface == Surface::cylinder || face.surface == Surface::torus) {
        by.axis += cross(m.rotation, body.axis);
        by.crank += m.radius[1];
      } else if (body.kind == Body::Kind::slide || body.kind == Body::Kind::crank) {
        const auto e = static_cast<std::size_t>(face.part);
        const double q = e == 0 ? body.from : body.to, by_q = dot(body.along[e], m.normal);
        if (body.kind == Body::Kind::slide) {
          (e == 0 ? by.from : by.to) = by_q;
          by.axis += m.normal * q;
        } else {
          (e == 0 ? by.from : by.to) = by_q * body.crank;
          const auto [s, c] = portable::sincos(q);
          by.crank += dot(body.zero * c + body.beside * s, m.normal);
          by.zero += (m.normal * c + cross(m.normal, body.axis) * s) * body.crank;
          by.axis += cross(body.zero, m.normal) * (s * body.crank);
        }
      }
    }
  }

  double bound_ = 0, size_ = 0;
  std::array<double, 5> powers_{1};
  std::vector<PreparedBody> bodies_;
  std::vector<Face> faces_;
  std::vector<Curve> curves_;
  std::vector<Arc> arcs_;
  std::vector<Range> ranges_;
  std::vector<Moments> moments_;
  std::vector<Vector3> gaps_;
  std::vector<Panel> panels_;
  std::vector<CurveRoot> roots_;
  double undecided_ = 0;
  EdgeVolume result_;

  // Variables of the search along the arc arc_.
  const Arc* arc_ = nullptr;
  std::vector<Test> tests_;
  std::vector<Undecided> undecided_functions_;
  std::vector<double> ends_;
  std::size_t first_range_ = 0;
};

VolumeScratch::VolumeScratch() : evaluator_(std::make_unique<Evaluator>()) {}
VolumeScratch::~VolumeScratch() = default;

EdgeVolume volume(const Solid& solid, double tolerance, VolumeScratch& scratch, std::vector<Body>* gradient) {
  return scratch.evaluator_->run(solid, tolerance, gradient);
}

}  // namespace pkm::generic::edges
