// Inverse condition number of the Jacobian (angular column divided by a characteristic length) over the workspace.
//
// The mean converges with the grid. The minimum tends to 0 unless the singularity margins are positive, and is the
// least over the samples: cell centres or quadrature nodes. Both are 0 for an empty workspace. Gradient solvers see
// the minimum through a smooth lower end of the samples (soft_least).
#include "engine/math/statistics.hpp"
#include "engine/problem/conditioning_options.hpp"
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
              characteristic_length_option(),
              sharpness_option("min"),
          },
      .unit = [](const EntryContext&) { return std::string("1"); },
      .refusal =
          [](const Mechanism& mechanism) {
            return has_jacobian(mechanism) ? std::string()
                                           : "objective conditioning needs a Jacobian, and mechanism " +
                                                 mechanism.info().name + " gives none";
          },
      .demand = demand_conditioning,
      .make =
          [](const EntryContext& context) {
            if (context.options.word("statistic") == "min")
              return make_quantity([](const auto& design) { return least(design.survey->conditioning); },
                                   [sharpness = context.options.number("sharpness")](const auto& design) {
                                     return soft_least(design.survey->weight, design.survey->conditioning, sharpness);
                                   });
            return make_quantity(
                [](const auto& design) { return weighted_mean(design.survey->weight, design.survey->conditioning); });
          },
  };
}

}  // namespace pkm
