// A box of poses must be feasible, with margins: what the buyer of a robot asks for.
//
// The margin is the least of all pose margins (reach, strokes, distances from singularities, ...) over a grid of the
// box that holds its corners and faces, at every value of the held coordinate. Gradient solvers see a smooth lower
// bound of it, which is below it by at most ln(number of margins) / sharpness.
#include <cmath>

#include "constraints/list.hpp"
#include "engine/math/statistics.hpp"

namespace pkm {
namespace {

const Region& region_of(const EntryContext& context) {
  const std::string& name = context.options.word("region");
  std::vector<std::string> known;
  for (const Region& region : context.regions) {
    if (region.name == name) return region;
    known.push_back(region.name);
  }
  const std::string nearest = nearest_name(name, known);
  throw std::invalid_argument("the study has no [[region]] called '" + name + "'" +
                              (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

/// Grid of the region's box, corners included, at every value of the held coordinates.
std::vector<Pose<double>> poses_of(const Region& region, const MechanismInfo& info, int points) {
  const SurveyPlan& plan = region.plan;
  if (!plan.box()) throw std::invalid_argument("task-workspace needs a box, and region '" + region.name + "' has none");
  const Sweep& sweep = sweep_of(info, plan);
  std::vector<Pose<double>> held = {Pose<double>(info.coordinates.size())};
  for (const int coordinate : sweep.held) {
    const HeldCoordinate how = how_held(plan, coordinate);
    using Kind = HeldCoordinate::Kind;
    if (how.kind != Kind::value && how.kind != Kind::listed)
      throw std::invalid_argument("task-workspace needs a number, or a list of them, for the coordinate that region '" +
                                  region.name + "' holds");
    std::vector<Pose<double>> more;
    for (const Pose<double>& pose : held)
      for (const double value : how.kind == Kind::listed ? how.values : std::vector<double>{how.value}) {
        more.push_back(pose);
        more.back()[static_cast<std::size_t>(coordinate)] = value;
      }
    held = std::move(more);
  }
  const auto at = [&](std::size_t axis, int k) {
    const auto& [lower, upper] = (*plan.box())[axis];
    return k == points - 1 ? upper : lower + (upper - lower) * k / (points - 1);
  };
  std::vector<Pose<double>> poses = std::move(held);
  for (std::size_t axis = 0; axis < sweep.swept.size(); ++axis) {
    std::vector<Pose<double>> more;
    for (const Pose<double>& pose : poses)
      for (int k = 0; k < points; ++k) {
        more.push_back(pose);
        more.back()[static_cast<std::size_t>(sweep.swept[axis])] = at(axis, k);
      }
    poses = std::move(more);
  }
  return poses;
}

template <class S>
struct Margins {
  std::vector<S> of_poses;
};

class TaskWorkspace final : public Quantity {
 public:
  TaskWorkspace(const EntryContext& context)
      : mechanism_(context.mechanism),
        limits_(region_of(context).plan.limits),
        poses_(poses_of(region_of(context), context.mechanism.info(),
                        static_cast<int>(context.options.integer("points")))),
        wanted_(context.options.number("margin")),
        sharpness_(context.options.number("sharpness")) {}

  double value(const DesignView<double>& design) const override {
    const std::vector<double>& margins = margins_of(design);
    return least(margins) - wanted_;
  }
  Dual4 smooth(const DesignView<Dual4>& design) const override {
    const std::vector<Dual4>& margins = margins_of(design);
    const double shift = least(margins).a;
    Dual4 sum(0.0);
    for (const Dual4& margin : margins) sum += exp((margin - shift) * -sharpness_);
    return shift - log(sum) / sharpness_ - wanted_;
  }
  std::string no_derivatives() const override {
    if (mechanism_.pose_margins() && mechanism_.derivatives()) return {};
    return "the margins of mechanism " + mechanism_.info().name + " under task-workspace have none";
  }

 private:
  template <class S>
  const std::vector<S>& margins_of(const DesignView<S>& design) const {
    std::vector<S>& margins = design.scratch.template get<Margins<S>>().of_poses;
    margins.clear();
    append_pose_margins<S>(mechanism_, design.parameters, limits_, poses_, margins);
    return margins;
  }

  const Mechanism& mechanism_;  ///< the problem's, which outlives its quantities
  LimitSpec limits_;
  std::vector<Pose<double>> poses_;
  double wanted_, sharpness_;
};

}  // namespace

ConstraintEntry task_workspace() {
  return {
      .name = "task-workspace",
      .meaning = "the box of a region is feasible: least margin of its poses, in the margins' units",
      .pose_level = false,
      .options =
          [](const MechanismInfo&) {
            return std::vector<OptionSpec>{
                {.name = "region",
                 .kind = OptionKind::word,
                 .required = true,
                 .meaning =
                     "name of the [[region]] whose box, at the value or values that it holds, is to be feasible"},
                {.name = "margin",
                 .kind = OptionKind::number,
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
                 .kind = OptionKind::number,
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
      .refusal = [](const Mechanism&) { return std::string(); },
      .limits = nullptr,
      .make = [](const EntryContext& context) -> std::unique_ptr<const Quantity> {
        return std::make_unique<TaskWorkspace>(context);
      },
  };
}

}  // namespace pkm
