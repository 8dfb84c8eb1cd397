// Inverse condition number of the joint-space inertia M_q over the workspace: 1 where every joint feels the same mass
// and none couples. All entries of M_q are in kg, so it is free of units. 0 for an empty workspace.
#include "engine/math/statistics.hpp"
#include "engine/problem/conditioning_options.hpp"
#include "engine/problem/inertia_options.hpp"
#include "objectives/list.hpp"

namespace pkm {

ObjectiveEntry inertia_condition_objective() {
  return {
      .name = "inertia-condition",
      .meaning = "inverse condition number of the joint-space inertia over the workspace, in [0, 1]",
      .direction = Direction::maximise,
      .options = {{.name = "statistic",
                   .kind = OptionKind::word,
                   .initial = std::string("mean"),
                   .choices = {"mean", "min"},
                   .meaning = "mean over the workspace, or the worst pose"},
                  mode_option(),
                  sharpness_option("min")},
      .unit = [](const EntryContext&) { return std::string("1"); },
      .refusal = [](const Mechanism& mechanism) { return refuse_without_dynamics("inertia-condition", mechanism); },
      .demand =
          [](const EntryContext& context, Demand& demand) {
            demand.inertia_condition = true;
            demand.mode = mode_of(context);
          },
      .make =
          [](const EntryContext& context) {
            if (context.options.word("statistic") == "min")
              return make_quantity([](const auto& design) { return least(design.survey->inertia_condition); },
                                   [sharpness = context.options.number("sharpness")](const auto& design) {
                                     const auto& survey = *design.survey;
                                     return soft_least(survey.weight, survey.inertia_condition, sharpness);
                                   });
            return make_quantity([](const auto& design) {
              return weighted_mean(design.survey->weight, design.survey->inertia_condition);
            });
          },
  };
}

}  // namespace pkm
