// Limits: constraints f(t, v) >= 0 that depend on the outer coordinate t and on v, but not on z. Whatever function f
// is, its boundary in a slice consists of lines v = v_k(t).
//
// On a segment of t the range of v is bisected until interval arithmetic proves for each subinterval that f has one
// sign, or that f or df/dv is monotone along v (interval branch and prune). Neighbouring monotone subintervals contain
// at most one root for each t, convex and concave ones two. Two roots merge at a fold, where the extremum of f along v
// vanishes. This extremum is a function of t, whose roots divide the segment.
#pragma once

#include <vector>

#include "engine/generic/corner_curves/boundary_curve.hpp"
#include "engine/generic/corner_curves/root_isolation.hpp"
#include "engine/generic/slice_plan.hpp"
#include "engine/math/interval.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic::corner_curves {

/// A root of a limit as a function v(t) on a segment of t, by its values at the Chebyshev nodes.
struct LimitRoot {
  std::size_t limit;
  bool rises;  ///< true: the limit is violated below the root and satisfied above it
  Samples v;
};

/// A point (t, v) at which two roots of a limit merge; `limit` is the index of the limit.
struct LimitFold {
  std::size_t limit;
  double t, v;
};

/// Result and scratch memory of find_limit_roots().
struct LimitScratch {
  std::vector<double> registers, adjoints;
  /// Indices of the limits that are not certified to be satisfied in the whole box for this design.
  std::vector<std::size_t> active;
  /// Roots on the segment of t that was examined last; those of one limit are in ascending order of v.
  std::vector<LimitRoot> roots;
  std::vector<LimitFold> folds;

  std::vector<Interval> inputs, intervals;
  /// A subinterval of v with the signs in it of the limit f, of its derivative df/dv (slope) and of its second
  /// derivative (curvature); 0: the sign is not constant or unknown.
  struct Cell {
    double lower, upper;
    int sign, slope, curvature;
    bool is_undefined;
  };
  std::vector<Cell> cells;
  /// An interval of v in which a limit has a single root, or an extremum with at most one root on each side of it.
  struct Search {
    std::size_t limit;
    double lower, upper;
    int sign_at_lower;
    /// Sign of the limit's second derivative along v at the extremum; 0: the interval has a single root.
    int curvature;
    double scale;  ///< if there is an extremum: magnitude of the limit at the ends of the interval
    Samples extremum, value_there;
    std::array<Samples, 2> root;
    bool has_extremum;
  };
  std::vector<Search> searches;
  /// For each active limit, its first known sign in the range of v; 0: it is undefined in the whole range.
  std::vector<int> signs;
  std::vector<Root> isolated;
};

/// Evaluates the stage of SlicePlan::limits that depends on the design, and finds the limits that are not certified to
/// be satisfied in the whole box (active).
/// @param box  ranges of t and v
void start_limits(const SlicePlan& plan, std::span<const double> inputs, const std::array<Interval, 2>& box,
                  LimitScratch& scratch);

/// Evaluates the stage of SlicePlan::limits that depends on the outer coordinate, at the value t of this coordinate.
void evaluate_limits_at_t(const SlicePlan& plan, double t, LimitScratch& scratch);
/// Evaluates the stage of SlicePlan::limits that depends on v; to be called after evaluate_limits_at_t().
void evaluate_limits_at_v(const SlicePlan& plan, double v, LimitScratch& scratch);

/// Result of find_limit_roots(): the roots are found; a limit is violated in the whole segment; the segment has to be
/// divided at folds; or shorter segments are needed.
enum class LimitState { resolved, violated, divided, unresolved };

/// Finds the roots along v of the active limits on a segment of the outer coordinate.
/// @param outer  the segment
/// @param v      lower and upper bound of v at the Chebyshev nodes
/// @return violated: a limit is violated in the whole segment; divided: the segment has to be divided at the folds;
///         unresolved: shorter segments are needed
LimitState find_limit_roots(const SlicePlan& plan, const Subinterval<double>& outer, const std::array<Samples, 2>& v,
                            LimitScratch& scratch);

}  // namespace pkm::generic::corner_curves
