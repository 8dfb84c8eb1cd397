// Reads the tables [[limit]] (thresholds that a study can set), [[margin]] (constraints on poses) and [[design]]
// (constraints on designs).

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/unit.hpp"

namespace pkm {

using generic::Inputs;
using limbs::Term;

void read_limits(const ConfigValue& root, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  for (const ConfigValue& table : root.tables("limit")) {
    LimitInfo limit;
    limit.name = table.at("name", "the limit's name").text("the limit's name");
    const Parameter* const parameter = find_named(model.info.parameters, limit.name);
    if (limit.name == generic::kClearanceLimit)
      throw table.find("name")->refusal(
          "clearance_min is predefined: every mechanism whose links are tested for clearance has this limit");
    if (find_named(model.info.limits, limit.name))
      throw table.find("name")->refusal("there is already a limit called '" + limit.name + "'");
    for (const OwnParameter& own : draft.own)
      if (parameter && own.parameter == limit.name)
        throw ConfigError(own.place, own.name() + " cannot differ from limb to limb, because " + limit.name +
                                         " is a limit of the whole mechanism");
    if (parameter) {
      for (const char* key : {"unit", "inactive", "min", "max", "derived"})
        if (const auto given = table.find(key))
          throw given->refusal(
              "a limit with the name of a parameter takes its unit, default and range from the parameter");
      limit.unit = parameter->unit;
      limit.inactive = parameter->nominal;
      limit.lower = parameter->lower;
      limit.upper = parameter->upper;
      limit.meaning = parameter->meaning;
    } else {
      limit.unit = si_unit(table.at("unit", "the limit's unit: \"m\", \"rad\", \"1\""));
      limit.lower = table.at("min", "the minimum threshold").number(limit.unit);
      limit.upper = table.at("max", "the maximum threshold").number(limit.unit, limit.lower);
      limit.inactive =
          table.at("inactive", "the value that restricts nothing").number(limit.unit, limit.lower, limit.upper);
      limit.derivation = text_of(table, "derived");
    }
    if (table.has("meaning")) limit.meaning = text_of(table, "meaning");
    if (const auto owner = table.find("constraint")) limit.group = owner->word();
    const auto node = model.graph.input(model.inputs.limit(model.inputs.limits++), Inputs::kDesign);
    model.limit_parameters.push_back(
        parameter ? std::optional(static_cast<std::size_t>(parameter - model.info.parameters.data())) : std::nullopt);
    std::optional<expression::Node> derived;
    if (const auto formula = table.find("derived"))
      derived = draft.scope.of_design(*formula, limit.unit, limit.name).node();
    model.derived.push_back(derived);
    parameter ? draft.scope.replace(limit.name, node) : draft.scope.add(table, limit.name, node);
    model.info.limits.push_back(limit);
  }
}

void read_margins(const ConfigValue& root, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const auto name_of = [](const ConfigValue& table, const auto& others) {
    return new_name(table, "margin", others, "a name for the margin");
  };
  const auto unit_of = [](const ConfigValue& table) {
    const auto unit = table.find("unit");
    return unit ? si_unit(*unit) : "1";
  };
  for (const ConfigValue& table : root.tables("margin")) {
    const std::string name = name_of(table, model.margins), unit = unit_of(table);
    constexpr const char* kFormula = "a formula that is >= 0 where the pose is feasible, or a list of such formulas";
    const ConfigValue formula = table.at("formula", kFormula);
    generic::ReportedMargin reported{.name = name, .unit = unit, .first = model.margins.size()};
    const auto formulas = formula.is_list() ? formula.elements(kFormula) : std::vector{formula};
    if (formulas.empty()) throw formula.error(kFormula);
    reported.count = formulas.size();
    for (const ConfigValue& each : formulas)
      model.margins.push_back({name, unit, draft.scope.formula(each, unit, name).node()});
    const auto shown = table.find("shown"), shown_unit = table.find("shown_unit");
    if (shown_unit && !shown) throw shown_unit->refusal("`shown_unit` requires `shown`");
    if (shown_unit) reported.unit = si_unit(*shown_unit);
    if (shown) reported.shown = draft.scope.formula(*shown, reported.unit, name).node();
    if (shown || reported.count > 1) model.reported_margins.push_back(reported);
  }
  for (const ConfigValue& table : root.tables("design")) {
    if (model.tests.size() == kMaxDesignTests)
      throw table.refusal("a mechanism has at most " + std::to_string(kMaxDesignTests) + " tests of the design");
    const std::string name = name_of(table, model.tests), unit = unit_of(table);
    constexpr const char* kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_. ";
    if (name.find_first_not_of(kLetters) != std::string::npos)
      throw table.find("name")->error("a name of letters, digits, blanks, '-', '_' and '.'");
    const ConfigValue formula = table.at("formula", "a formula of parameters that is >= 0 if satisfied");
    if (table.flag_at("required")) {
      model.required.push_back({name, unit, draft.scope.of_design(formula, unit, name).node()});
      continue;
    }
    model.test_nodes.push_back(draft.scope.of_design(formula, unit, name).node());
    const std::string meaning = text_of(table, "meaning");
    model.tests.push_back({name, unit, meaning.empty() && formula.is_text() ? formula.text("a formula") : meaning});
  }
}

}  // namespace pkm
