// The measure of the feasible set of poses, as the survey found it.
#include "objectives/list.hpp"

namespace pkm {

ObjectiveEntry workspace_volume() {
  return {
      .name = "workspace-volume",
      .meaning = "measure of the feasible poses over the swept coordinates",
      .direction = Direction::maximise,
      .unit = [](const EntryContext& context) { return volume_unit(context.mechanism.info(), context.plan); },
      .make =
          [](const EntryContext&) { return make_quantity([](const auto& design) { return design.survey->volume; }); },
  };
}

}  // namespace pkm
