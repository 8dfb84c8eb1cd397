// 4PPa-2PaR: a clearance limit on one design, taken apart for surveys of the lower mode.
//
// Of the pairs of links, most need no look at a pose: README.md, Clearance. Those that a bound clears are dropped; the
// others are tested pose by pose, boxes first. Among them, what hangs from C_j (all but sliders and upper bars) keeps
// its mutual distances when z alone changes.
#pragma once

#include <vector>

#include "engine/accelerators/four_ppa_two_par/links.hpp"
#include "engine/accelerators/four_ppa_two_par/slice.hpp"
#include "engine/math/nonnegative_intervals.hpp"

namespace pkm::four_ppa_two_par {

/// Storage that tests reuse.
struct ClearanceScratch {
  std::vector<Part> clear;
  NonNegativeIntervals finder;
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
  const std::vector<Part>& clear_ranges(const Frame<double>& f, const Section<double>& t, const Half<double>& h,
                                        std::size_t leaning, double low, double high, ClearanceScratch& scratch) const;

  /// The parts of one column inside such a range on which links are clear, as heights over its lower end [m].
  /// @return  in scratch.clear
  const std::vector<Part>& clear_parts(const Frame<double>& f, const Section<double>& t, const Column<double>& column,
                                       ClearanceScratch& scratch) const;

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

}  // namespace pkm::four_ppa_two_par
