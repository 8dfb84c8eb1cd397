// Corner curves: the crossings of two boundary curves as functions of tau, and the ranges of tau in which they are
// vertices of the feasible part of the slice.
//
// With the signs F(+-, +-) of feasibility around a crossing p of curves i and j, Green's theorem gives the area as
//
//   A = sum over crossings of kappa (W_i(p) - W_j(p)),   kappa = sgn det(grad h_i, grad h_j) (F(++) - F(+-) - F(-+) +
//   F(--))
//
// where W is the integral of (x dy - y dx)/2 along a curve; and for every circle whose point at angle 0 bounds the
// feasible part, the area of the whole circle (README.md). The weight kappa changes only where the discriminant of the
// pair vanishes, or the concurrence function of the pair and a third curve. The roots of these functions are isolated
// once for each pair and each triple, so that all three pairs of a triple see the same critical value. Between
// consecutive roots one sample decides.
#pragma once

#include "engine/generic/corner_curves/boundary_curve.hpp"
#include "engine/generic/corner_curves/root_isolation.hpp"
#include "engine/generic/corner_curves/slice_formula.hpp"

namespace pkm::generic::corner_curves {

/// A maximal range of tau in which a crossing is a vertex of constant weight.
struct ActiveRange {
  std::uint8_t first, second;  ///< indices of the two curves that cross; the second one may be a cut
  /// Branch of the crossing (1 or -1), and its weight kappa; for the point of a circle on its cut the weight is 1 or
  /// -1, positive if the disc is feasible.
  std::int8_t branch, weight;
  double low, high;                ///< limits of the range of tau
  bool root_at_low, root_at_high;  ///< true: the discriminant vanishes at this end
};

struct Decomposition {
  std::vector<ActiveRange> ranges;
  double undecided = 0;  ///< total length in tau of intervals in which roots are undecided
  /// Total length in tau on which decisions contradict each other; 0 unless one of them is wrong.
  double unbalanced = 0;
  long functions = 0;  ///< number of discriminants and concurrence functions that were examined
};

/// Scratch memory of decompose().
struct DecompositionScratch {
  /// A root of the concurrence function of a pair and a third curve.
  struct Event {
    double at, width;      ///< value of tau and width of the undecided interval around it, see Root
    std::uint8_t third;    ///< index of the curve whose sign at the crossing may change
    std::int8_t branches;  ///< branch of the crossing that it concerns, 1 or -1; 0: both
  };
  /// A third curve that passes through a crossing for all tau, and the side of it on which the perturbed crossing lies.
  struct Constant {
    std::uint8_t third;
    std::int8_t branch;  ///< branch of the crossing, 1 or -1; 0: both branches
    bool outside;
  };
  /// Two curves that cross for some tau.
  struct Pair {
    std::uint8_t first, second;
    bool has_branches;
    Sampled discriminant;
    std::vector<Root> ends;  ///< roots of the discriminant, between which the curves cross for all tau or for none
    std::vector<Event> events;
    std::vector<Constant> constants;
  };
  /// A value of tau at which two parallel curves coincide.
  struct Meeting {
    double at, width;
    std::uint8_t first, second;
  };
  std::vector<Pair> pairs;
  std::size_t pair_count = 0;
  /// Index in `pairs` of the pair of curves i and j, by i * (number of curves) + j; negative: their crossings are not
  /// followed.
  std::vector<int> pair_of;
  std::vector<Meeting> meetings;
  std::vector<Root> roots;
  std::vector<double> places;
  /// Change, at one value of tau, of the number of vertices on a curve, counted with their signs.
  struct Step {
    double at;
    std::uint8_t curve;
    int change;
  };
  std::vector<Step> balance;
};

/// Finds the ranges in which the crossings are vertices.
/// @param curves  at most kMaxCurves, without cuts; one cut for each circle is appended
/// @return false if the slices have a degeneracy that is not supported, or the functions are not resolved
bool decompose(std::vector<BoundaryCurve>& curves, const SliceFormula& formula, Decomposition& result,
               DecompositionScratch& scratch);

}  // namespace pkm::generic::corner_curves
