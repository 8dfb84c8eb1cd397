// Feasibility of a motion: every pose along it must satisfy the limits of poses.
//
// The margin is the minimum of all pose margins (reach, strokes, distances from singularities, clearance, ...) over the
// samples of the motion, with the limits of the study. For gradient solvers it is replaced by a smooth lower bound
// (soft_minimum). Studies have this constraint for every motion that an objective, a constraint or an output uses,
// unless that [[motion]] has follow = false: forces along a motion that the robot cannot follow are meaningless.
#include "constraints/list.hpp"
#include "constraints/pose_margins.hpp"
#include "engine/problem/motion_options.hpp"
#include "engine/problem/pose_options.hpp"

namespace pkm {
namespace {

constexpr double kUnlimited = 1;  // margin of a motion if the mechanism has no limits of poses

std::unique_ptr<const Quantity> minimum_along(const EntryContext& context) {
  MarginPoses along{{}, mode_of(context), context.plan.limits};
  for (const MotionSample& at : samples_of(context)) along.poses.push_back(at.pose);
  const double sharpness = context.options.number("sharpness");
  return make_quantity(
      [along](const DesignView<double>& design) {
        const std::vector<double>& margins = margins_of(design, along);
        return margins.empty() ? kUnlimited : minimum(margins);
      },
      [along, sharpness](const DesignView<Dual4>& design) {
        const std::vector<Dual4>& margins = margins_of(design, along);
        return margins.empty() ? Dual4(kUnlimited) : soft_minimum(margins, sharpness);
      },
      no_margin_derivatives(context.mechanism, along.limits, kMotionConstraint));
}

}  // namespace

ConstraintEntry motion_constraint() {
  return {
      .name = kMotionConstraint,
      .meaning = "every pose along a motion satisfies the limits of poses: minimum of all margins, in their units",
      .options =
          [](const MechanismInfo&) {
            return std::vector<OptionSpec>{motion_option(), samples_option(), mode_option(), sharpness_of_minimum()};
          },
      .unit = unit_of_minimum,
      .make = minimum_along,
      .detail =
          [](const EntryContext& context) {
            return "minimum margin of a pose along the motion " + context.options.word("motion") + ", over " +
                   std::to_string(context.options.integer("samples")) + " samples";
          },
  };
}

}  // namespace pkm
