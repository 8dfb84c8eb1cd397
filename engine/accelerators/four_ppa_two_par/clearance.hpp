// 4PPa-2PaR: a clearance limit of one design, reduced to as few tests as possible for analyses of the mode lower,lower.
//
// Most pairs of links have a lower bound of their distance that is independent of the pose (README.md, Clearance). If
// the bound satisfies the clearance, the pair is not tested. If the bound becomes a condition on h or beta, this
// condition is added to the limits. All other pairs are tested at each pose, first by bounding boxes. The mutual
// distances of the links suspended from C_j (all except sliders and upper bars) do not change if only z changes.
#pragma once

#include <vector>

#include "engine/accelerators/four_ppa_two_par/links.hpp"
#include "engine/accelerators/four_ppa_two_par/slice.hpp"
#include "engine/math/nonnegative_intervals.hpp"

namespace pkm::four_ppa_two_par {

/// Scratch memory of clearance tests.
struct ClearanceScratch {
  std::vector<ClosedInterval> clear;
  NonNegativeIntervals finder;
};

/// Lower bound, for all poses of the mode lower,lower, of the clearance between links of two groups [m]. Undefined for
/// the sliders of one rail.
double clearance_lower_bound(const Geometry<double>& g, const GroupPair& pair);

class ClearanceTest {
 public:
  /// @param min_clearance  clearance required between the links of every pair [m]
  ClearanceTest(const Geometry<double>& g, double min_clearance);

  /// The smallest h (half the distance of the two sliders of a rail) at which these sliders do not collide [m];
  /// infinite if they collide at every pose.
  double h_min() const { return h_min_; }
  /// The smallest sin(beta) at which the lower bars keep their clearance from the platform.
  double sin_beta_min() const { return sin_beta_min_; }
  /// Returns true if the limits h_min() and sin_beta_min() imply the clearance, so that no pair has to be tested.
  bool complete() const { return suspended_pairs_.empty() && moving_pairs_.empty(); }

  /// Actual minus required clearance at a pose [m]. A positive result is only a lower bound.
  double excess(const Placement<double>& p) const;

  /// Finds the intervals of delta, within [low, high] of a half slice, in which the suspended links are clear.
  /// @return scratch.clear, which contains the intervals
  const std::vector<ClosedInterval>& clear_deltas(const SlicedDesign<double>& d, const Slice<double>& t,
                                                  const HalfSlice<double>& h, std::size_t leaning, double low,
                                                  double high, ClearanceScratch& scratch) const;

  /// Finds the intervals of a column in which all links are clear, as heights above the column's lower end [m]. The
  /// delta of the column must be in an interval found by clear_deltas().
  /// @return scratch.clear, which contains the intervals
  const std::vector<ClosedInterval>& clear_heights(const SlicedDesign<double>& d, const Slice<double>& t,
                                                   const Column<double>& column, ClearanceScratch& scratch) const;

 private:
  double excess(const Placement<double>& p, const std::vector<GroupPair>& pairs) const;
  Placement<double> place(const SlicedDesign<double>& d, const Slice<double>& t, const Column<double>& column,
                          double rise) const;

  Geometry<double> g_;
  double min_clearance_;
  double h_min_ = 0, sin_beta_min_ = 0;
  std::vector<GroupPair> suspended_pairs_;  ///< pairs of link groups whose clearance does not depend on z
  std::vector<GroupPair> moving_pairs_;     ///< pairs of link groups whose clearance depends on z
};

/// Replaces the clearance limit of `l`: parts that are equivalent to bounds of h and beta are added to l.h_min and
/// l.sin_beta_min; the rest is returned as a test of poses, std::nullopt if nothing remains to be tested.
std::optional<ClearanceTest> reduce_clearance(const Geometry<double>& g, Limits<double>& l);

}  // namespace pkm::four_ppa_two_par
