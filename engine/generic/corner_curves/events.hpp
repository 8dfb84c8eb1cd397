// Where crossings of boundary curves begin, end or change their weights: the roots of the discriminants of pairs of
// curves, and the events, i.e. the values of tau at which a third curve passes through a crossing.
#pragma once

#include "engine/generic/corner_curves/decomposition.hpp"

namespace pkm::generic::corner_curves {

/// Curves on one side of which no point is feasible: all feasible points lie inside the curves of the set `inside` (h <
/// 0), and outside those of the set `outside` (h > 0).
struct NecessaryConstraints {
  Signs inside = 0, outside = 0;

  explicit NecessaryConstraints(const SliceFormula& formula) {
    const Signs all = formula.formula.all;
    for (std::size_t i = 0; i < formula.literals.size(); ++i) {
      const auto [out, in] = formula.literals[i];
      if ((in & ~out & all) != 0) inside |= bit(i);
      if ((out & ~in & all) != 0) outside |= bit(i);
    }
    for (const auto& strip : formula.strips)
      if (strip.is_inside && (strip.surface & all) != 0) {
        outside |= bit(strip.first);
        inside |= bit(strip.second);
      }
    for (const auto& bound : formula.bounds) (bound.outside ? outside : inside) |= bit(bound.curve);
  }
  bool has(std::size_t i) const { return ((inside | outside) & bit(i)) != 0; }
  /// Whether a point violates one of the necessary constraints.
  /// @param signs  set of the curves with h > 0 at the point
  /// @param known  set of the curves whose sign is known
  bool is_violated(Signs signs, Signs known) const {
    return ((signs & inside & known) | (~signs & outside & known)) != 0;
  }
  /// Amount by which a point at which the function of curve i has the value h violates the constraint of this curve; <=
  /// 0 if it satisfies the constraint, or there is none.
  double violation(std::size_t i, double h) const {
    if ((inside & bit(i)) != 0) return h;
    return (outside & bit(i)) != 0 ? -h : 0;
  }
};

inline constexpr double kTiny = 1e-13;  ///< in intervals of tau that are shorter, no sample is taken

/// Values of DecompositionScratch::pair_of for two curves without crossings to follow: the curves do not cross; they
/// touch for all tau; a necessary constraint is violated wherever they cross.
inline constexpr int kNone = -1, kTangent = -2, kInfeasible = -3;

/// A value of tau, with the index of the Chebyshev node that has this value; kNodes: there is none.
struct Place {
  double tau;
  std::size_t node;
};
/// A value of tau near the middle of a range: if possible a Chebyshev node, because the values of the curves are known
/// there.
Place sample_place(double low, double high);
inline CurveAt curve_at(const BoundaryCurve& curve, const Place& place) {
  return place.node < kNodes ? curve.at_node(place.node) : curve.at(place.tau);
}

/// Appends to `curves` a cut for each circle, and fills the pairs of `scratch` with their roots and events, and
/// result.paths, undecided and functions.
/// @param count  number of curves, not counting cuts
/// @return false if the slices have a degeneracy that is not supported, or an interpolation error is too large
bool find_events(std::vector<BoundaryCurve>& curves, std::size_t count, const SliceFormula& formula,
                 const NecessaryConstraints& necessary, Decomposition& result, DecompositionScratch& scratch);

}  // namespace pkm::generic::corner_curves
