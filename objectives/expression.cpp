// A formula that the study writes itself. What takes the objective as a constraint is constraints/expression.cpp.
#include "engine/problem/expression.hpp"

#include "objectives/list.hpp"

namespace pkm {

ObjectiveEntry expression_objective() {
  return {
      .name = "expression",
      .meaning = "a formula of parameters, thresholds and results of the survey",
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
      .needs_survey = [](const EntryContext& context) { return Expression(context).needs_survey(); },
  };
}

}  // namespace pkm
