// Quadrature over pieces on which an integrand is smooth but for root-like ends.
//
// A piece [lower, upper] is mapped to [0, 1] so that an end where the integrand behaves like a square root becomes
// smooth: t^2 at such an end, 3 t^2 - 2 t^3 when both ends are of that kind. The ends may be derivative scalars: nodes
// then move with the ends and the rule's derivative is the derivative of the integral.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "engine/math/scalar.hpp"

namespace pkm {

template <class S>
struct Piece {
  S lower, upper;
  bool root_lower = false;  ///< the integrand behaves like a square root there
  bool root_upper = false;
};

template <class S>
struct MappedNode {
  S point;
  S jacobian;  ///< d point / d t
};

/// The point of a piece at t in [0, 1].
template <class S>
MappedNode<S> map_node(const Piece<S>& piece, double t) {
  const S length = piece.upper - piece.lower;
  if (piece.root_lower && piece.root_upper) {
    return {piece.lower + length * (t * t * (3 - 2 * t)), length * (6 * t * (1 - t))};
  }
  if (piece.root_lower) return {piece.lower + length * (t * t), length * (2 * t)};
  if (piece.root_upper) return {piece.upper - length * ((1 - t) * (1 - t)), length * (2 * (1 - t))};
  return {piece.lower + length * t, length};
}

/// Gauss-Legendre rule on [0, 1].
struct GaussRule {
  std::vector<double> node, weight;
};

/// The rule with n nodes (1 <= n <= 200), computed by Newton's method on the Legendre polynomial to the last bits and
/// the same on every processor.
GaussRule gauss_legendre(int n);

/// Calls visit(point, d point / d t, weight of the rule) at the nodes of a piece.
template <class S, class Visit>
void visit_nodes(const Piece<S>& piece, const GaussRule& rule, const Visit& visit) {
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const auto [point, jacobian] = map_node(piece, rule.node[i]);
    visit(point, jacobian, rule.weight[i]);
  }
}
/// The same for several.
template <class S, class Visit>
void visit_nodes(const std::vector<Piece<S>>& pieces, const GaussRule& rule, const Visit& visit) {
  for (const Piece<S>& piece : pieces) visit_nodes(piece, rule, visit);
}

/// Rules on [0, 1], each of which holds the nodes of the one before it: where the first is enough, the others' nodes
/// are not asked for.
struct NestedRule {
  static constexpr std::size_t kNodes = 15;
  /// One of them: its first nodes, their weights, and those of the smaller rule that tells its error (0 at the others).
  struct Level {
    std::size_t nodes;
    std::array<double, kNodes> weight, fewer;
  };
  std::array<double, kNodes> node;  ///< in the order in which they are added
  std::vector<Level> level;
};

/// One rule of 15 nodes, Kronrod's, with the 7-point Gauss rule inside it; exact for polynomials up to degree 22
/// and 13.
const NestedRule& kronrod_rule();

/// Two rules of 7 and 15 nodes around the 3-point Gauss rule; exact up to degree 11, 23 and 5.
///
/// Source: T. N. L. Patterson, "The optimum addition of points to quadrature formulae", Mathematics of Computation 22
/// (1968), 847.
const NestedRule& patterson_rule();

/// An integral and how well it is known.
template <class S>
struct Integral {
  S value{0.0};
  double error = 0;  ///< estimate, absolute
  long evaluations = 0;

  void operator+=(const Integral& part) {
    value += part.value;
    error += part.error;
    evaluations += part.evaluations;
  }
};

/// What is known of an integrand between the ends of its pieces.
enum class Between { smooth, kinks };

/// QUADPACK's estimate of the error of a smooth integrand: the difference of two rules, sharpened where it is small.
/// @param spread  integral of the distance to the mean
inline double sharpened_error(double difference, double spread) {
  const double ratio = spread > 0 ? 200 * difference / spread : 0;
  return ratio > 0 ? spread * std::fmin(1.0, ratio * std::sqrt(ratio)) : 0;
}

/// A part of a piece and what is known of its integral.
template <class S>
struct QuadraturePart {
  Piece<S> piece;
  std::size_t levels = 0;  ///< rules that have been applied
  std::array<S, NestedRule::kNodes> term;
  Integral<S> integral;
};

