#include "engine/workspace/prepare_workspace.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/core/team.hpp"
#include "engine/workspace/cellwise_voxels.hpp"
#include "engine/workspace/home_columns.hpp"
#include "engine/workspace/home_component.hpp"
#include "engine/workspace/with_gradients.hpp"

namespace pkm {
namespace {

/// Evaluator that averages the results of several evaluators with equal weights.
class AverageEvaluator final : public WithGradients<AverageEvaluator> {
 public:
  /// @param serial_members  true if the averaged evaluators do not use the thread team themselves
  AverageEvaluator(std::vector<std::unique_ptr<const WorkspaceEvaluator>> members, const FieldRequest& request,
                   bool serial_members)
      : members_(std::move(members)), fields_(request.fields), serial_members_(serial_members) {}
  const GradientEvaluator* gradients() const override { return members_.front()->gradients() ? this : nullptr; }
  std::string why_no_derivatives() const override { return members_.front()->why_no_derivatives(); }

 private:
  friend WithGradients<AverageEvaluator>;
  template <class S>
  struct Buffers {
    std::vector<WorkspaceResult<S>> members;
    std::vector<Scratch> per_worker;
  };

  template <class S>
  void run(std::span<const S> parameters, Scratch& scratch, WorkspaceResult<S>& result) const {
    Buffers<S>& buffers = scratch.get<Buffers<S>>();
    result.clear(fields_);
    const double share = 1.0 / static_cast<double>(members_.size());
    const bool is_parallel = has_team() && (serial_members_ || members_.size() >= workers());
    buffers.members.resize(is_parallel ? members_.size() : 1);
    if (is_parallel) {
      buffers.per_worker.resize(workers());
      parallel_for(members_.size(), [&](std::size_t k, std::size_t end, std::size_t worker) {
        for (; k < end; ++k)
          evaluate_workspace(*members_[k], parameters, buffers.per_worker[worker], buffers.members[k]);
      });
    }
    for (std::size_t k = 0; k < members_.size(); ++k) {
      WorkspaceResult<S>& one = buffers.members[is_parallel ? k : 0];
      if (!is_parallel) evaluate_workspace(*members_[k], parameters, scratch, one);
      result.volume += one.volume * share;
      result.cells += one.cells;
      result.feasible_cells += one.feasible_cells;
      result.cell_volume = one.cell_volume * share;
      result.touches_box = result.touches_box || one.touches_box;
      result.columns += one.columns;
      result.error = std::max(result.error, one.error);
      result.is_sampled = result.is_sampled || one.is_sampled;
      for (S& weight : one.weight) weight *= share;
      append_samples(one, result);
    }
  }

  std::vector<std::unique_ptr<const WorkspaceEvaluator>> members_;
  std::vector<const PoseQuantity*> fields_;
  bool serial_members_;
};

/// @return true if the mechanism has a voxel evaluator of its own that supports the plan; otherwise
/// prepare_cellwise_voxels() is used, which tests one cell after the other
bool has_voxels(const Mechanism& mechanism, const WorkspacePlan& plan) {
  const bool needs_obstacles = !plan.limits.obstacles.empty() && requires_clearance(mechanism.info(), plan);
  return mechanism.voxels() && (!needs_obstacles || mechanism.voxels()->supports_obstacles());
}

std::unique_ptr<const VoxelEvaluator> prepare_voxels(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                     const FieldRequest& request) {
  if (plan.home) {
    WorkspacePlan without = plan;
    without.home.reset();
    FieldRequest of_cells = request;
    of_cells.poses = of_cells.every_pose = true;
    return prepare_home_component(mechanism, plan, request, prepare_voxels(mechanism, without, {.mode = request.mode}),
                                  request.needs_samples() ? prepare_voxels(mechanism, without, of_cells) : nullptr);
  }
  if (has_voxels(mechanism, plan) && !first_cellwise_field(request))
    return mechanism.voxels()->prepare(plan, *plan.voxels(), request);
  return prepare_cellwise_voxels(mechanism, plan, *plan.voxels(), request);
}

std::unique_ptr<const WorkspaceEvaluator> prepare_one(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                      const FieldRequest& request) {
  sweep_of(mechanism.info(), plan);  // throws std::invalid_argument if the mechanism has no such sweep
  if (const ColumnOptions* const columns = plan.columns()) {
    const std::string remedy = "; set workspace.method = \"voxels\"", &name = mechanism.info().name;
    const std::string why = mechanism.why_no_columns();
    if (!mechanism.columns())
      throw std::invalid_argument("mechanism " + name + " has no columns" + (why.empty() ? "" : ": " + why) + remedy);
    if (const PoseQuantity* const cellwise = first_cellwise_field(request))
      throw std::invalid_argument("columns do not compute " + std::string(cellwise->meaning) + remedy);
    if (columns->box && !mechanism.columns()->supports_box())
      throw std::invalid_argument("columns of mechanism " + name + " do not support a box" + remedy);
    if (!plan.home) return mechanism.columns()->prepare(plan, *columns, request);
    return prepare_home_columns(
        mechanism, plan, request,
        prepare_voxels(mechanism, grid_of_components(mechanism.info(), plan), {.mode = request.mode}));
  }
  return prepare_voxels(mechanism, plan, request);
}

/// Expands a plan with lists of fixed values into plans with one value each.
std::vector<WorkspacePlan> single_plans(const WorkspacePlan& plan) {
  using Kind = FixedCoordinate::Kind;
  const auto list = std::ranges::find(plan.fixed, Kind::listed, &FixedCoordinate::kind);
  if (list == plan.fixed.end()) return {plan};
  std::vector<WorkspacePlan> plans;
  for (const double value : list->values) {
    WorkspacePlan one = plan;
    one.fixed[static_cast<std::size_t>(list - plan.fixed.begin())] = {list->coordinate, Kind::value, value};
    for (WorkspacePlan& single : single_plans(one)) plans.push_back(std::move(single));
  }
  return plans;
}

}  // namespace

const PoseQuantity* first_cellwise_field(const FieldRequest& request) {
  for (const PoseQuantity* const quantity : request.fields)
    if (quantity->needs_report() && quantity != &kConditioning) return quantity;
  return nullptr;
}

std::unique_ptr<const WorkspaceEvaluator> prepare_workspace(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                            const FieldRequest& request) {
  std::vector<std::unique_ptr<const WorkspaceEvaluator>> members;
  for (const WorkspacePlan& one : single_plans(plan)) members.push_back(prepare_one(mechanism, one, request));
  if (members.size() == 1) return std::move(members.front());
  return std::make_unique<AverageEvaluator>(std::move(members), request, plan.columns() != nullptr);
}

std::unique_ptr<const VoxelEvaluator> prepare_voxel_map(const Mechanism& mechanism, const WorkspacePlan& plan,
                                                        const std::string& mode) {
  sweep_of(mechanism.info(), plan);
  return prepare_voxels(mechanism, plan, {.mode = mode});
}

VoxelMap voxel_map(const Mechanism& mechanism, std::span<const double> parameters, const WorkspacePlan& plan) {
  return prepare_voxel_map(mechanism, plan)->map(parameters);
}

}  // namespace pkm
