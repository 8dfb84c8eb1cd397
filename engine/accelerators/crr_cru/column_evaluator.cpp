#include "engine/accelerators/crr_cru/analysis.hpp"
#include "engine/accelerators/crr_cru/columns.hpp"
#include "engine/accelerators/crr_cru/coupling.hpp"
#include "engine/workspace/with_gradients.hpp"

namespace pkm::crr_cru {
namespace {

/// Ranges of x, y, z and phi: along the swept coordinates those of the box `swept`; the range of the fixed coordinate,
/// and all ranges if there is no box, are unrestricted.
PoseBox pose_box(const FixedCoordinate& fixed, const std::optional<Box>& swept) {
  PoseBox box = kEverywhere;
  if (!swept) return box;
  for (int k = 0, axis = 0; k < 4; ++k)
    if (k != fixed.coordinate) box[static_cast<std::size_t>(k)] = (*swept)[static_cast<std::size_t>(axis++)];
  return box;
}

class ClosedFormColumns final : public WithGradients<ClosedFormColumns> {
 public:
  ClosedFormColumns(const AnalysisSettings& settings, const ColumnOptions& columns)
      : settings_(settings),
        box_(pose_box(settings_.fixed, columns.box)),
        tolerance_(columns.tolerance),
        has_fixed_rules_(columns.nodes[0] > 0) {
    // ColumnOptions::nodes is in the order of the swept coordinates, of which phi is the last.
    const std::size_t outer = slice_axes(settings_.fixed).outer_is_phi ? 1 : 0;
    const int usual = settings_.request.needs_inertia() ? kInertiaNodes : kSampleNodes;
    outer_rule_ = gauss_legendre(has_fixed_rules_ ? columns.nodes[outer] : usual);
    inner_rule_ = gauss_legendre(has_fixed_rules_ ? columns.nodes[1 - outer] : kInertiaNodes);
  }

 private:
  friend WithGradients<ClosedFormColumns>;
  static constexpr int kSampleNodes = 32;
  // Number of nodes per subinterval of each coordinate, for samples of the inertia.
  static constexpr int kInertiaNodes = 8;

  template <class S>
  void run(std::span<const S> parameters, Scratch& memory, WorkspaceResult<S>& workspace) const {
    workspace.clear(settings_.request.fields);
    ColumnScratch<S>& scratch = memory.get<ColumnScratch<S>>();
    const SlicedDesign<S> s = sliced(parameters);
    find_outer_intervals(s, sliced_constant<double>(parameters), sliced_constant<Dual<1>>(parameters), scratch);
    if (!has_fixed_rules_) {
      const auto area = [&](const S& outer) { return area_at(s, outer, scratch); };
      set_volume(integrate<S>(area, scratch.intervals, tolerance_, roundoff(s, scratch.intervals), scratch.integrals),
                 workspace);
    }
    if (settings_.request.needs_inertia()) {
      sample_inertia(s, parameters, scratch, workspace);
      if (has_fixed_rules_) {
        for (const S& weight : workspace.weight) workspace.volume += weight;
        workspace.columns = static_cast<long>(workspace.weight.size());
      }
      return;
    }
    const Geometry<S>& g = s.design.g;
    const bool per_slice = settings_.with_conditioning && s.axes.outer_is_phi;
    if (has_fixed_rules_ || per_slice)
      visit_nodes(scratch.intervals, outer_rule_, [&](const S& outer, const S& jacobian, double rule_weight) {
        const S area = has_fixed_rules_ ? area_of_columns(s, outer, inner_rule_, scratch, workspace.columns)
                                        : area_at(s, outer, scratch);
        const S weight = area * jacobian * rule_weight;
        if (has_fixed_rules_) workspace.volume += weight;
        if (per_slice) settings_.add_conditioning(g, outer, weight, workspace);
      });
    if (settings_.with_conditioning && !per_slice) settings_.add_conditioning(g, s.fixed, workspace.volume, workspace);
  }

  /// Adds samples of the inertia at the nodes of a product quadrature rule over all three swept coordinates.
  template <class S>
  void sample_inertia(const SlicedDesign<S>& s, std::span<const S> parameters, ColumnScratch<S>& scratch,
                      WorkspaceResult<S>& workspace) const {
    const Geometry<S>& g = s.design.g;
    const Masses<S> b = settings_.masses(parameters);
    std::vector<S>* const conditioning = workspace.find(kConditioning);
    YawInertia<S> inertia;
    S angle(0.0), index(0.0);
    const auto set_phi = [&](const S& phi) {
      angle = phi;
      inertia = yaw_inertia(g, b, phi);
      if (conditioning) index = settings_.conditioning_at(g, phi);
    };
    if (!s.axes.outer_is_phi) set_phi(s.fixed);
    visit_nodes(scratch.intervals, outer_rule_, [&](const S& outer, const S& jacobian, double rule_weight) {
      const S outer_weight = jacobian * rule_weight;
      if (s.axes.outer_is_phi) set_phi(outer);
      visit_positions(s, outer, inner_rule_, scratch, [&](const Vector3<S>& at, const S& weight) {
        const S measure = outer_weight * weight;
        if (!(value_of(measure) > 0)) return;
        workspace.weight.push_back(measure);
        if (settings_.request.poses) workspace.pose.push_back({at[0], at[1], at[2], angle});
        if (conditioning) conditioning->push_back(index);
        add_inertia(joint_inertia(g, b, inertia, at, settings_.mode), workspace);
      });
    });
  }

  template <class S>
  SlicedDesign<S> sliced(std::span<const S> parameters) const {
    return sliced_design(design(geometry(settings_.platform, parameters), settings_.limits, box_), settings_.fixed);
  }
  /// Converts the parameters of a design to another scalar type, with zero derivatives. @return the design
  template <class To, class From>
  SlicedDesign<To> sliced_constant(std::span<const From> parameters) const {
    return sliced(std::span<const To>(constants<To, kParameters>(parameters)));
  }

  AnalysisSettings settings_;
  PoseBox box_;
  double tolerance_;
  bool has_fixed_rules_;  ///< true: the plan gives the numbers of quadrature nodes; false: it gives a tolerance
  GaussRule outer_rule_, inner_rule_;
};

}  // namespace

std::unique_ptr<const WorkspaceEvaluator> make_evaluator(const AnalysisSettings& settings,
                                                         const ColumnOptions& columns) {
  return std::make_unique<ClosedFormColumns>(settings, columns);
}

}  // namespace pkm::crr_cru
