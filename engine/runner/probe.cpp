#include "engine/runner/probe.hpp"

#include <algorithm>

#include "engine/core/stop.hpp"
#include "engine/optimisers/sampling.hpp"
#include "engine/problem/evaluator.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {
namespace {

constexpr std::size_t kMaxDesigns = 64, kMinDesigns = 4;
// Maximum estimated time of all sample designs together, and of a single one [s].
constexpr double kBudget = 50e-3, kMaxCost = 0.5;

// Approximate times of the parts of a workspace analysis [s]:
constexpr double kVoxelCost = 0.1e-9;   // time for each voxel that is counted in batches
constexpr double kSampleCost = 0.1e-6;  // time for each voxel at which pose quantities are evaluated
constexpr double kNodeCost = 1e-6;      // time for each node of a column at which pose quantities are evaluated
// Time for each pose at which the full inverse kinematics or the distances between links are computed.
constexpr double kKinematicsCost = 2e-6;
constexpr double kDesignTestCost = 20e-6;  // time [s] for each constraint that depends on the design alone
constexpr double kColumnNodes = 5000;      // typical number of quadrature nodes of the exact method

/// Estimated time of one workspace analysis [s].
double cost(const Mechanism& mechanism, const WorkspacePlan& plan, const FieldRequest& request) {
  double poses = kColumnNodes;
  if (const VoxelOptions* const voxels = plan.voxels()) {
    poses = 1;
    for (const std::int64_t cells : voxels->cells) poses *= static_cast<double>(cells);
  }
  for (const FixedCoordinate& fixed : plan.fixed)
    poses *=
        static_cast<double>(std::max({std::int64_t{1}, fixed.cells, static_cast<std::int64_t>(fixed.values.size())}));
  const bool is_cellwise = plan.voxels() && (!mechanism.voxels() || first_cellwise_field(request));
  const double each = is_cellwise || requires_clearance(mechanism.info(), plan) ? kKinematicsCost
                      : !request.needs_samples()                                ? kVoxelCost
                      : plan.voxels()                                           ? kSampleCost
                                                                                : kNodeCost;
  return poses * each;
}

}  // namespace

std::size_t Probe::feasible() const {
  return static_cast<std::size_t>(std::ranges::count(table.status, Status::feasible));
}

std::size_t probe_size(const DesignProblem& problem) {
  const ProblemParts& parts = problem.parts();
  double one = cost(*parts.mechanism, parts.plan, parts.request);
  for (const Region& region : parts.regions) one += cost(*parts.mechanism, region.plan, region.request);
  one += kDesignTestCost * static_cast<double>(parts.design_margins.size());
  if (one > kMaxCost) return 0;
  return std::clamp(static_cast<std::size_t>(kBudget / one), kMinDesigns, kMaxDesigns);
}

Probe probe(const Study& study) {
  const DesignProblem& problem = *study.problem;
  const DesignSpace& space = problem.space();
  Probe probe{EvaluationTable(problem.shape()), {}, false};
  const std::size_t count = space.dimension() > 0 ? probe_size(problem) : 0;
  if (count == 0) return probe;
  const std::vector<double> points = unit_cube_samples(Start::sobol, count, space.dimension(), study.seed);
  probe.table.extend(count);
  for (std::size_t row = 0; row < count; ++row)
    for (std::size_t v = 0; v < space.dimension(); ++v)
      probe.table.design(row)[v] = space.from_unit(v, points[row * space.dimension() + v]);
  {
    const StopScope limit(Probe::kTimeLimit);
    try {
      ParallelEvaluator().evaluate(problem, probe.table, 0);
    } catch (const Stopped&) {  // the table contains the designs evaluated so far
      if (limit.is_requested_by_outer_scope()) throw;
      probe.is_cut_off = true;
    }
  }
  if (probe.table.size() == 0) return probe;
  probe.diagnosis = diagnose({&probe.table}, problem.objectives(), problem.margins(), &problem);
  return probe;
}

std::string describe_probe(const Probe& probe) {
  if (probe.table.size() == 0) return "no sample designs were evaluated, because a single evaluation takes too long";
  return std::to_string(probe.feasible()) + " of " + std::to_string(probe.table.size()) +
         " designs spread over the bounds are feasible" +
         (probe.is_cut_off ? "; more would take longer than 10 s" : "");
}

}  // namespace pkm
