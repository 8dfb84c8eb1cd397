// Proof that drives with limited forces, such as cables, balance all loads at every pose of a box, or that they do not
// at any pose of it: interval linear systems, in the manner of Gouttefarde, Daney, Merlet, "Interval-analysis-based
// determination of the wrench-feasible workspace of parallel cable-driven robots", IEEE Transactions on Robotics 27(1),
// 2011.
//
// The drive forces tau within lower < tau < upper balance a load f if J^T tau = f. The loads of a set are convex, and
// so are the forces that the drives exert; therefore the set is balanced if its vertices are.
//
// Balanced. Let m be the midpoint of the box X, tau_0 the analytic centre of the forces that balance f(m), and P a
// right inverse of J(m)^T. The forces tau_0 + P z balance f at x if M z = f - J^T tau_0 with M = J(x)^T P, which is
// close to the identity. With z = sum_i B_i (x_i - m_i) + y, where B_i is the midpoint of the derivative S_i of the
// right side,
//
//     M y = (f - J^T tau_0)(m) + sum_i (S_i - M B_i) (x_i - m_i)                         (mean value form)
//
// The right side R is of second order in the size of X. If R + (I - M) Y is in the interior of a box Y, then every M is
// regular and Y contains the solutions y (Krawczyk's operator), and the forces over X are enclosed by
// tau_0 + sum_i P B_i (X_i - m_i) + P Y. P is weighted by the distances of tau_0 from the limits, so that forces near a
// limit vary least.
//
// Not balanced. A vector c separates a load from all forces of the drives at m (Farkas' lemma). It does so at every
// pose of X if the mean value form of max c^T J^T tau - c^T f is negative, where the maximum is over all tau within the
// limits. Without loads, and with forces of a single sign, c^T J^T may not vanish for any drive (Gordan's theorem).
#pragma once

#include <vector>

#include "engine/workspace/bounds/constraints.hpp"

namespace pkm::bounds {

/// The balance of forces as nodes of a graph.
struct BalanceFormulas {
  std::size_t joints = 0, coordinates = 0;
  std::vector<bool> is_limited;        ///< whether the joint is driven by a cable, by joint
  std::vector<std::size_t> half_axes;  ///< number of half axes, by set of loads
  bool is_closure = false;             ///< wrench closure: one set without half axes, which is 0; no maximum tension
  /// J by rows (joints x coordinates); minimum and maximum tension of each cable; unless is_closure, for each set of
  /// loads its centre and its half axes. A set consists of the loads centre + sum of u_k half_axis_k, |u_k| <= 1.
  std::vector<expression::Node> all;
};

/// A balance of forces that is compiled to an interval program. Immutable and thread-safe.
class ForceBalance {
 public:
  /// @param axes    indices of the graph's inputs that are the axes
  /// @param inputs  all inputs of the graph; those that are no axes keep these values
  ForceBalance(expression::Graph graph, BalanceFormulas formulas, std::vector<std::size_t> axes,
               std::vector<Interval> inputs);

  enum class Result { balanced, not_balanced, undecided };
  /// Result::balanced: at every pose of the box all loads are balanced, and J has full rank. Result::not_balanced: at
  /// no pose are all loads balanced.
  Result examine(const IntervalBox& box) const;

 private:
  struct Values;
  Values values_on(const IntervalBox& box) const;

  BalanceFormulas formulas_;
  std::vector<std::size_t> axes_;
  expression::Program program_;
  std::vector<Interval> inputs_;
};

}  // namespace pkm::bounds
