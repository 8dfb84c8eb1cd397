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

/// A root v(t) of a limit on a segment.
struct LimitRoot {
  std::size_t limit;
  bool rises;  ///< true: the limit is violated below the root and satisfied above it
  Samples v;
};

/// A point (t, v) at which two roots of a limit merge.
struct LimitFold {
  std::size_t limit;
  double t, v;
};

/// Result and scratch memory of find_limit_roots().
struct LimitScratch {
  std::vector<double> registers, adjoints;
  std::vector<std::size_t> active;  ///< limits that are not certified to be satisfied in the whole box at this design
  /// Roots on the segment that was examined last, in ascending order of v for each limit.
  std::vector<LimitRoot> roots;
  std::vector<LimitFold> folds;

  std::vector<Interval> inputs, intervals;
  /// A subinterval of v with the signs there of f, of df/dv (slope) and of its second derivative (curvature); 0:
  /// unknown.
  struct Cell {
    double lower, upper;
    int sign, slope, curvature;
    bool is_undefined;
  };
  std::vector<Cell> cells;
  /// An interval of v with one root, or with an extremum between at most two roots.
  struct Search {
    std::size_t limit;
    double lower, upper;
    int sign_at_lower;
    int curvature;  ///< sign of the second derivative at the extremum; 0: the interval has one root
    double scale;   ///< magnitude of the limit at the ends of the interval, if it contains an extremum
    Samples extremum, value_there;
    std::array<Samples, 2> root;
    bool has_extremum;
  };
  std::vector<Search> searches;
  /// For each active limit, its sign at one point in the range of v; 0: the limit is undefined in the whole range.
  std::vector<int> signs;
  std::vector<Root> isolated;
};

/// Evaluates the stage of the design, and finds the limits that are not certified to be satisfied in the whole box.
/// @param box  ranges of t and v
void start_limits(const SlicePlan& plan, std::span<const double> inputs, const std::array<Interval, 2>& box,
                  LimitScratch& scratch);

/// Evaluates the stage of SlicePlan::limits that depends on the outer coordinate, at t.
void evaluate_limits_at_t(const SlicePlan& plan, double t, LimitScratch& scratch);
/// Evaluates the stage of SlicePlan::limits that depends on v, after evaluate_limits_at_t().
void evaluate_limits_at_v(const SlicePlan& plan, double v, LimitScratch& scratch);

/// Result of find_limit_roots().
enum class LimitState { resolved, violated, divided, unresolved };

/// Finds the roots of the active limits on a segment.
/// @param v  lower and upper bound of v at the Chebyshev nodes
/// @return violated: a limit is violated everywhere; divided: there are folds inside the segment; unresolved: shorter
///         segments are needed
LimitState find_limit_roots(const SlicePlan& plan, const Subinterval<double>& outer, const std::array<Samples, 2>& v,
                            LimitScratch& scratch);

}  // namespace pkm::generic::corner_curves
