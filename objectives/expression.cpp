// User-defined objective, given as a formula in the study. The constraint of the same type is defined in
// constraints/expression.cpp.
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
      .request = [](const EntryContext& context,
                    FieldRequest& request) { Expression(context).add_request(context, request); },
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
