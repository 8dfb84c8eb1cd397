#include "engine/generic/edges/edge_search.hpp"

#include <algorithm>

#include "engine/math/roots.hpp"

namespace pkm::generic::edges {
namespace {

// Bound of the rounding error of a body's function, relative to the size of the solid raised to the power degree().
constexpr double kFunctionRounding = 4e-15;
constexpr int kMaxBisections = 36;
constexpr long kMaxBoxes = 400'000;

/// Sign of a function on an interval; 0 if unknown. A function that vanishes on the whole curve counts as positive:
/// it has no sign change, so that both signs are correct.
int sign(const Enclosure& f, double power, double half) {
  const double reach = f.reach();
  if (f.value - reach > kFunctionRounding * power) return 1;
  if (f.value + reach < -kFunctionRounding * power) return -1;
  constexpr double kWide = 1e-3, kVanishing = 1e-12;
  return half > kWide && std::fabs(f.value) + reach < kVanishing * power ? 1 : 0;
}

}  // namespace

bool EdgeSearch::find(const Solid& solid) {
  bodies_.clear();
  faces_.clear();
  curves_.clear();
  arcs_.clear();
  edges_.clear();
  undecided_ = 0;
  boxes_ = 0;
  is_complete_ = true;
  for (const Body& body : solid.bodies) bodies_.emplace_back(body);
  bound_ = solid.bound;
  double size = bound_;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    add_faces(bodies_[i], i, faces_);
    size = std::max(size, std::fabs(bodies_[i].radius) + bodies_[i].crank + largest(bodies_[i].centre));
  }
  for (std::size_t i = 1; i < powers_.size(); ++i) powers_[i] = powers_[i - 1] * size;
  constexpr std::size_t kMaxBodies = 63;
  if (bodies_.size() > kMaxBodies || !add_curves()) return false;
  for (const Arc& arc : arcs_) search(arc);
  return true;
}

bool EdgeSearch::add_curves() {
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
      is_complete_ = false;
  }
  return true;
}

/// Adds the arcs of an implicit curve on a torus, except those that cannot be active.
void EdgeSearch::trace(const Curve& curve) {
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

void EdgeSearch::trace(const Curve& curve, const TorusBox& box, long& boxes) {
  constexpr long kMaxTraced = 20'000;
  if (!is_complete_) return;
  if (++boxes > kMaxTraced) {
    is_complete_ = false;
    return;
  }
  ++boxes_;
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
bool EdgeSearch::is_inactive(const Curve& curve, const TorusBox& box) const {
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

/// Sets tests_: the tests that points of a curve have to pass.
void EdgeSearch::set_tests(const Curve& curve) {
  const auto& [a, b] = curve.faces;
  tests_.clear();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (i != a->number && i != b->number) {
      tests_.push_back({i, &membership(bodies_[i], nullptr)});
    } else if (a->number != b->number && bodies_[i].kind >= Body::Kind::slide) {
      // A curve on a torus lies in the range of this torus by construction, so that no test is needed.
      const Face& face = i == a->number ? *a : *b;
      if (curve.kind < Curve::Kind::on_torus || &face != a) tests_.push_back({i, &membership(bodies_[i], &face.part)});
    }
  }
}

void EdgeSearch::search(const Arc& arc) {
  set_tests(*arc.curve);
  arc_ = &arc;
  first_edge_ = edges_.size();
  // Divide long arcs: enclosures over more than a quarter of a circle are too wide to decide any test.
  const int parts = std::max(1, static_cast<int>(arc.length / 1.6));
  for (int i = 0; i < parts; ++i)
    search(arc.length * i / parts, arc.length * (i + 1) / parts, 0, (Tests{1} << tests_.size()) - 1);
}

void EdgeSearch::search(double from, double to, int depth, Tests tests) {
  if (++boxes_ > kMaxBoxes) {
    is_complete_ = false;
    return;
  }
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  const CurvePoint at = point(*arc_, Enclosure::variable(middle, half));
  undecided_functions_.clear();
  bool is_monotone = true;
  std::array<Enclosure, kFunctions> values;
  const auto keep = [&](std::size_t test, std::size_t number, const Enclosure& f) {
    undecided_functions_.push_back({test, number});
    is_monotone = is_monotone && f.is_monotone();
  };
  for (std::size_t i = 0; i < tests_.size(); ++i) {
    if ((tests >> i & 1) == 0) continue;
    const Rule& rule = *tests_[i].rule;
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
SignSets EdgeSearch::examine(const Test& test, const CurvePoint& at, std::array<Enclosure, kFunctions>& values,
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

Enclosure EdgeSearch::function_at(std::size_t test, std::size_t number, double u) const {
  const CurvePoint at = point(*arc_, Enclosure::variable(u, 0));
  return test == tests_.size() ? edges::evaluate(*arc_->curve->cut, at)
                               : function(bodies_[tests_[test].body], number, at);
}

/// The value of u in [from, to] at which a monotone function changes its sign; std::nullopt if it does not change it.
std::optional<double> EdgeSearch::find_root(std::size_t test, std::size_t number, double from, double to) const {
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

bool EdgeSearch::is_active(double u, Tests tests) const {
  const CurvePoint at = point(*arc_, Enclosure::variable(u, 0));
  for (std::size_t i = 0; i < tests_.size(); ++i)
    if ((tests >> i & 1) != 0 && !is_in(tests_[i], at)) return false;
  return true;
}

bool EdgeSearch::is_in(const Test& test, const CurvePoint& at) const {
  std::array<Enclosure, kFunctions> values;
  const auto sign_of = [](const Enclosure& f, std::size_t) { return f.value >= 0 ? 1 : -1; };
  return (~test.rule->holds & examine(test, at, values, sign_of)) == 0;
}

void EdgeSearch::emit(double from, double to) {
  const Enclosure3 at = point(*arc_, Enclosure::variable(0.5 * (from + to), 0)).p;
  const Vector3 p = values(at), dp = slopes(at);
  const auto& [a, b] = arc_->curve->faces;
  const Vector3 n = outward(*a, p);
  const double side = a->number == b->number ? dot(cross(a->away_from_pole, n), dp) : dot(cross(n, outward(*b, p)), dp);
  const double sign = side > 0 ? 1 : -1;
  if (edges_.size() > first_edge_ && edges_.back().to == from && edges_.back().sign == sign)
    edges_.back().to = to;
  else
    edges_.push_back({arc_, from, to, sign});
}

bool EdgeSearch::is_in_others(std::size_t body, const CurvePoint& at) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (i != body && !is_in({i, &membership(bodies_[i], nullptr)}, at)) return false;
  return true;
}

}  // namespace pkm::generic::edges
