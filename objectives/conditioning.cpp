// Inverse condition number of the Jacobian (angular column divided by a characteristic length) over the workspace.
//
// The mean converges with the grid. The minimum tends to 0 unless the singularity margins are positive, and is the
// least over the samples: cell centres or quadrature nodes. Both are 0 for an empty workspace.
#include "engine/math/statistics.hpp"
#include "objectives/list.hpp"

namespace pkm {

ObjectiveEntry conditioning() {
  return {
      .name = "conditioning",
      .meaning = "inverse condition number of the Jacobian over the workspace, in [0, 1]",
      .direction = Direction::maximise,
      .options =
          {
              {.name = "statistic",
               .kind = OptionKind::word,
               .initial = std::string("mean"),
               .choices = {"mean", "min"},
               .meaning = "mean over the workspace, or the worst pose"},
              {.name = "characteristic_length",
               .kind = OptionKind::number,
               .unit = "m",
               .lower = 1e-6,
               .upper = 1e6,
               .meaning = "length that the angular column is divided by; default: the mechanism's own"},
          },
      .unit = [](const EntryContext&) { return std::string("1"); },
      .refusal =
          [](const MechanismInfo& mechanism) {
            return mechanism.characteristic_length.empty()
                       ? "objective conditioning needs a Jacobian, and mechanism " + mechanism.name + " gives none"
                       : std::string();
          },
      .demand =
          [](const EntryContext& context, Demand& demand) {
            demand.conditioning = true;
            if (context.options.has("characteristic_length"))
              demand.characteristic_length = context.options.number("characteristic_length");
          },
      .make =
          [](const EntryContext& context) {
            if (context.options.word("statistic") == "min")
              return make_quantity([](const auto& design) { return least(design.survey->conditioning); });
            return make_quantity(
                [](const auto& design) { return weighted_mean(design.survey->weight, design.survey->conditioning); });
          },
  };
}

}  // namespace pkm
