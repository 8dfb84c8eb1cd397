// 4PPa-2PaR: a clearance limit on one design, taken apart for surveys of the lower mode.
//
// Of the pairs of links, most need no look at a pose:
//
// - The sliders of one rail are 2 (h - d_0 - d_u/2) apart, so their clearance is a bound of h: h_min.
// - The lower connectors are upright and a apart at every pose; all other lower links of different limbs are farther
//   apart, because limb 1's lie in y = y_1 on one side of D_1 and limb 2's in y = y_2 on the other side of D_2.
// - Lower bars lead up and away from D_j and E_j. They are nearest to the platform in E_j, d - d_d above it, at every
//   pose; where E_j is below the platform they pass P_j at (d_d - d) sin(beta_j): a bound of beta, beta_min.
// - Upper bars, connector sides and sliders of limb 1 lie in x = 0 at or above C_1, limb 2's in x = b at or above C_2.
//   So those of different limbs are b apart, and the platform, which lies x_1 or more from x = 0 and sigma_1 + d below
//   C_1, is sqrt(x_1^2 + (sigma_1 + d)^2) >= sqrt(l_d^2 + d^2) away from them.
// - They and lower links of the other limb: seen along y, a point of limb 2's is l_d (sin beta_1 + t sin beta_2) or
//   more from x = 0 and l_d (cos beta_1 - t cos beta_2) below C_1 (if that is positive), 0 <= t <= 1, or is straight
//   below such a point. So the distance is l_d |sin(beta_1 + beta_2)| or more, and l_d or more where beta_1 + beta_2 >
//   90 deg. The loop closure gives sin beta_1 + sin beta_2 >= (b - a)/l_d =: s, hence beta_1 + beta_2 >= 2 asin(s/2),
//   and the distance is l_d s sqrt(1 - s^2/4) or more, l_d or more where s^2 >= 2.
//
// Pairs that such a bound clears are dropped. For the usual proportions none is left, and a survey under a clearance
// limit is one under h_min, with all its exactness. The others are tested pose by pose, boxes first. Among them, what
// hangs from C_j (all but sliders and upper bars) keeps its mutual distances when z alone changes.
#pragma once

#include <vector>

#include "engine/math/intervals.hpp"
#include "engine/mechanisms/four_ppa_two_par/links.hpp"
#include "engine/mechanisms/four_ppa_two_par/section.hpp"

namespace pkm::four_ppa_two_par {

/// Storage that tests reuse.
struct ClearanceScratch {
  std::vector<Interval> clear;
  NonNegativeParts finder;
};

/// No pose of the lower mode brings links of the two groups nearer than this [m]. Not for the sliders of one rail.
double least_clearance(const Geometry<double>& g, const GroupPair& pair);

class ClearanceTest {
 public:
  /// @param least  clearance that every pair keeps [m]
  ClearanceTest(const Geometry<double>& g, double least);

  /// What keeps the sliders of each rail clear [m]; infinite where no pose at all is clear.
  double h_min() const { return h_min_; }
  /// What keeps lower bars and platform clear.
  double sin_beta_min() const { return sin_beta_min_; }
  /// Whether these two say all: no pair is left that some poses bring too near.
  bool complete() const { return hanging_.empty() && moving_.empty(); }

  /// >= 0 where all pairs that are left are clear. Where negative: the least clearance minus the limit [m]; where
  /// positive: no more than that.
  double excess(const Placement<double>& p) const;

  /// Where in [low, high] what hangs is clear, along the delta of a half section.
  /// @return  in scratch.clear
  const std::vector<Interval>& clear_ranges(const Frame<double>& f, const Section<double>& t, const Half<double>& h,
                                            std::size_t leaning, double low, double high,
                                            ClearanceScratch& scratch) const;

  /// The parts of one column inside such a range on which links are clear, as heights over its lower end [m].
  /// @return  in scratch.clear
  const std::vector<Interval>& clear_parts(const Frame<double>& f, const Section<double>& t,
                                           const Column<double>& column, ClearanceScratch& scratch) const;

 private:
  double excess(const Placement<double>& p, const std::vector<GroupPair>& pairs) const;
  Placement<double> place(const Frame<double>& f, const Section<double>& t, const Column<double>& column,
                          double rise) const;

  Geometry<double> g_;
  double least_;
  double h_min_ = 0, sin_beta_min_ = 0;
  std::vector<GroupPair> hanging_;  ///< pairs whose distance does not depend on z
  std::vector<GroupPair> moving_;   ///< the others
};

/// Takes the clearance limit out of `l`: what is one of h or beta goes into l.h_min and l.sin_beta_min, the rest into a
/// test. None: nothing is left to test.
std::optional<ClearanceTest> take_clearance(const Geometry<double>& g, Limits<double>& l);

/// The links' places in the lower mode, from the centre of a voxel.
Placement<double> lower_placement(const Geometry<double>& g, double x, double z, double sin_theta, double cos_theta);

}  // namespace pkm::four_ppa_two_par
