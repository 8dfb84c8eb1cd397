// Adaptive Gauss-Kronrod and Gauss-Patterson quadrature over subintervals on which the integrand is smooth, with
// square-root singularities allowed at the endpoints.
//
// A subinterval [lower, upper] is mapped to [0, 1] by a variable transformation that makes the integrand smooth at such
// an endpoint: t^2 for a singularity at one end, 3 t^2 - 2 t^3 for singularities at both. The endpoints may be dual
// numbers. The nodes then have derivatives too, and the derivative of the quadrature formula approximates that of the
// integral, including the dependence on its bounds.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/math/scalar.hpp"

namespace pkm {

/// A subinterval of the range of integration, to which a quadrature rule is applied.
template <class S>
struct Subinterval {
  S lower, upper;
  bool sqrt_at_lower = false;  ///< the integrand behaves like a square root at `lower`
  bool sqrt_at_upper = false;  ///< the integrand behaves like a square root at `upper`
};

/// A quadrature node, mapped from [0, 1] to a subinterval.
template <class S>
struct MappedNode {
  S point;
  S jacobian;  ///< derivative of the point with respect to t
};

/// Variable transformation from t in [0, 1] to a subinterval.
template <class S>
MappedNode<S> map_node(const Subinterval<S>& interval, double t) {
  const S length = interval.upper - interval.lower;
  if (interval.sqrt_at_lower && interval.sqrt_at_upper) {
    return {interval.lower + length * (t * t * (3 - 2 * t)), length * (6 * t * (1 - t))};
  }
  if (interval.sqrt_at_lower) return {interval.lower + length * (t * t), length * (2 * t)};
  if (interval.sqrt_at_upper) return {interval.upper - length * ((1 - t) * (1 - t)), length * (2 * (1 - t))};
  return {interval.lower + length * t, length};
}

/// Gauss-Legendre rule on [0, 1].
struct GaussRule {
  std::vector<double> node, weight;
};

/// The rule with n nodes (1 <= n <= 200), the roots of the Legendre polynomial, computed to rounding accuracy by
/// Newton's method. Bit-identical on every processor.
GaussRule gauss_legendre(int n);

/// Calls visit(point, d point / dt, weight of the rule) for each node of a subinterval.
template <class S, class Visit>
void visit_nodes(const Subinterval<S>& interval, const GaussRule& rule, const Visit& visit) {
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const auto [point, jacobian] = map_node(interval, rule.node[i]);
    visit(point, jacobian, rule.weight[i]);
  }
}
/// Calls visit(point, d point / dt, weight of the rule) for each node of several subintervals.
template <class S, class Visit>
void visit_nodes(const std::vector<Subinterval<S>>& intervals, const GaussRule& rule, const Visit& visit) {
  for (const Subinterval<S>& interval : intervals) visit_nodes(interval, rule, visit);
}

/// Sequence of nested quadrature rules on [0, 1]: each contains the nodes of the previous one, so that a higher rule
/// only evaluates its additional nodes.
struct NestedRule {
  static constexpr std::size_t kNodes = 15;
  /// One rule of the sequence, which uses the first `nodes` nodes.
  struct Level {
    std::size_t nodes;
    /// Weights of this rule, and of the embedded rule with fewer nodes, by node.
    std::array<double, kNodes> weight, fewer;
  };
  std::array<double, kNodes> node;  ///< nodes of all rules, in the order in which the rules add them
  std::vector<Level> level;
};

/// The Gauss-Kronrod rule with 15 nodes and the embedded Gauss rule with 7 nodes, exact for polynomials up to degree 23
/// and 13.
const NestedRule& kronrod_rule();

/// The Gauss-Patterson rules with 7 and 15 nodes, which extend the Gauss rule with 3 nodes. They are exact for
/// polynomials up to degree 11 and 23, the Gauss rule up to degree 5.
///
/// Source: T. N. L. Patterson, "The optimum addition of points to quadrature formulae", Mathematics of Computation 22
/// (1968), 847.
const NestedRule& patterson_rule();

/// Value of an integral with its error estimate.
template <class S>
struct Integral {
  S value{0.0};
  double error = 0;  ///< estimate of the absolute error
  long evaluations = 0;

  void operator+=(const Integral& other) {
    value += other.value;
    error += other.error;
    evaluations += other.evaluations;
  }
};

/// Regularity of the integrand between the endpoints of a subinterval: smooth, or continuous with kinks.
enum class Regularity { smooth, kinks };

/// QUADPACK's error estimate for a smooth integrand (Piessens et al. 1983),
/// spread * min(1, (200 difference / spread)^1.5).
/// @param difference  absolute difference of the results of two nested rules
/// @param spread      integral of |f - mean of f|
inline double quadpack_error(double difference, double spread) {
  const double ratio = spread > 0 ? 200 * difference / spread : 0;
  return ratio > 0 ? spread * std::fmin(1.0, ratio * std::sqrt(ratio)) : 0;
}

/// Error estimate of one rule: the difference to its embedded rule if the integrand has kinks, otherwise
/// quadpack_error().
/// @param term   integrand times Jacobian, by node
/// @param value  result of the rule: the sum of weight * term
template <class S>
double rule_error(const NestedRule::Level& level, const std::array<S, NestedRule::kNodes>& term, double value,
                  Regularity regularity = Regularity::smooth) {
  double embedded = 0, spread = 0;
  for (std::size_t i = 0; i < level.nodes; ++i) {
    embedded += level.fewer[i] * value_of(term[i]);
    spread += level.weight[i] * std::fabs(value_of(term[i]) - value);
  }
  const double difference = std::fabs(value - embedded);
  return regularity == Regularity::kinks ? difference : quadpack_error(difference, spread);
}

