// Volume of a workspace by columns. It is computed by integrals along the edges of a solid or along corner curves, if
// one of these methods supports the constraints and the design, and otherwise by nested quadrature over slices. If
// there are more than three coordinates, an outer quadrature integrates over the additional ones.
#pragma once

#include <mutex>

#include "engine/generic/columns/nested_integral.hpp"
#include "engine/generic/corner_curves/volume.hpp"
#include "engine/generic/edge_plan.hpp"
#include "engine/generic/outer_quadrature.hpp"

namespace pkm::generic {

/// Reason why the default analysis of a mechanism has no columns; empty if it has columns.
std::string why_no_columns(const Evaluation& evaluation);

/// Volume of the workspace of a design. The object is immutable, except that the plan of slices is chosen at its first
/// use; threads can share it.
class ColumnVolume {
 public:
  /// Scratch memory of one thread.
  struct Scratch {
    IntegralScratch integral;
    corner_curves::Volume::Scratch corner_curves;
    edges::EdgePlan::Scratch edges;
    corner_curves::Volume::Scratch ranges;
    std::vector<double> critical_values;
    bool is_sampled = false;  ///< true: the last volume was computed from slices, which can miss a connected component
  };

  /// Throws std::invalid_argument with a message if the workspace has no exact columns.
  /// @param evaluation     must outlive this object
  /// @param needs_samples  true: the caller will visit the nodes of slices() after measure(), with outermost
  ///                       coordinates after place_nodes()
  ColumnVolume(const Evaluation& evaluation, const WorkspacePlan& plan, const ColumnOptions& columns, std::size_t mode,
               bool needs_samples);

  /// The volume over all swept and integrated coordinates.
  /// @param inputs    values of the graph's inputs; those of the outermost coordinates are overwritten
  /// @param by_input  derivatives by input, to which those of the volume are added; empty: not requested
  Integral<double> measure(std::vector<double>& inputs, std::span<double> by_input, Scratch& scratch) const;

  /// Proven bounds of the volume, including rounding errors; std::nullopt if there are none, because the workspace is
  /// no solid of planes, spheres and cylinders over three coordinates.
  std::optional<Interval> prove(std::span<const double> inputs, Scratch& scratch) const;

  /// The quadrature over slices. Its plan is chosen when this function is first called, because the choice can take
  /// longer than many evaluations of a volume from edges.
  const NestedIntegral& slices() const;
  /// Places the quadrature nodes that slices().for_each_node() visits. @param for_gradient  true: the nodes will have
  /// derivatives
  void place_nodes(std::span<const double> inputs, bool for_gradient, Scratch& scratch) const;
  /// The quadrature over the outermost coordinates, if the volume has more than three coordinates.
  const OuterQuadrature& outermost() const { return outermost_; }
  bool has_outermost() const { return !outermost_.coordinates().empty(); }

 private:
  SlicePlan choose_slices() const;
  void choose_corner_curves(double tolerance);
  std::vector<double> inputs_of_default_design() const;
  Integral<double> measure_inside(std::span<const double> inputs, std::span<double> by_input, Scratch& scratch) const;
  bool place_between_ranges(std::span<const double> inputs, bool is_measured, Scratch& scratch) const;

  const Evaluation& e_;
  WorkspacePlan plan_;
  std::size_t mode_;
  bool needs_samples_;
  OuterQuadrature outermost_;
  std::vector<SlicePlan> plans_;
  double slice_tolerance_ = 0;
  mutable std::once_flag is_chosen_;
  mutable std::optional<NestedIntegral> slices_;
  /// Plan for computing the volume from edges; absent if the workspace is not a solid with edges.
  std::optional<edges::EdgePlan> edges_;
  /// Computes the volume by corner curves; absent if corner curves cannot integrate the slices in any order of the
  /// coordinates.
  std::optional<corner_curves::Volume> corner_curves_;
  /// Corner curves of the plan of slices(). The critical values that they find divide the range of the outer coordinate
  /// before the quadrature nodes that become samples are placed. Absent if no samples are needed, if corner curves
  /// cannot integrate this plan, or if the plan is that of corner_curves_.
  std::optional<corner_curves::Volume> ranges_for_nodes_;
  bool shares_ranges_ = false;  ///< true: the plan of slices() is that of corner_curves_
};

}  // namespace pkm::generic
