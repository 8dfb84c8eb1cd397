// A box of poses must be feasible, with margins: what the buyer of a robot asks for.
//
// The margin is the least of all pose margins (reach, strokes, distances from singularities, ...) over a grid of the
// box that holds its corners and faces, at every value of the held coordinate. Gradient solvers see a smooth lower
// bound of it, which is below it by at most ln(number of margins) / sharpness.
#include <cmath>
#include <type_traits>

#include "constraints/list.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/math/statistics.hpp"

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

template <class S>
struct Margins {
  std::vector<S> of_poses;
};

/// By the ability, else the margins that inspect names, NaN counting as broken: appended.
template <class S>
void append_margins(const DesignView<S>& design, const LimitSpec& limits, std::span<const Pose<double>> poses,
                    std::vector<S>& margins) {
  const Mechanism& mechanism = design.mechanism;
  if (const PoseMargins* ability = mechanism.pose_margins()) {
    ability->append(design.parameters, limits, poses, margins);
  } else if constexpr (std::is_same_v<S, double>) {
    for (const Pose<double>& pose : poses) {
      const PoseReport report = mechanism.inspect(design.parameters, pose, mechanism.info().modes.front(), limits);
      for (const auto& [name, margin] : report.margins) margins.push_back(margin == margin ? margin : -1);
      if (!report.assembles) margins.push_back(-1);
    }
  }
}

std::unique_ptr<const Quantity> make(const EntryContext& context) {
  const Region& region = region_of(context);
  const MechanismInfo& info = context.mechanism.info();
  const auto margins_of = [limits = region.plan.limits,
                           poses =
                               poses_of(region, info, static_cast<int>(context.options.integer("points")))]<class S>(
                              const DesignView<S>& design) -> const std::vector<S>& {
    std::vector<S>& margins = design.scratch.template get<Margins<S>>().of_poses;
    margins.clear();
    append_margins<S>(design, limits, poses, margins);
    return margins;
  };
  const double wanted = context.options.number("margin"), sharpness = context.options.number("sharpness");
  Refusal no_derivatives;
  if (!context.mechanism.pose_margins())
    no_derivatives = "the margins of mechanism " + info.name + " under task-workspace have none";
  return make_quantity([=](const DesignView<double>& design) { return least(margins_of(design)) - wanted; },
                       [=](const DesignView<Dual4>& design) {
                         const std::vector<Dual4>& margins = margins_of(design);
                         const double shift = least(margins).a;
                         Dual4 sum(0.0);
                         for (const Dual4& margin : margins) sum += exp((margin - shift) * -sharpness);
                         return Dual4(shift - log(sum) / sharpness - wanted);
                       },
                       no_derivatives);
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
                {.name = "sharpness",
                 .initial = 1e5,
                 .lower = 1,
                 .upper = 1e9,
                 .meaning = "of the smooth lower bound that gradient solvers are given: larger is nearer"}};
          },
      .unit =
          [](const EntryContext& context) {
            const PoseMargins* const margins = context.mechanism.pose_margins();
            return margins ? margins->margin_unit() : std::string("1");
          },
      .make = make,
  };
}

}  // namespace pkm