/// How integrals are found. The error estimate of a smooth integrand is that of QUADPACK: the difference to the smaller
/// rule, sharpened where it is small. That errs by a factor of 100 and more on the safe side where there are kinks;
/// then it is the difference itself.
struct Quadrature {
  const NestedRule& rule = kronrod_rule();
  Between between = Between::smooth;
  int depth = 16;  ///< of halvings
};

/// Applies the next rule to a part.
template <class S, class F>
void apply_rule(const F& f, const Quadrature& how, QuadraturePart<S>& part) {
  const std::size_t known = part.levels > 0 ? how.rule.level[part.levels - 1].nodes : 0;
  const NestedRule::Level& level = how.rule.level[part.levels++];
  Integral<S>& result = part.integral;
  result.value = S(0.0);
  double less = 0, spread = 0;
  for (std::size_t i = 0; i < level.nodes; ++i) {
    if (i >= known) {
      const auto [point, jacobian] = map_node(part.piece, how.rule.node[i]);
      part.term[i] = f(point) * jacobian;
    }
    result.value += part.term[i] * level.weight[i];
    less += value_of(part.term[i]) * level.fewer[i];
  }
  const double mean = value_of(result.value);
  for (std::size_t i = 0; i < level.nodes; ++i) spread += level.weight[i] * std::fabs(value_of(part.term[i]) - mean);
  const double difference = std::fabs(mean - less);
  result.error = how.between == Between::kinks ? difference : sharpened_error(difference, spread);
  result.evaluations += static_cast<long>(level.nodes - known);
}

/// The two halves of a piece. Each keeps the kind of the end that it inherits.
template <class S>
std::array<Piece<S>, 2> halves(const Piece<S>& piece) {
  const S middle = (piece.lower + piece.upper) * 0.5;
  return {Piece<S>{piece.lower, middle, piece.root_lower, false},
          Piece<S>{middle, piece.upper, false, piece.root_upper}};
}

/// Improves a part until its error estimate is at most `tolerance` (absolute): by the other rules, then by halving it,
/// until `depth` halvings are used up. Every decision depends on values only, never on derivatives.
template <class S, class F>
void refine(const F& f, double tolerance, const Quadrature& how, int depth, QuadraturePart<S>& part) {
  while (!(part.integral.error <= tolerance) && part.levels < how.rule.level.size()) apply_rule(f, how, part);
  if (part.integral.error <= tolerance || depth == 0) return;
  Integral<S> sum;
  sum.evaluations = part.integral.evaluations;
  for (const Piece<S>& piece : halves(part.piece)) {
    QuadraturePart<S> half{.piece = piece};
    apply_rule(f, how, half);
    refine(f, tolerance / 2, how, depth - 1, half);
    sum += half.integral;
  }
  part.integral = sum;
}

/// Integral of f over one piece, to an absolute tolerance.
template <class S, class F>
Integral<S> integrate_piece(const F& f, const Piece<S>& piece, double tolerance, const Quadrature& how = {}) {
  QuadraturePart<S> part{.piece = piece};
  apply_rule(f, how, part);
  refine(f, tolerance, how, how.depth, part);
  return part.integral;
}

/// Integral of f over pieces, to a relative tolerance of the whole.
/// @param floor    absolute error that need not be improved: where rounding of f hides what is left of the error,
///                 halving would go on to the end in vain
/// @param scratch  reused storage
template <class S, class F>
Integral<S> integrate(const F& f, const std::vector<Piece<S>>& pieces, double tolerance, double floor,
                      std::vector<QuadraturePart<S>>& scratch, const Quadrature& how = {}) {
  scratch.resize(pieces.size());
  const auto total = [&] {
    Integral<S> sum;
    for (const QuadraturePart<S>& part : scratch) sum += part.integral;
    return sum;
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    scratch[i].piece = pieces[i];
    scratch[i].levels = 0;
    scratch[i].integral = {};
    apply_rule(f, how, scratch[i]);
  }
  const Integral<S> sum = total();
  const double allowed = std::fmax(floor, tolerance * std::fabs(value_of(sum.value)));
  if (sum.error <= allowed) return sum;
  for (QuadraturePart<S>& part : scratch) refine(f, allowed / static_cast<double>(pieces.size()), how, how.depth, part);
  return total();
}

}  // namespace pkm
