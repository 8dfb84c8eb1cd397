// A formula that the study writes itself and that must be >= 0, >= min or <= max. One of parameters, thresholds and
// size alone is computed before the survey and may save it; one that names results of the survey is computed after it.
#include "engine/problem/expression.hpp"

#include <optional>

#include "constraints/list.hpp"
#include "engine/core/unit.hpp"

namespace pkm {
namespace {

struct Bounds {
  std::optional<double> greatest;
  double least = 0;
};

Bounds bounds(const Options& options) {
  if (options.has("min") && options.has("max"))
    throw std::invalid_argument(
        "found both min and max; a constraint has one of them (write two [[constraint]] tables)");
  Bounds bounds;
  if (options.has("max")) bounds.greatest = options.number("max");
  if (options.has("min")) bounds.least = options.number("min");
  return bounds;
}

std::vector<OptionSpec> options(const MechanismInfo&) {
  auto specs = expression_options();
  specs.push_back({.name = "min", .unit = kUnitOfEntry, .meaning = "least value allowed; default without max: 0"});
  specs.push_back({.name = "max", .unit = kUnitOfEntry, .meaning = "greatest value allowed"});
  return specs;
}

std::string detail(const EntryContext& context) {
  const auto [greatest, least] = bounds(context.options);
  const std::string& unit = context.options.word("unit");
  return expression_text(context) + (greatest ? " <= " + with_unit(*greatest, unit) : " >= " + with_unit(least, unit));
}

std::unique_ptr<const Quantity> make(const EntryContext& context) {
  return make_quantity([expression = Expression(context), bounds = bounds(context.options)](const auto& design) {
    const auto value = expression.value(design);
    return bounds.greatest ? *bounds.greatest - value : value - bounds.least;
  });
}

}  // namespace

ConstraintEntry expression_constraint() {
  return {
      .name = "expression",
      .meaning = "a formula of parameters, thresholds and results of the survey is >= 0, or min, or <= max",
      .options = options,
      .unit = expression_unit,
      .make = make,
      .needs_survey = [](const EntryContext& context) { return Expression(context).needs_survey(); },
      .demand = [](const EntryContext& context, Demand& demand) { Expression(context).add_demand(context, demand); },
      .detail = detail,
  };
}

}  // namespace pkm
