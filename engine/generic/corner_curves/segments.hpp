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

/// Endpoint of a segment of the outer coordinate t, with the reason why the segment ends there.
struct SegmentEnd {
  /// Bound of the search box, root of an OuterFunction, fold of a limit, or division only for the sake of convergence.
  enum class Kind : std::uint8_t { box, function, fold, division };
  double at;
  Kind kind;
  std::size_t function = 0;  ///< index in OuterPlan::functions; for a fold, the index of the limit
  bool has_root = false;     ///< true: curves behave like square roots of the distance from this endpoint
  double v = 0;              ///< value of v at a fold
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
    std::vector<SegmentEnd> ends;  ///< roots of functions in the interval, followed by its upper endpoint
    std::vector<char> known;  ///< for each function, whether it is known to have no root in the interval; by function
  };
  std::vector<double> registers;
  NodeValues nodes;
  std::vector<Sampled> functions;
  std::vector<Root> roots;
  std::deque<Level> levels;       ///< one element for each recursion depth
  std::vector<Segment> segments;  ///< the segments; the first `count` of them belong to the last design
  std::size_t count = 0;
  DecompositionScratch decomposition;
  LimitScratch limits;
  long runs = 0;  ///< number of evaluations of the stage of the outer coordinate
};

/// Evaluates the stage of the outer coordinate at the value t.
void run_outer_stage(const SlicePlan& plan, double t, std::span<double> registers);

/// Divides the range of the outer coordinate for a design, and decomposes the slices of the segments that are not
/// empty.
/// @param scratch  scratch memory whose registers have the values after the stage of the design
/// @return false if corner curves do not support the design
bool divide(const SlicePlan& plan, const OuterPlan& outer, SegmentScratch& scratch);

}  // namespace pkm::generic::corner_curves
