// Volume of a workspace by corner curves, and its gradient by adjoints.
#pragma once

#include "engine/generic/corner_curves/segments.hpp"

namespace pkm::generic::corner_curves {

/// Computes the volume of a workspace by corner curves. Immutable; the caller provides scratch memory for each thread.
class Volume {
 public:
  struct Scratch {
    SegmentScratch segments;
    std::vector<CurveAdjoints> by_curve;
    std::vector<bool> is_active;  ///< for each boundary curve of a segment, whether a vertex lies on it
    std::vector<double> adjoints, own;
    expression::Rows row_adjoints;  ///< adjoints of SegmentScratch::rows; 0 between calls

    /// Amount of work of the last measure(), in an arbitrary unit that does not depend on the computer.
    double work() const;
  };

  /// @param tolerance  relative error of the volume that is accepted
  Volume(SlicePlan plan, double tolerance) : plan_(std::move(plan)), outer_(plan_), tolerance_(tolerance) {}

  /// Reason why corner curves cannot integrate the slices of the plan; empty if they can.
  const std::string& why_not() const { return outer_.why_not; }
  const SlicePlan& plan() const { return plan_; }

  /// The volume for a design, with an estimate of its error.
  /// @param inputs  values of the graph's inputs, including the fixed coordinates
  /// @return std::nullopt if the design is not supported, because it is degenerate or interpolation does not converge
  std::optional<Integral<double>> measure(std::span<const double> inputs, Scratch& scratch) const;
  /// The first part of measure(): finds the ranges of the outer coordinate in which a crossing of two boundary curves
  /// is a vertex of the slice.
  /// @return false if the design is not supported
  bool find_ranges(std::span<const double> inputs, Scratch& scratch) const;
  /// Finds the sorted ends of those ranges of the outer coordinate in which a crossing is a vertex of the slice. They
  /// include all critical values inside the search box. To be called after measure() or find_ranges().
  void find_critical_values(Scratch& scratch, std::vector<double>& values) const;
  /// Adds the derivatives of the volume with respect to the graph's inputs, after measure().
  void add_gradient(std::span<double> by_input, Scratch& scratch) const;

 private:
  /// Whether the constraints that depend on the design only are satisfied.
  bool can_be_feasible(const SegmentScratch& scratch) const;
  void add_segment_gradient(const Segment& segment, Scratch& scratch) const;
  void add_curve_gradient(const Segment& segment, std::size_t curve, std::size_t nodes, Scratch& scratch) const;
  double add_limits_gradient(const Segment& segment, std::size_t node, double tau, Scratch& scratch) const;
  void add_limit_gradient(std::size_t limit, double v, double adjoint, Scratch& scratch) const;
  void add_end_gradient(const SegmentEnd& end, bool upper, double derivative, Scratch& scratch) const;

  SlicePlan plan_;
  OuterPlan outer_;
  double tolerance_;
};

}  // namespace pkm::generic::corner_curves
