// Division of the outer coordinate's range into segments in which the boundary curves are analytic and nothing that is
// independent of the inner coordinates changes its sign.
//
// A function of the outer coordinate (outer_plan.hpp) is interpolated on a segment in which it is analytic, and its
// roots divide the segment. Functions that depend on the roots of others are analytic only after that, so the division
// is repeated in the segments it leaves. At a root from which curves start like square roots the segment's variable is
// transformed (OuterRange).
#pragma once

#include <deque>

#include "engine/generic/corner_curves/integral.hpp"
#include "engine/generic/corner_curves/slice_curves.hpp"

namespace pkm::generic::corner_curves {

/// Endpoint of a segment.
struct SegmentEnd {
  enum class Kind : std::uint8_t { box, function, fold, division };  ///< division: bisected for convergence only
  double at;
  Kind kind;
  std::size_t function = 0;  ///< index of the function; of a fold: index of the limit
  bool has_root = false;     ///< curves behave like square roots
  double v = 0;              ///< v of a fold
};

struct Segment {
  SegmentEnd lower, upper;
  SliceCurves slices;
  SegmentIntegral integral;

  double volume() const { return slices.frame.scale * slices.frame.scale * integral.area.value; }
};

/// Scratch memory of divide().
struct SegmentScratch {
  /// An interval of the recursive division.
  struct Level {
    std::vector<SegmentEnd> ends;  ///< roots in the interval, then its upper endpoint
    std::vector<char> known;       ///< by function: it has no root in the interval
  };
  std::vector<double> registers;
  NodeValues nodes;
  std::vector<Sampled> functions;
  std::vector<Root> roots;
  std::deque<Level> levels;       ///< by recursion depth
  std::vector<Segment> segments;  ///< the first `count` of them hold the last design
  std::size_t count = 0;
  DecompositionScratch decomposition;
  LimitScratch limits;
  long runs = 0;  ///< number of evaluations of the stage of the outer coordinate
};

/// Runs the stage of the outer coordinate.
void run_outer_stage(const SlicePlan& plan, double t, std::span<double> registers);

/// Divides the range for a design, and decomposes the segments that are not empty.
/// @param scratch  contains the registers after the design's stage
/// @return false if corner curves do not support the design
bool divide(const SlicePlan& plan, const OuterPlan& outer, SegmentScratch& scratch);

}  // namespace pkm::generic::corner_curves
