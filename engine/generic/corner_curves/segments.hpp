// Division of the outer coordinate's range into segments in which the boundary curves are analytic and nothing that is
// independent of the inner coordinates changes its sign.
//
// A function of the outer coordinate (outer_plan.hpp) is interpolated on a segment in which it is analytic, and its
// roots divide the segment. Functions that depend on the roots of others are analytic only after that, so the resulting
// segments are divided again. At a root from which curves start like square roots the segment's variable is transformed
// (OuterRange).
#pragma once

#include <deque>

#include "engine/generic/corner_curves/integral.hpp"
#include "engine/generic/corner_curves/slice_curves.hpp"

namespace pkm::generic::corner_curves {

/// Endpoint of a segment of the outer coordinate t: its value `at`, and the reason (kind) why the segment ends there.
struct SegmentEnd {
  /// box: bound of the search box; function: root of an OuterFunction; fold: two roots of a limit merge there;
  /// division: only for the convergence of interpolation.
  enum class Kind : std::uint8_t { box, function, fold, division };
  double at;
  Kind kind;
  std::size_t function = 0;  ///< Kind::function: index in OuterPlan::functions; Kind::fold: index of the limit
  bool has_root = false;     ///< true: boundary curves behave like square roots of the distance from this endpoint
  double v = 0;              ///< Kind::fold only: value of v at which two roots of the limit merge
};

struct Segment {
  SegmentEnd lower, upper;
  SliceCurves slices;
  SegmentIntegral integral;

  double volume() const { return slices.frame.scale * slices.frame.scale * integral.area.value; }
};

/// Scratch memory of divide(), with its result: `segments`, `count`.
struct SegmentScratch {
  /// An interval that the recursive division examines.
  struct Level {
    /// Roots of the functions in the interval, followed by the upper endpoint of the interval.
    std::vector<SegmentEnd> ends;
    /// One element for each function; nonzero: the function is known to have no root in the interval.
    std::vector<char> known;
  };
  std::vector<double> registers;
  expression::Rows rows;  ///< rows of OuterPlan::stage, with one value per Chebyshev node
  NodeValues nodes;
  std::vector<Sampled> functions;
  std::vector<Root> roots;
  std::deque<Level> levels;       ///< intervals that the recursive division examines, by recursion depth
  std::vector<Segment> segments;  ///< the first `count` elements are the segments of the design that was divided last
  std::size_t count = 0;
  DecompositionScratch decomposition;
  LimitScratch limits;
  long runs = 0;  ///< number of evaluations of the stage of the outer coordinate

  std::span<Segment> filled() { return std::span(segments).first(count); }
};

/// Evaluates that stage of the program which depends on the outer coordinate, at the value t of this coordinate.
void run_outer_stage(const SlicePlan& plan, double t, std::span<double> registers);
/// The same for t at Chebyshev nodes of a range (8, 16, 24 or kNodes): computes the rows of OuterPlan::stage.
void run_outer_stage(const OuterPlan& outer, const OuterRange& range, std::size_t nodes,
                     std::span<const double> registers, expression::Rows& rows);

/// Divides the range of the outer coordinate into segments for a design, and decomposes the slices of those segments
/// that have feasible points.
/// @param scratch  scratch memory whose registers have the values after the stage of the design
/// @return false if corner curves cannot integrate this design
bool divide(const SlicePlan& plan, const OuterPlan& outer, SegmentScratch& scratch);

}  // namespace pkm::generic::corner_curves
