#include "engine/accelerators/crr_cru/columns.hpp"
#include "engine/accelerators/crr_cru/coupling.hpp"
#include "engine/accelerators/crr_cru/planned.hpp"
#include "engine/workspace/with_slopes.hpp"

namespace pkm::crr_cru {
namespace {

/// A box of the swept coordinates as ranges of x, y, z, phi.
PoseBox pose_box(const Held& held, const std::optional<Box>& swept) {
  PoseBox box = kEverywhere;
  if (!swept) return box;
  for (std::size_t k = 0, axis = 0; k < 4; ++k)
    if (k != held.coordinate) box[k] = (*swept)[axis++];
  return box;
}

class ColumnEvaluator final : public WithGradients<ColumnEvaluator> {
 public:
  ColumnEvaluator(const Planned& planned, const ColumnOptions& columns)
      : planned_(planned),
        box_(pose_box(planned_.held, columns.box)),
        tolerance_(columns.tolerance),
        fixed_(columns.nodes[0] > 0) {
    // Nodes come in the order of the swept coordinates; phi is the last of them.
    const std::size_t outer = cuts(planned_.held).outer_is_phi ? 1 : 0;
    const int usual = planned_.demand.needs_inertia() ? kInertiaNodes : kSampleNodes;
    outer_rule_ = gauss_legendre(fixed_ ? columns.nodes[outer] : usual);
    inner_rule_ = gauss_legendre(fixed_ ? columns.nodes[1 - outer] : kInertiaNodes);
  }

 private:
  friend WithGradients<ColumnEvaluator>;
  static constexpr int kSampleNodes = 32;
  static constexpr int kInertiaNodes = 8;  // per piece and coordinate

  template <class S>
  void run(std::span<const S> parameters, Scratch& room, Survey<S>& survey) const {
    survey.clear(planned_.demand.fields);
    ColumnScratch<S>& scratch = room.get<ColumnScratch<S>>();
    const auto s = sweeping(design(geometry(planned_.platform, parameters), planned_.limits, box_), planned_.held);
    find_outer_pieces(s, still<double>(parameters), still<Dual<1>>(parameters), scratch);
    if (!fixed_) {
      const auto area = [&](const S& outer) { return area_at(s, outer, scratch); };
      take_volume(integrate<S>(area, scratch.pieces, tolerance_, roundoff(s, scratch.pieces), scratch.integrals),
                  survey);
    }
    const Geometry<S>& g = s.design.g;
    if (planned_.demand.needs_inertia()) {
      sample_inertia(s, parameters, scratch, survey);
      if (fixed_) {
        for (const S& weight : survey.weight) survey.volume += weight;
        survey.columns = static_cast<long>(survey.weight.size());
      }
      return;
    }
    if (fixed_ || (planned_.with_conditioning && s.cuts.outer_is_phi))
      visit_nodes(scratch.pieces, outer_rule_, [&](const S& outer, const S& jacobian, double rule_weight) {
        const S area =
            fixed_ ? area_of_columns(s, outer, inner_rule_, scratch, survey.columns) : area_at(s, outer, scratch);
        const S weight = area * jacobian * rule_weight;
        if (fixed_) survey.volume += weight;
        if (planned_.with_conditioning && s.cuts.outer_is_phi) planned_.add_conditioning(g, outer, weight, survey);
      });
    if (planned_.with_conditioning && !s.cuts.outer_is_phi) planned_.add_conditioning(g, s.held, survey.volume, survey);
  }

  /// Samples at nodes along all three coordinates.
  template <class S>
  void sample_inertia(const Sweeping<S>& s, std::span<const S> parameters, ColumnScratch<S>& scratch,
                      Survey<S>& survey) const {
    const Geometry<S>& g = s.design.g;
    const Masses<S> b = planned_.masses(parameters);
    std::vector<S>* const conditioning = survey.find(kConditioning);
    InertiaFrame<S> frame;
    S angle(0.0), index(0.0);
    const auto set_phi = [&](const S& phi) {
      angle = phi;
      frame = inertia_frame(g, b, phi);
      if (conditioning) index = planned_.conditioning_at(g, phi);
    };
    if (!s.cuts.outer_is_phi) set_phi(s.held);
    visit_nodes(scratch.pieces, outer_rule_, [&](const S& outer, const S& jacobian, double rule_weight) {
      const S outer_weight = jacobian * rule_weight;
      if (s.cuts.outer_is_phi) set_phi(outer);
      visit_positions(s, outer, inner_rule_, scratch, [&](const Vector3<S>& at, const S& weight) {
        const S measure = outer_weight * weight;
        if (!(value_of(measure) > 0)) return;
        survey.weight.push_back(measure);
        if (planned_.demand.poses) survey.pose.push_back({at[0], at[1], at[2], angle});
        if (conditioning) conditioning->push_back(index);
        add_inertia(joint_inertia(g, b, frame, at, planned_.mode), survey);
      });
    });
  }

  /// The design as constants of another scalar.
  template <class To, class From>
  Sweeping<To> still(std::span<const From> parameters) const {
    const std::array<To, kParameters> values = constants<To, kParameters>(parameters);
    return sweeping(design(geometry(planned_.platform, std::span<const To>(values)), planned_.limits, box_),
                    planned_.held);
  }

  Planned planned_;
  PoseBox box_;
  double tolerance_;
  bool fixed_;  ///< numbers of nodes are given
  GaussRule outer_rule_, inner_rule_;
};

}  // namespace

std::unique_ptr<const WorkspaceEvaluator> make_surveyor(const Planned& planned, const ColumnOptions& columns) {
  return std::make_unique<ColumnEvaluator>(planned, columns);
}

}  // namespace pkm::crr_cru
