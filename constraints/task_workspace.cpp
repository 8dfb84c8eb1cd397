// Prescribed workspace: a box of poses, the task of the robot, must be feasible with a minimum margin.
//
// The constraint value is the minimum of all pose margins (reach, strokes, distances from singularities, ...) over a
// regular grid of the box, including its faces and vertices, at every value of the fixed coordinates. For gradient
// solvers this minimum is replaced by a smooth lower bound, whose error is at most ln(number of margins) / sharpness.
#include "constraints/list.hpp"
#include "constraints/pose_margins.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/workspace/box_poses.hpp"

namespace pkm {
namespace {

const Region& region_of(const EntryContext& context) {
  const std::string& name = context.options.word("region");
  if (const Region* found = find_named(context.regions, name)) return *found;
  throw std::invalid_argument("the study has no [[region]] called '" + name + "'" +
                              did_you_mean(name, names_of(context.regions)));
}

std::unique_ptr<const Quantity> make_task_workspace(const EntryContext& context) {
  const Region& region = region_of(context);
  const MechanismInfo& info = context.mechanism.info();
  const auto points = static_cast<int>(context.options.integer("points"));
  const MarginPoses of{poses_of_box(region.plan, info, points, "region '" + region.name + "'"), info.modes.front(),
                       region.plan.limits};
  const double required = context.options.number("margin"), sharpness = context.options.number("sharpness");
  return make_quantity(
      [of, required](const DesignView<double>& design) { return minimum(margins_of(design, of)) - required; },
      [of, required, sharpness](const DesignView<Dual4>& design) {
        return Dual4(soft_minimum(margins_of(design, of), sharpness) - required);
      },
      no_margin_derivatives(context.mechanism, of.limits, "task-workspace"));
}

}  // namespace

ConstraintEntry task_workspace() {
  return {
      .name = "task-workspace",
      .meaning =
          "the box of a region is feasible: minimum of all margins of its poses, each in its own unit (m, rad or 1)",
      .options =
          [](const MechanismInfo&) {
            return std::vector<OptionSpec>{
                {.name = "region",
                 .kind = OptionKind::word,
                 .required = true,
                 .meaning = "name of the [[region]] whose box must be feasible, at the value or values of its fixed "
                            "coordinates"},
                {.name = "margin",
                 .unit = kUnitOfEntry,
                 .initial = 0.0,
                 .lower = 0,
                 .meaning = "required minimum margin"},
                {.name = "points",
                 .kind = OptionKind::integer,
                 .initial = std::int64_t{kBoxPoints},
                 .lower = 2,
                 .upper = 65,
                 .meaning = "number of tested poses along each edge of the box, including its corners"},
                sharpness_of_minimum()};
          },
      .unit = unit_of_minimum,
      .make = make_task_workspace,
  };
}

}  // namespace pkm
