// Linear inequality constraint on the parameters: sum of coefficient * parameter <= bound. The margin is the bound
// minus the sum, in the unit of the parameters.
#include "constraints/list.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

/// The coefficients in the order of the mechanism's parameters. Throws std::invalid_argument for unknown names and for
/// an empty table.
std::vector<double> coefficients(const EntryContext& context) {
  const auto& parameters = context.mechanism.info().parameters;
  const NamedNumbers& given = context.options.numbers("coefficients");
  if (given.empty()) throw std::invalid_argument("coefficients = {} is empty; expected at least one parameter");
  std::vector<double> values(parameters.size(), 0.0);
  for (const auto& [name, coefficient] : given) {
    const Parameter* const parameter = find_named(parameters, name);
    if (!parameter)
      throw std::invalid_argument("coefficient of '" + name + "', which is not a parameter of mechanism " +
                                  context.mechanism.info().name + "; expected one of " + join(names_of(parameters)) +
                                  did_you_mean(name, names_of(parameters)));
    values[static_cast<std::size_t>(parameter - parameters.data())] = coefficient;
  }
  return values;
}

std::unique_ptr<const Quantity> make_linear(const EntryContext& context) {
  return make_quantity(
      [coefficient = coefficients(context), bound = context.options.number("bound")](const auto& design) {
        auto margin = design.parameters[0] * 0.0 + bound;
        for (std::size_t i = 0; i < coefficient.size(); ++i) margin = margin - design.parameters[i] * coefficient[i];
        return margin;
      });
}

/// The common unit of the parameters that have a coefficient; "1" if their units differ.
std::string unit(const EntryContext& context) {
  coefficients(context);  // rejects unknown names before the bound is read in the unit
  std::string shared;
  for (const auto& parameter : context.mechanism.info().parameters) {
    if (!context.options.numbers("coefficients").contains(parameter.name)) continue;
    if (!shared.empty() && shared != parameter.unit) return "1";
    shared = parameter.unit;
  }
  return shared;
}

}  // namespace

ConstraintEntry linear() {
  return {
      .name = "linear",
      .meaning = "sum of coefficient * parameter <= bound",
      .options =
          [](const MechanismInfo&) {
            return std::vector<OptionSpec>{
                {.name = "coefficients",
                 .kind = OptionKind::named_numbers,
                 .required = true,
                 .meaning = "one number for each parameter in the sum, such as { a = 1, b = -1 }"},
                {.name = "bound",
                 .unit = kUnitOfEntry,
                 .initial = 0.0,
                 .meaning = "maximum of the sum, in the common unit of the parameters"},
            };
          },
      .unit = unit,
      .make = make_linear,
  };
}

}  // namespace pkm
