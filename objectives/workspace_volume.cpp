// Workspace volume: the measure of the set of feasible poses in the swept coordinates.
#include <algorithm>

#include "objectives/list.hpp"

namespace pkm {
namespace {

/// Possible values of the volume: from 0 to the volume of the study's box, if there is one and no fixed coordinate is
/// integrated over.
Range range_of(const EntryContext& context) {
  Range range{.lower = 0};
  const WorkspacePlan& plan = context.plan;
  const auto integrated = [](const FixedCoordinate& fixed) { return fixed.kind == FixedCoordinate::Kind::integrated; };
  if (!plan.box() || std::ranges::any_of(plan.fixed, integrated)) return range;
  range.upper = 1;
  for (const auto& [lower, upper] : *plan.box()) range.upper *= upper - lower;
  return range;
}

}  // namespace

ObjectiveEntry workspace_volume() {
  return {
      .name = "workspace-volume",
      .meaning = "measure of the feasible poses over the swept coordinates",
      .direction = Direction::maximise,
      .unit = [](const EntryContext& context) { return volume_unit(context.mechanism.info(), context.plan); },
      .make =
          [](const EntryContext&) {
            return make_quantity([](const auto& design) { return design.workspace->volume; });
          },
      .range = range_of,
  };
}

}  // namespace pkm
