// A motion keeps every limit of a pose.
//
// The margin is the minimum of all pose margins (reach, strokes, distances from singularities, clearance, ...) over
// the motion's samples, under the study's limits. Gradient solvers are given a smooth lower bound of it
// (soft_minimum). A study has this constraint for every motion that one of its objectives, constraints or reports
// names, unless that [[motion]] says follow = false: forces of a motion that the robot cannot follow mean nothing.
#include "constraints/list.hpp"
#include "constraints/pose_margins.hpp"
#include "engine/problem/motion_options.hpp"
#include "engine/problem/pose_options.hpp"

namespace pkm {
namespace {

constexpr double kUnlimited = 1;  // margin of a motion where nothing limits a pose

std::unique_ptr<const Quantity> minimum_along(const EntryContext& context) {
  MarginPoses along{{}, mode_of(context), context.plan.limits};
  for (const MotionSample& at : samples_of(context)) along.poses.push_back(at.pose);
  const double sharpness = context.options.number("sharpness");
  return make_quantity(
      [along](const DesignView<double>& design) {
        const std::vector<double>& margins = margins_of(design, along);
        return margins.empty() ? kUnlimited : least(margins);
      },
      [along, sharpness](const DesignView<Dual4>& design) {
        const std::vector<Dual4>& margins = margins_of(design, along);
        return margins.empty() ? Dual4(kUnlimited) : soft_minimum(margins, sharpness);
      },
      no_margin_derivatives(context.mechanism, kMotionConstraint));
}

}  // namespace

ConstraintEntry motion_constraint() {
  return {
      .name = kMotionConstraint,
      .meaning = "a motion keeps every limit of a pose: minimum margin of its poses, in the margins' units",
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
