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
// consecutive roots one sample decides. If a general conic is among the three curves, there is no such function:
// instead, the roots of h of the third curve along each crossing of the other two are isolated.
#pragma once

#include "engine/generic/corner_curves/boundary_curve.hpp"
#include "engine/generic/corner_curves/crossing_path.hpp"
#include "engine/generic/corner_curves/root_isolation.hpp"
#include "engine/generic/corner_curves/slice_formula.hpp"

namespace pkm::generic::corner_curves {

/// A maximal range of tau (the variable in [-1, 1] that stands for the outer coordinate) in which a crossing of two
/// boundary curves is a vertex of the slice and has a constant weight.
struct ActiveRange {
  /// Indices of the two curves that cross; the second one may be the cut of the first, a circle.
  std::uint8_t first, second;
  /// Which of the two crossings (1 or -1), and its weight kappa. If the second curve is a cut, the weight is 1 if the
  /// disc is feasible near this point of the circle, and -1 if the outside is.
  std::int8_t branch, weight;
  int path;                        ///< index in Decomposition::paths, if one of the two curves is a conic; otherwise -1
  double low, high;                ///< limits of the range of tau
  bool root_at_low, root_at_high;  ///< true: the discriminant vanishes at `low` or `high`
};

struct Decomposition {
  std::vector<ActiveRange> ranges;
  std::vector<CrossingPath> paths;  ///< crossings of conics with other curves
  double undecided = 0;             ///< total length in tau of intervals in which roots are undecided
  /// Total length in tau on which the decisions about which crossings are vertices contradict each other; 0 unless one
  /// of these decisions is wrong.
  double unbalanced = 0;
  long functions = 0;  ///< number of discriminants and concurrence functions that were computed
};

/// Scratch memory of decompose().
struct DecompositionScratch {
  /// A value of tau at which a third curve passes through a crossing of a pair of curves: a root of a concurrence
  /// function.
  struct Event {
    double at, width;    ///< value of tau, and width of the undecided interval around it; 0: a simple root
    std::uint8_t third;  ///< index of the curve whose sign at the crossing may change
    /// For a pair of circles or lines: the branch (1 or -1) of the crossing through which the third curve passes; 0:
    /// both branches. For a pair with a conic: number of the crossing's path, from 1.
    std::int8_t branches;
  };
  /// A third curve that passes through a crossing of a pair of curves for all tau. After the perturbation
  /// (coincidence.hpp), the crossing lies on one side of this curve (`outside`: h > 0) for all tau.
  struct Constant {
    std::uint8_t third;
    std::int8_t branch;  ///< which of the pair's two crossings, 1 or -1; 0: both
    bool outside;
  };
  /// Two curves, given by their indices, that cross each other for at least some tau, and the values of tau at which
  /// their crossings begin, end or change their weights.
  struct Pair {
    std::uint8_t first, second;
    bool has_branches;
    bool has_conic;
    /// For a pair with a conic: index in Decomposition::paths of its first crossing, and number of its crossings.
    std::size_t first_path, path_count;
    Sampled discriminant;
    /// Roots in tau of the discriminant; between two consecutive ones the curves cross for all tau or for none.
    std::vector<Root> ends;
    std::vector<Event> events;
    std::vector<Constant> constants;
  };
  /// A value of tau at which two parallel curves coincide, and the length of the undecided interval around it.
  struct Meeting {
    double at, width;
    std::uint8_t first, second;
  };
  std::vector<Pair> pairs;
  std::size_t pair_count = 0;
  /// Index in `pairs` of the pair of curves i and j, stored at i * (number of curves) + j; negative: the curves do not
  /// cross, or their crossings are never vertices.
  std::vector<int> pair_of;
  std::vector<Meeting> meetings;
  std::vector<Root> roots;
  std::vector<double> places;
  /// Change, at a value of tau, of the sum of the signed weights of the vertices on a curve; the sum must be 0
  /// everywhere.
  struct Step {
    double at;
    std::uint8_t curve;
    int change;
  };
  std::vector<Step> balance;
};

/// Finds the ranges of tau in which the crossings of boundary curves are vertices of the feasible part of the slice.
/// @param curves  at most kMaxCurves curves without cuts; a cut is appended for each circle
/// @return false if the slices have a degeneracy that is not supported, or an interpolation error is too large
bool decompose(std::vector<BoundaryCurve>& curves, const SliceFormula& formula, Decomposition& result,
               DecompositionScratch& scratch);

}  // namespace pkm::generic::corner_curves
