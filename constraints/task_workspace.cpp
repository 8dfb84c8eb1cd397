// A box of poses must be feasible, with margins: what the buyer of a robot asks for.
//
// The margin is the least of all pose margins (reach, strokes, distances from singularities, ...) over a grid of the
// box that holds its corners and faces, at every value of the held coordinate. Gradient solvers see a smooth lower
// bound of it, which is below it by at most ln(number of margins) / sharpness.
#include "constraints/list.hpp"
#include "constraints/pose_margins.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

const Region& region_of(const EntryContext& context) {
  const std::string& name = context.options.word("region");
  if (const Region* found = find_named(context.regions, name)) return *found;
  throw std::invalid_argument("the study has no [[region]] called '" + name + "'" +
                              did_you_mean(name, names_of(context.regions)));
}

/// The same poses, with each of the values at a coordinate.
std::vector<Pose<double>> with_each(const std::vector<Pose<double>>& poses, int coordinate,
                                    const std::vector<double>& values) {
  std::vector<Pose<double>> more;
  for (const Pose<double>& pose : poses)
    for (const double value : values) {
      more.push_back(pose);
      more.back()[static_cast<std::size_t>(coordinate)] = value;
    }
  return more;
}

/// Grid of the region's box, corners included, at every value of the held coordinates.
std::vector<Pose<double>> poses_of(const Region& region, const MechanismInfo& info, int points) {
  const SurveyPlan& plan = region.plan;
  if (!plan.box()) throw std::invalid_argument("task-workspace needs a box, and region '" + region.name + "' has none");
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<Pose<double>> poses = {Pose<double>(info.coordinates.size())};
  for (const int coordinate : sweep.held) {
    const HeldCoordinate how = how_held(plan, coordinate);
    using Kind = HeldCoordinate::Kind;
    if (how.kind != Kind::value && how.kind != Kind::listed)
      throw std::invalid_argument("task-workspace needs a number, or a list of them, for the coordinate that region '" +
                                  region.name + "' holds");
    poses = with_each(poses, coordinate, how.kind == Kind::listed ? how.values : std::vector<double>{how.value});
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

std::unique_ptr<const Quantity> make(const EntryContext& context) {
  const Region& region = region_of(context);
  const MechanismInfo& info = context.mechanism.info();
  const MarginPoses of{poses_of(region, info, static_cast<int>(context.options.integer("points"))), info.modes.front(),
                       region.plan.limits};
  const double wanted = context.options.number("margin"), sharpness = context.options.number("sharpness");
  return make_quantity(
      [of, wanted](const DesignView<double>& design) { return least(margins_of(design, of)) - wanted; },
      [of, wanted, sharpness](const DesignView<Dual4>& design) {
        return Dual4(soft_minimum(margins_of(design, of), sharpness) - wanted);
      },
      no_margin_derivatives(context.mechanism, "task-workspace"));
}

}  // namespace

ConstraintEntry task_workspace() {
  return {
      .name = "task-workspace",
      .meaning = "the box of a region is feasible: least margin of its poses, in the margins' units",
      .options =
          [](const MechanismInfo&) {
            return std::vector<OptionSpec>{
                {.name = "region",
                 .kind = OptionKind::word,
                 .required = true,
                 .meaning =
                     "name of the [[region]] whose box, at the value or values that it holds, is to be feasible"},
                {.name = "margin",
                 .unit = kUnitOfEntry,
                 .initial = 0.0,
                 .lower = 0,
                 .meaning = "least margin that is to be left"},
                {.name = "points",
                 .kind = OptionKind::integer,
                 .initial = std::int64_t{5},
                 .lower = 2,
                 .upper = 65,
                 .meaning = "poses along each edge of the box that are tested, its corners among them"},
                sharpness_of_minimum()};
          },
      .unit = unit_of_minimum,
      .make = make,
  };
}

}  // namespace pkm
