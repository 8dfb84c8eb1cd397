#include "engine/runner/exact_values.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/core/unit.hpp"
#include "engine/runner/design_record.hpp"
#include "engine/workspace/prepare_workspace.hpp"

namespace pkm {

ExactValues::ExactValues(const ProblemParts& parts) : parts_(parts) {
  if (!parts.plan.voxels() || !parts.mechanism->columns()) return;
  ColumnOptions columns;
  columns.tolerance = 1e-10;
  if (parts.mechanism->columns()->supports_box()) columns.box = parts.plan.box();
  ProblemParts exact = parts;
  exact.plan.method = columns;
  // A problem with other rows chosen from the catalogues would use the method of the study instead of the exact method.
  exact.with_rows = nullptr;
  try {
    if (parts.built) {
      ProblemParts machine = parts.built->problem->parts();
      machine.plan.method = columns;
      exact.built = std::make_shared<const BuiltMachines>(
          BuiltMachines{parts.built->tolerances, std::make_shared<const DesignProblem>(std::move(machine))});
    }
    problem_ = std::make_unique<const DesignProblem>(std::move(exact));
  } catch (const std::invalid_argument&) {
  }
}

std::optional<DesignRecord> ExactValues::evaluate(const char* name, std::span<const double> parameters,
                                                  std::vector<std::string>& notes) const {
  if (!problem_) return {};
  if (const Unsupported poses = poses_beyond_box(parameters)) {
    notes.push_back(std::string(kNoValues) + name + ": the exact method of mechanism " + parts_.mechanism->info().name +
                    " cannot restrict the workspace to workspace.box; the box must contain all reachable poses (" +
                    *poses + ")");
    return {};
  }
  DesignRecord record = evaluate_design(*problem_, parameters);
  discard_voxel_values(parts_.objectives, record.objectives);
  discard_voxel_values(parts_.reports, record.reports);
  return record;
}

Unsupported ExactValues::poses_beyond_box(std::span<const double> parameters) const {
  const std::optional<Box>& box = parts_.plan.box();
  if (!box || problem_->parts().plan.box()) return {};
  WorkspacePlan plan = parts_.plan;
  plan.home.reset();
  plan.method = VoxelOptions{};  // a single cell that fills a box of all reachable poses, whose ranges are needed
  VoxelMap reachable;
  try {
    reachable = voxel_map(*parts_.mechanism, parameters, plan);
  } catch (const DesignError& reason) {
    return reason.what();
  }
  const MechanismInfo& info = parts_.mechanism->info();
  const std::vector<int>& swept = sweep_of(info, parts_.plan).swept;
  std::vector<std::string> ranges;
  bool contained = true;
  for (std::size_t k = 0; k < swept.size(); ++k) {
    const double lower = reachable.lower[k], upper = reachable.upper[k];
    const double roundoff = 1e-12 * std::fmax(std::fabs(lower), std::fabs(upper));
    contained = contained && (*box)[k][0] <= lower + roundoff && (*box)[k][1] >= upper - roundoff;
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(swept[k])];
    ranges.push_back(axis.name + " = " + shortest(lower) + " .. " + with_unit(upper, axis.unit));
  }
  return contained ? Unsupported() : join(ranges);
}

void ExactValues::discard_voxel_values(const std::vector<NamedQuantity>& quantities,
                                       std::vector<double>& values) const {
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (const NamedQuantity& q = quantities[i];
        q.uses_workspace && q.analysis > 0 && parts_.regions[q.analysis - 1].plan.voxels())
      values[i] = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pkm
