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

/// Gauss-Kronrod rule with 15 nodes on [0, 1] and the weights of the 7-point Gauss rule inside it.
struct KronrodRule {
  static constexpr int kNodes = 15;
  std::array<double, kNodes> node, weight, gauss_weight;  ///< gauss_weight is 0 at the added nodes
};
const KronrodRule& kronrod_15();

/// An integral and how well it is known.
template <class S>
struct Integral {
  S value{0.0};
  double error = 0;  ///< estimate, absolute
  long evaluations = 0;
};

/// What is known of an integrand between the ends of its pieces.
enum class Between { smooth, kinks };

/// QUADPACK's estimate of the error of a smooth integrand: the difference of two rules, sharpened where it is small.
/// @param spread  integral of the distance to the mean
inline double sharpened_error(double difference, double spread) {
  const double ratio = spread > 0 ? 200 * difference / spread : 0;
  return ratio > 0 ? spread * std::fmin(1.0, ratio * std::sqrt(ratio)) : 0;
}

/// One application of the 15-point rule to a piece. The error estimate of a smooth integrand is that of QUADPACK: the
/// difference to the 7-point rule, sharpened where it is small. That errs by a factor of 100 and more on the safe side
/// where there are kinks; then it is the difference itself.
template <class S, class F>
Integral<S> integrate_piece(const F& f, const Piece<S>& piece, Between between = Between::smooth) {
  const KronrodRule& rule = kronrod_15();
  Integral<S> result;
  std::array<double, KronrodRule::kNodes> values;
  double gauss = 0;
  for (std::size_t i = 0; i < KronrodRule::kNodes; ++i) {
    const auto [point, jacobian] = map_node(piece, rule.node[i]);
    const S term = f(point) * jacobian;
    values[i] = value_of(term);
    result.value += term * rule.weight[i];
    gauss += values[i] * rule.gauss_weight[i];
  }
  const double mean = value_of(result.value);
  double spread = 0;
  for (std::size_t i = 0; i < KronrodRule::kNodes; ++i) spread += rule.weight[i] * std::fabs(values[i] - mean);
  const double difference = std::fabs(mean - gauss);
  result.error = between == Between::kinks ? difference : sharpened_error(difference, spread);
  result.evaluations = KronrodRule::kNodes;
  return result;
}

/// The two halves of a piece. Each keeps the kind of the end that it inherits.
template <class S>
std::array<Piece<S>, 2> halves(const Piece<S>& piece) {
  const S middle = (piece.lower + piece.upper) * 0.5;
  return {Piece<S>{piece.lower, middle, piece.root_lower, false},
          Piece<S>{middle, piece.upper, false, piece.root_upper}};
}

/// Replaces `known`, the rule's result on `piece`, by that of its halves, again and again until the error estimate is
/// at most `tolerance` (absolute) or `depth` halvings are used up; what remains is in `error`. Every decision depends
/// on values only, never on derivatives.
template <class S, class F>
void refine(const F& f, const Piece<S>& piece, double tolerance, int depth, Integral<S>& known,
            Between between = Between::smooth) {
  if (known.error <= tolerance || depth == 0) return;
  Integral<S> sum;
  sum.evaluations = known.evaluations;
  for (const Piece<S>& half : halves(piece)) {
    Integral<S> part = integrate_piece<S>(f, half, between);
    refine(f, half, tolerance / 2, depth - 1, part, between);
    sum.value += part.value;
    sum.error += part.error;
    sum.evaluations += part.evaluations;
  }
  known = sum;
}

/// Integral of f over pieces, to a relative tolerance of the whole.
/// @param floor    absolute error that need not be improved: where rounding of f hides what is left of the error,
///                 halving would go on to the end in vain
/// @param scratch  reused storage
template <class S, class F>
Integral<S> integrate(const F& f, const std::vector<Piece<S>>& pieces, double tolerance, double floor,
                      std::vector<Integral<S>>& scratch, Between between = Between::smooth) {
  constexpr int kDepth = 16;
  scratch.clear();
  Integral<S> sum;
  for (const auto& piece : pieces) {
    scratch.push_back(integrate_piece<S>(f, piece, between));
    sum.value += scratch.back().value;
    sum.error += scratch.back().error;
    sum.evaluations += scratch.back().evaluations;
  }
  const double allowed = std::fmax(floor, tolerance * std::fabs(value_of(sum.value)));
  if (sum.error <= allowed) return sum;
  const double share = allowed / static_cast<double>(pieces.size());
  sum = {};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    refine(f, pieces[i], share, kDepth, scratch[i], between);
    sum.value += scratch[i].value;
    sum.error += scratch[i].error;
    sum.evaluations += scratch[i].evaluations;
  }
  return sum;
}

}  // namespace pkm
