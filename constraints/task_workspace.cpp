// Prescribed workspace: a box of poses, the task of the robot, must be feasible with a minimum margin.
//
// The constraint value is the minimum of all pose margins (reach, strokes, distances from singularities, ...) over a
// regular grid of the box, including its faces and vertices, at every value of the fixed coordinates. For gradient
// solvers it is replaced by a smooth lower bound, whose error is at most ln(number of margins) / sharpness.
#include "constraints/list.hpp"
#include "constraints/pose_margins.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/geometry/pose_product.hpp"

namespace pkm {
namespace {

const Region& region_of(const EntryContext& context) {
  const std::string& name = context.options.word("region");
  if (const Region* found = find_named(context.regions, name)) return *found;
  throw std::invalid_argument("the study has no [[region]] called '" + name + "'" +
                              did_you_mean(name, names_of(context.regions)));
}

/// Regular grid of the region's box, including its vertices, at every value of the fixed coordinates.
/// @param points  number of grid points along each edge
std::vector<Pose<double>> poses_of(const Region& region, const MechanismInfo& info, int points) {
  const WorkspacePlan& plan = region.plan;
  if (!plan.box()) throw std::invalid_argument("task-workspace needs a box, and region '" + region.name + "' has none");
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<Pose<double>> poses = {Pose<double>(info.coordinates.size())};
  for (const int coordinate : sweep.fixed) {
    const FixedCoordinate how = how_fixed(plan, coordinate);
    using Kind = FixedCoordinate::Kind;
    if (how.kind != Kind::value && how.kind != Kind::listed)
      throw std::invalid_argument(
          "task-workspace needs a number or a list of them for each fixed coordinate of region '" + region.name + "'");
    poses = with_each(poses, coordinate, how.kind == Kind::listed ? how.values : std::vector{how.value});
  }
  for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis) {
    const auto& [lower, upper] = (*plan.box())[axis];
    std::vector<double> values;
    for (int k = 0; k + 1 < points; ++k) values.push_back(lower + (upper - lower) * k / (points - 1));
    values.push_back(upper);
    poses = with_each(poses, sweep.swept[axis], values);
  }
  return poses;
}

std::unique_ptr<const Quantity> make_task_workspace(const EntryContext& context) {
  const Region& region = region_of(context);
  const MechanismInfo& info = context.mechanism.info();
  const MarginPoses of{poses_of(region, info, static_cast<int>(context.options.integer("points"))), info.modes.front(),
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
      .meaning = "the box of a region is feasible: minimum of all margins of its poses, in their units",
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
                 .initial = std::int64_t{5},
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
