// Quadrature by three rules, each of which holds the nodes of the one before it: 3, 7 and 15 nodes, exact for
// polynomials up to degree 5, 11 and 23.
//
// Where 7 nodes are enough, the other 8 are not asked for. Integrands are asked for up to 8 nodes of a piece at once.
//
// Source: T. N. L. Patterson, "The optimum addition of points to quadrature formulae", Mathematics of Computation 22
// (1968), 847.
#pragma once

#include <span>

#include "engine/math/quadrature.hpp"

namespace pkm {

/// On [0, 1]. Nodes in the order in which they are added: 7, the other 8.
struct NestedRule {
  static constexpr std::size_t kFirst = 7, kNodes = 15;
  std::array<double, kNodes> node, weight;                ///< of all
  std::array<double, kFirst> first_weight, least_weight;  ///< of the first 7, and of the 3 among them (the others: 0)
};
const NestedRule& nested_rule();

/// A part of a piece and what is known of its integral.
template <class S>
struct NestedPart {
  Piece<S> piece;
  std::size_t whole = 0;  ///< number of the piece that this is a part of
  bool all = false;       ///< all nodes are known
  std::array<S, NestedRule::kNodes> term;
  Integral<S> integral;
};

namespace nested_detail {

/// Asks for nodes [from, to).
template <class S, class F>
void evaluate(const F& f, NestedPart<S>& part, std::size_t from, std::size_t to) {
  const NestedRule& rule = nested_rule();
  std::array<S, 8> point, value, jacobian;
  for (std::size_t i = from; i < to; ++i) {
    const MappedNode<S> at = map_node(part.piece, rule.node[i]);
    point[i - from] = at.point;
    jacobian[i - from] = at.jacobian;
  }
  f(part.whole, std::span<const S>(point.data(), to - from), value.data());
  for (std::size_t i = from; i < to; ++i) part.term[i] = value[i - from] * jacobian[i - from];
  part.integral.evaluations += static_cast<long>(to - from);
}

/// The integral by a rule of n nodes; its error by the difference to a rule of fewer nodes.
template <class S>
void sum_up(const double* weight, const double* fewer, std::size_t n, NestedPart<S>& part) {
  part.integral.value = S(0.0);
  double less = 0, spread = 0;
  for (std::size_t i = 0; i < n; ++i) {
    part.integral.value += part.term[i] * weight[i];
    less += value_of(part.term[i]) * fewer[i];
  }
  const double mean = value_of(part.integral.value);
  for (std::size_t i = 0; i < n; ++i) spread += weight[i] * std::fabs(value_of(part.term[i]) - mean);
  part.integral.error = sharpened_error(std::fabs(mean - less), spread);
}

template <class S, class F>
void begin(const F& f, NestedPart<S>& part) {
  const NestedRule& rule = nested_rule();
  part.all = false;
  part.integral.evaluations = 0;
  evaluate(f, part, 0, rule.kFirst);
  sum_up(rule.first_weight.data(), rule.least_weight.data(), rule.kFirst, part);
}

/// Improves a part to an absolute tolerance: by its other nodes, then by halving it.
template <class S, class F>
void refine(const F& f, double tolerance, int depth, NestedPart<S>& part) {
  if (part.integral.error <= tolerance) return;
  const NestedRule& rule = nested_rule();
  if (!part.all) {
    evaluate(f, part, rule.kFirst, rule.kNodes);
    std::array<double, NestedRule::kNodes> fewer{};
    std::copy(rule.first_weight.begin(), rule.first_weight.end(), fewer.begin());
    sum_up(rule.weight.data(), fewer.data(), rule.kNodes, part);
    part.all = true;
  }
  if (part.integral.error <= tolerance || depth == 0) return;
  Integral<S> sum;
  sum.evaluations = part.integral.evaluations;
  for (const Piece<S>& piece : halves(part.piece)) {
    NestedPart<S> half{piece, part.whole, false, {}, {}};
    begin(f, half);
    refine(f, tolerance / 2, depth - 1, half);
    sum.value += half.integral.value;
    sum.error += half.integral.error;
    sum.evaluations += half.integral.evaluations;
  }
  part.integral = sum;
}

}  // namespace nested_detail

/// Integral over pieces, as integrate() of quadrature.hpp.
/// @param f        called as f(number of the piece, points, where to put the values)
/// @param scratch  reused storage
template <class S, class F>
Integral<S> integrate_nested(const F& f, const std::vector<Piece<S>>& pieces, double tolerance, double floor,
                             std::vector<NestedPart<S>>& scratch) {
  constexpr int kDepth = 16;
  scratch.resize(pieces.size());
  const auto total = [&] {
    Integral<S> sum;
    for (const NestedPart<S>& part : scratch) {
      sum.value += part.integral.value;
      sum.error += part.integral.error;
      sum.evaluations += part.integral.evaluations;
    }
    return sum;
  };
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    scratch[i].piece = pieces[i];
    scratch[i].whole = i;
    nested_detail::begin(f, scratch[i]);
  }
  const Integral<S> sum = total();
  const double allowed = std::fmax(floor, tolerance * std::fabs(value_of(sum.value)));
  if (sum.error <= allowed) return sum;
  for (NestedPart<S>& part : scratch)
    nested_detail::refine(f, allowed / static_cast<double>(pieces.size()), kDepth, part);
  return total();
}

}  // namespace pkm
