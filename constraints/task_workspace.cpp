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

/// Grid of the region's box, corners included, at every value of the held coordinate.
std::vector<Pose<double>> poses_of(const Region& region, const MechanismInfo& info, int points) {
  const SurveyPlan& plan = region.plan;
  if (!plan.box) throw std::invalid_argument("task-workspace needs a box, and region '" + region.name + "' has none");
  if (plan.held.kind != HeldCoordinate::Kind::value)
    throw std::invalid_argument("task-workspace needs a number, or a list of them, for the coordinate that region '" +
                                region.name + "' holds");
  const Sweep sweep = sweep_of(info, plan);
  const std::vector<double> held = plan.held_values.empty() ? std::vector<double>{plan.held.value} : plan.held_values;
  const auto at = [&](std::size_t axis, int k) {
    const auto& [lower, upper] = (*plan.box)[axis];
    return k == points - 1 ? upper : lower + (upper - lower) * k / (points - 1);
  };
  std::vector<Pose<double>> poses;
  std::array<double, 4> x{};
  for (const double value : held) {
    x[static_cast<std::size_t>(sweep.held)] = value;
    for (int i = 0; i < points; ++i)
      for (int j = 0; j < points; ++j)
        for (int k = 0; k < points; ++k) {
          x[static_cast<std::size_t>(sweep.swept[0])] = at(0, i);
          x[static_cast<std::size_t>(sweep.swept[1])] = at(1, j);
          x[static_cast<std::size_t>(sweep.swept[2])] = at(2, k);
          poses.push_back({x[0], x[1], x[2], x[3]});
        }
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
    if (!mechanism_.info().margin_unit.empty()) return {};
    return "the margins of mechanism " + mechanism_.info().name + " under task-workspace have none";
  }

 private:
  template <class S>
  const std::vector<S>& margins_of(const DesignView<S>& design) const {
    std::vector<S>& margins = design.scratch.template get<Margins<S>>().of_poses;
    margins.clear();
    mechanism_.pose_margins(design.parameters, limits_, poses_, margins);
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
            const std::string& unit = context.mechanism.info().margin_unit;
            return unit.empty() ? std::string("1") : unit;
          },
      .refusal = [](const MechanismInfo&) { return std::string(); },
      .limits = nullptr,
      .make = [](const EntryContext& context) -> std::unique_ptr<const Quantity> {
        return std::make_unique<TaskWorkspace>(context);
      },
  };
}

}  // namespace pkm