/// A subinterval of the adaptive subdivision, with the integrand at its nodes and its integral.
template <class S>
struct QuadratureCell {
  Subinterval<S> interval;
  std::size_t levels = 0;                  ///< number of rules of the sequence applied so far
  std::array<S, NestedRule::kNodes> term;  ///< integrand times Jacobian at the nodes
  Integral<S> integral;
};

/// Parameters of adaptive quadrature. For smooth integrands the error estimate is that of QUADPACK. For integrands with
/// kinks, where that estimate is too large by a factor of 100 or more, it is the difference to the embedded rule.
struct Quadrature {
  const NestedRule& rule = kronrod_rule();
  Regularity regularity = Regularity::smooth;
  int depth = 16;  ///< maximum number of successive bisections of a subinterval
};

/// Applies the next rule of the sequence to a subinterval.
template <class S, class F>
void apply_rule(const F& f, const Quadrature& settings, QuadratureCell<S>& cell) {
  const std::size_t known = cell.levels > 0 ? settings.rule.level[cell.levels - 1].nodes : 0;
  const NestedRule::Level& level = settings.rule.level[cell.levels++];
  Integral<S>& result = cell.integral;
  result.value = S(0.0);
  for (std::size_t i = 0; i < level.nodes; ++i) {
    if (i >= known) {
      const auto [point, jacobian] = map_node(cell.interval, settings.rule.node[i]);
      cell.term[i] = f(point) * jacobian;
    }
    result.value += cell.term[i] * level.weight[i];
  }
  result.error = rule_error(level, cell.term, value_of(result.value), settings.regularity);
  result.evaluations += static_cast<long>(level.nodes - known);
}

/// Bisects a subinterval. Each half inherits the singularity of its outer endpoint.
template <class S>
std::array<Subinterval<S>, 2> halves(const Subinterval<S>& interval) {
  const S middle = (interval.lower + interval.upper) * 0.5;
  return {Subinterval<S>{interval.lower, middle, interval.sqrt_at_lower, false},
          Subinterval<S>{middle, interval.upper, false, interval.sqrt_at_upper}};
}

/// One step of globally adaptive quadrature (QUADPACK's QAG): replaces a cell by its halves. Its lower half takes its
/// place, its upper half is appended.
/// @param cells      objects with a member `interval` of type Subinterval
/// @param integrate  integrate(cell) computes all members of a cell except `interval`, and ignores their previous
///                   values
template <class Cell, class Integrate>
void bisect_cell(std::vector<Cell>& cells, std::size_t index, const Integrate& integrate) {
  const auto [lower, upper] = halves(cells[index].interval);
  cells.push_back(cells[index]);
  cells[index].interval = lower;
  cells.back().interval = upper;
  integrate(cells[index]);
  integrate(cells.back());
}

/// Refines a subinterval until its error estimate is at most `tolerance` (absolute): first by the higher rules, then by
/// recursive bisection to at most the given depth. Whether it is refined depends on values only, never on derivatives.
template <class S, class F>
void refine(const F& f, double tolerance, const Quadrature& settings, int depth, QuadratureCell<S>& cell) {
  while (!(cell.integral.error <= tolerance) && cell.levels < settings.rule.level.size()) apply_rule(f, settings, cell);
  if (cell.integral.error <= tolerance || depth == 0) return;
  Integral<S> sum;
  sum.evaluations = cell.integral.evaluations;
  for (const Subinterval<S>& interval : halves(cell.interval)) {
    QuadratureCell<S> half{.interval = interval};
    apply_rule(f, settings, half);
    refine(f, tolerance / 2, settings, depth - 1, half);
    sum += half.integral;
  }
  cell.integral = sum;
}

/// Integral of f over one subinterval. @param tolerance  absolute error that is accepted
template <class S, class F>
Integral<S> integrate_interval(const F& f, const Subinterval<S>& interval, double tolerance,
                               const Quadrature& settings = {}) {
  QuadratureCell<S> cell{.interval = interval};
  apply_rule(f, settings, cell);
  refine(f, tolerance, settings, settings.depth, cell);
  return cell.integral;
}

/// Integral of f over several subintervals.
/// @param tolerance  error that is accepted, relative to the total integral
/// @param floor      absolute error that is always accepted: the error due to the rounding of f, which bisection cannot
///                   reduce
/// @param scratch    scratch memory
template <class S, class F>
Integral<S> integrate(const F& f, const std::vector<Subinterval<S>>& intervals, double tolerance, double floor,
                      std::vector<QuadratureCell<S>>& scratch, const Quadrature& settings = {}) {
  scratch.resize(intervals.size());
  const auto total = [&] {
    Integral<S> sum;
    for (const QuadratureCell<S>& cell : scratch) sum += cell.integral;
    return sum;
  };
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    scratch[i].interval = intervals[i];
    scratch[i].levels = 0;
    scratch[i].integral = {};
    apply_rule(f, settings, scratch[i]);
  }
  const Integral<S> sum = total();
  const double allowed = std::fmax(floor, tolerance * std::fabs(value_of(sum.value)));
  if (sum.error <= allowed) return sum;
  for (QuadratureCell<S>& cell : scratch)
    refine(f, allowed / static_cast<double>(intervals.size()), settings, settings.depth, cell);
  return total();
}

}  // namespace pkm
