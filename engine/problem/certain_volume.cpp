#include "engine/problem/certain_volume.hpp"

#include "engine/core/unit.hpp"

namespace pkm {

VolumeBounds check_volume(const DesignProblem& problem, DesignReport& report, double gap,
                          const std::function<bool()>& stop) {
  constexpr double kRoundoff = 1e-9;  // of closed forms, beside the estimate
  const ProblemParts& parts = problem.parts();
  const VolumeBounds bounds =
      parts.mechanism->bounds()->volume(report.parameters, parts.plan, parts.demand.mode, {.gap = gap, .stop = stop});
  const double volume = report.survey.volume, error = (report.survey.error + kRoundoff) * volume;
  if (bounds.lower <= volume + error && bounds.upper >= volume - error) return bounds;
  const std::string unit = volume_unit(parts.mechanism->info(), parts.plan);
  report.status = Status::failed;
  report.reason = "the exact volume, " + with_unit(volume, unit) + ", lies outside of its certain bounds, " +
                  with_unit(bounds.lower, unit) + " to " + with_unit(bounds.upper, unit) + ": columns have " +
                  (volume < bounds.lower ? "overlooked" : "added") + " a part of this workspace";
  return bounds;
}

}  // namespace pkm
