#include "engine/runner/design_record.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/core/stop.hpp"
#include "engine/core/unit.hpp"
#include "engine/problem/volume_check.hpp"

namespace pkm {

DesignRecord evaluate_design(const DesignProblem& problem, std::span<const double> parameters) {
  const DesignReport r = problem.report(parameters);
  // The default box contains all reachable poses, so that reaching its faces has no meaning.
  const bool box_matters = problem.parts().plan.box().has_value();
  return {.parameters = r.parameters,
          .objectives = r.objectives,
          .margins = r.margins,
          .reports = r.reports,
          .status = r.status,
          .reason = r.reason,
          .volume = r.workspace.volume,
          .cells = r.workspace.cells,
          .feasible_cells = r.workspace.feasible_cells,
          .cell_volume = r.workspace.cell_volume,
          .touches_box = box_matters && r.workspace.touches_box};
}

void add_certified_bounds(const DesignProblem& problem, double gap, DesignRecord& record) {
  if (record.status == Status::failed) return;
  DesignReport r = problem.report(record.parameters);
  try {
    record.certified = verify_volume(problem, r, gap, stop_requested);
    check_stop();  // throws if the run is stopped, because bounds of an interrupted computation are discarded
  } catch (const std::invalid_argument& reason) {
    r.status = Status::failed;
    r.reason = reason.what();
  } catch (const Stopped&) {
    record.certified.reset();
    throw;
  }
  if (r.status != Status::failed) return;
  record.status = r.status;
  record.reason = r.reason + (record.reason.empty() ? "" : "; ") + record.reason;
}

DesignRecord evaluate_design_after_rounding(const DesignProblem& problem, const std::vector<double>& parameters) {
  const ProblemParts& parts = problem.parts();
  if (const Unsupported refusal = parts.mechanism->refuse(parameters)) {
    const auto undefined = [](std::size_t size) {
      return std::vector<double>(size, std::numeric_limits<double>::quiet_NaN());
    };
    return {.parameters = parameters,
            .objectives = undefined(problem.objectives().size()),
            .margins = undefined(problem.margins().size()),
            .reports = undefined(problem.reports().size()),
            .status = Status::failed,
            .reason = *refusal};
  }
  DesignRecord record = evaluate_design(problem, parameters);
  for (std::size_t i = 0; i < parts.varies.size(); ++i) {
    const Variable& v = parts.space[i];
    const double value = parameters[parts.varies[i]], roundoff = 1e-12 * std::fabs(value);
    if (value >= v.lower - roundoff && value <= v.upper + roundoff) continue;
    record.reason +=
        (record.reason.empty() ? "" : "; ") + v.name + " = " + with_unit(value, v.unit) + " lies outside its bounds";
  }
  return record;
}

}  // namespace pkm
