// User-defined constraint: a formula in the study that must be >= 0, >= min or <= max. A formula that uses only
// parameters, thresholds and the size is evaluated before the workspace analysis, which is skipped if it is violated. A
// formula that uses results of the workspace analysis is evaluated after it.
#include "engine/problem/expression.hpp"

#include <optional>

#include "constraints/list.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

struct Bounds {
  std::optional<double> max;
  double min = 0;  ///< lower bound of the formula; used if there is no upper bound
};

Bounds bounds(const Options& options) {
  if (options.has("min") && options.has("max"))
    throw std::invalid_argument(
        "found both min and max; give one of them, and write a second [[constraint]] for the other");
  Bounds bounds;
  if (options.has("max")) bounds.max = options.number("max");
  if (options.has("min")) bounds.min = options.number("min");
  return bounds;
}

std::vector<OptionSpec> bounded_expression_options(const MechanismInfo&) {
  auto specs = expression_options();
  specs.push_back({.name = "min", .unit = kUnitOfEntry, .meaning = "minimum allowed value; default without max: 0"});
  specs.push_back({.name = "max", .unit = kUnitOfEntry, .meaning = "maximum allowed value"});
  return specs;
}

std::string detail(const EntryContext& context) {
  const auto [max, min] = bounds(context.options);
  const std::string& unit = context.options.word("unit");
  return expression_text(context) + (max ? " <= " + with_unit(*max, unit) : " >= " + with_unit(min, unit));
}

std::unique_ptr<const Quantity> make_expression(const EntryContext& context) {
  return make_quantity([expression = Expression(context), bounds = bounds(context.options)](const auto& design) {
    const auto value = expression.value(design);
    return bounds.max ? *bounds.max - value : value - bounds.min;
  });
}

}  // namespace

ConstraintEntry expression_constraint() {
  return {
      .name = "expression",
      .meaning = "a formula of parameters, thresholds and results of the workspace analysis is >= 0, or min, or <= max",
      .options = bounded_expression_options,
      .unit = expression_unit,
      .make = make_expression,
      .needs_workspace = [](const EntryContext& context) { return Expression(context).needs_workspace(); },
      .request = [](const EntryContext& context,
                    FieldRequest& request) { Expression(context).add_request(context, request); },
      .detail = detail,
  };
}

}  // namespace pkm
