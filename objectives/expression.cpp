// User-defined objective, given as a formula in the study. The constraint of that type is constraints/expression.cpp.
#include "engine/problem/expression.hpp"

#include "objectives/list.hpp"

namespace pkm {

ObjectiveEntry expression_objective() {
  return {
      .name = "expression",
      .meaning = "a formula of parameters, thresholds and results of the workspace analysis",
      .direction = Direction::maximise,
      .options = expression_options(),
      .unit = expression_unit,
      .demand = [](const EntryContext& context, Demand& demand) { Expression(context).add_demand(context, demand); },
      .make =
          [](const EntryContext& context) {
            return make_quantity(
                [expression = Expression(context)](const auto& design) { return expression.value(design); });
          },
      .detail = expression_text,
      .needs_workspace = [](const EntryContext& context) { return Expression(context).needs_workspace(); },
  };
}

}  // namespace pkm
