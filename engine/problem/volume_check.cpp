#include "engine/problem/volume_check.hpp"

#include "engine/core/unit.hpp"

namespace pkm {

VolumeBounds verify_volume(const DesignProblem& problem, DesignReport& report, double gap,
                           const std::function<bool()>& stop) {
  // Rounding errors of closed forms, relative to the volume; the error estimate does not include them.
  constexpr double kRoundoff = 1e-9;
  const ProblemParts& parts = problem.of(report.parameters).parts();
  const VolumeBounds bounds =
      parts.mechanism->bounds()->volume(report.parameters, parts.plan, parts.request.mode, {.gap = gap, .stop = stop});
  const double volume = report.workspace.volume, error = (report.workspace.error + kRoundoff) * volume;
  if (bounds.lower <= volume + error && bounds.upper >= volume - error) return bounds;
  const std::string unit = volume_unit(parts.mechanism->info(), parts.plan);
  report.status = Status::failed;
  report.reason = "the volume by columns, " + with_unit(volume, unit) + ", lies outside its certified bounds, " +
                  with_unit(bounds.lower, unit) + " to " + with_unit(bounds.upper, unit) + ": " +
                  (volume < bounds.lower ? "a part of the workspace was missed" : "infeasible poses were included");
  return bounds;
}

}  // namespace pkm
