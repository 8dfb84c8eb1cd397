#include "engine/study/exact_values.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/core/unit.hpp"
#include "engine/study/design_record.hpp"
#include "engine/survey/survey_set.hpp"

namespace pkm {

ExactValues::ExactValues(const ProblemParts& parts) : parts_(parts) {
  if (!parts.plan.voxels() || !parts.mechanism->columns()) return;
  ColumnOptions columns;
  columns.tolerance = 1e-10;
  if (parts.mechanism->columns()->take_box()) columns.box = parts.plan.box();
  ProblemParts exact = parts;
  exact.plan.method = columns;
  try {
    problem_ = std::make_unique<const DesignProblem>(std::move(exact));
  } catch (const std::invalid_argument&) {
  }
}

std::optional<DesignRecord> ExactValues::of(const char* name, std::span<const double> parameters,
                                            std::vector<std::string>& notes) const {
  if (!problem_) return {};
  if (const Refusal poses = poses_beyond_box(parameters)) {
    notes.push_back(std::string(kNone) + name + ": columns of mechanism " + parts_.mechanism->info().name +
                    " cannot be cut by workspace.box, which has to hold all poses that the design may reach (" +
                    *poses + ")");
    return {};
  }
  DesignRecord record = evaluated(*problem_, parameters);
  forget_voxels(parts_.objectives, record.objectives);
  forget_voxels(parts_.reports, record.reports);
  return record;
}

Refusal ExactValues::poses_beyond_box(std::span<const double> parameters) const {
  const std::optional<Box>& box = parts_.plan.box();
  if (!box || problem_->parts().plan.box()) return {};
  SurveyPlan plan = parts_.plan;
  plan.method = VoxelOptions{};  // a single cell, of a box that holds all
  VoxelMap all;
  try {
    all = voxel_map(*parts_.mechanism, parameters, plan);
  } catch (const std::exception& reason) {
    return reason.what();
  }
  const MechanismInfo& info = parts_.mechanism->info();
  const std::vector<int>& swept = sweep_of(info, parts_.plan).swept;
  std::vector<std::string> ranges;
  bool holds = true;
  for (std::size_t k = 0; k < swept.size(); ++k) {
    const double lower = all.lower[k], upper = all.upper[k];
    const double roundoff = 1e-12 * std::fmax(std::fabs(lower), std::fabs(upper));
    holds = holds && (*box)[k][0] <= lower + roundoff && (*box)[k][1] >= upper - roundoff;
    const AxisInfo& axis = info.coordinates[static_cast<std::size_t>(swept[k])];
    ranges.push_back(axis.name + " = " + shortest(lower) + " .. " + with_unit(upper, axis.unit));
  }
  return holds ? Refusal() : join(ranges);
}

void ExactValues::forget_voxels(const std::vector<NamedQuantity>& quantities, std::vector<double>& values) const {
  for (std::size_t i = 0; i < quantities.size(); ++i)
    if (const NamedQuantity& q = quantities[i];
        q.reads_survey && q.survey > 0 && parts_.regions[q.survey - 1].plan.voxels())
      values[i] = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pkm
