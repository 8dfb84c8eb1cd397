#include "engine/workspace/survey_set.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/core/team.hpp"
#include "engine/workspace/plain_voxels.hpp"
#include "engine/workspace/with_slopes.hpp"

namespace pkm {
namespace {

class SurveySet final : public WithGradients<SurveySet> {
 public:
  /// @param alone  members share nothing out themselves
  SurveySet(std::vector<std::unique_ptr<const WorkspaceEvaluator>> members, const Demand& demand, bool alone)
      : members_(std::move(members)), fields_(demand.fields), alone_(alone) {}
  const GradientEvaluator* slopes() const override { return members_.front()->slopes() ? this : nullptr; }
  std::string why_no_gradients() const override { return members_.front()->why_no_gradients(); }

 private:
  friend WithGradients<SurveySet>;
  template <class S>
  struct Room {
    std::vector<Survey<S>> of_members;
    std::vector<Scratch> of_workers;
  };

  template <class S>
  void run(std::span<const S> parameters, Scratch& scratch, Survey<S>& survey) const {
    Room<S>& room = scratch.get<Room<S>>();
    survey.clear(fields_);
    const double share = 1.0 / static_cast<double>(members_.size());
    const bool shared = has_team() && (alone_ || members_.size() >= workers());
    room.of_members.resize(shared ? members_.size() : 1);
    if (shared) {
      room.of_workers.resize(workers());
      parallel_for(members_.size(), [&](std::size_t k, std::size_t end, std::size_t worker) {
        for (; k < end; ++k) evaluate_workspace(*members_[k], parameters, room.of_workers[worker], room.of_members[k]);
      });
    }
    for (std::size_t k = 0; k < members_.size(); ++k) {
      Survey<S>& one = room.of_members[shared ? k : 0];
      if (!shared) evaluate_workspace(*members_[k], parameters, scratch, one);
      survey.volume += one.volume * share;
      survey.cells += one.cells;
      survey.feasible_cells += one.feasible_cells;
      survey.cell_volume = one.cell_volume * share;
      survey.touches_box = survey.touches_box || one.touches_box;
      survey.columns += one.columns;
      survey.error = std::max(survey.error, one.error);
      for (S& weight : one.weight) weight *= share;
      append_samples(one, survey);
    }
  }

  std::vector<std::unique_ptr<const WorkspaceEvaluator>> members_;
  std::vector<const PoseQuantity*> fields_;
  bool alone_;
};

/// Whether the mechanism's own voxels serve the plan; else it is surveyed cell by cell.
bool has_voxels(const Mechanism& mechanism, const WorkspacePlan& plan) {
  const auto& limits = mechanism.info().limits;
  bool obstructed = false;
  for (std::size_t i = 0; !plan.limits.obstacles.empty() && i < limits.size(); ++i)
    obstructed = obstructed || (limits[i].group == "clearance" && asks_clearance(plan, i));
  return mechanism.voxels() && (!obstructed || mechanism.voxels()->take_obstacles());
}

std::unique_ptr<const WorkspaceEvaluator> prepare_one(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                      const Demand& demand) {
  sweep_of(mechanism.info(), plan);  // refuses what it has no sweep for
  const PoseQuantity* const foreign = of_cells_only(demand);
  if (const ColumnOptions* const columns = plan.columns()) {
    if (!mechanism.columns() || foreign)
      throw std::invalid_argument("mechanism " + mechanism.info().name + " has no column surveys" +
                                  (foreign                              ? " of " + std::string(foreign->meaning)
                                   : mechanism.why_no_columns().empty() ? ""
                                                                        : ": " + mechanism.why_no_columns()) +
                                  "; take workspace.method = \"voxels\"");
    if (columns->box && !mechanism.columns()->take_box())
      throw std::invalid_argument("columns of mechanism " + mechanism.info().name +
                                  " cannot be cut by a box; take workspace.method = \"voxels\"");
    return mechanism.columns()->prepare(plan, *columns, demand);
  }
  if (has_voxels(mechanism, plan) && !foreign) return mechanism.voxels()->prepare(plan, *plan.voxels(), demand);
  return prepare_plain_voxels(mechanism, plan, *plan.voxels(), demand);
}

/// The plans without lists that a plan stands for.
std::vector<WorkspacePlan> single_plans(const WorkspacePlan& plan) {
  using Kind = FixedCoordinate::Kind;
  const auto list = std::ranges::find(plan.held, Kind::listed, &FixedCoordinate::kind);
  if (list == plan.held.end()) return {plan};
  std::vector<WorkspacePlan> plans;
  for (const double value : list->values) {
    WorkspacePlan one = plan;
    one.held[static_cast<std::size_t>(list - plan.held.begin())] = {list->coordinate, Kind::value, value};
    for (WorkspacePlan& single : single_plans(one)) plans.push_back(std::move(single));
  }
  return plans;
}

}  // namespace

const PoseQuantity* of_cells_only(const Demand& demand) {
  for (const PoseQuantity* const quantity : demand.fields)
    if (!quantity->needs_inertia() && quantity != &kConditioning) return quantity;
  return nullptr;
}

std::unique_ptr<const WorkspaceEvaluator> prepare_workspace(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                            const Demand& demand) {
  std::vector<std::unique_ptr<const WorkspaceEvaluator>> members;
  for (const WorkspacePlan& one : single_plans(plan)) members.push_back(prepare_one(mechanism, one, demand));
  if (members.size() == 1) return std::move(members.front());
  return std::make_unique<SurveySet>(std::move(members), demand, plan.columns() != nullptr);
}

std::unique_ptr<const VoxelEvaluator> prepare_map(const Mechanism& mechanism, const WorkspacePlan& plan) {
  sweep_of(mechanism.info(), plan);
  const VoxelOptions& voxels = *plan.voxels();
  if (has_voxels(mechanism, plan)) return mechanism.voxels()->prepare(plan, voxels, {});
  return prepare_plain_voxels(mechanism, plan, voxels, {});
}

VoxelMap voxel_map(const Mechanism& mechanism, std::span<const double> parameters, const WorkspacePlan& plan) {
  return prepare_map(mechanism, plan)->map(parameters);
}

}  // namespace pkm
