// Readers of [inputs] and [[quantity]]: named formulas of the design, the pose and its motion.

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/expression/derivative.hpp"

namespace pkm {
namespace {

using expression::Node;
using generic::Inputs;

/// Names that the output and the formulas of studies use already.
const std::vector<std::string> kTaken = {"conditioning", "dci",  "inertia_condition", "volume", "clearance",
                                         "det_Jq",       "det_G"};

/// A coordinate or an extra input: its value, rate and acceleration are inputs of the graph.
struct Moving {
  std::string name;
  Node value, rate, acceleration;
};

/// The coordinates and the extra inputs.
std::vector<Moving> moving_inputs(generic::Model& model) {
  const Inputs& at = model.inputs;
  std::vector<Moving> all;
  for (std::size_t i = 0; i < at.coordinates; ++i)
    all.push_back({model.info.coordinates[i].name, model.graph.input(at.coordinate(i), Inputs::coordinate_group(i)),
                   model.graph.input(at.rate(i), Inputs::kRates),
                   model.graph.input(at.acceleration(i), Inputs::kRates)});
  for (std::size_t i = 0; i < at.extras; ++i)
    all.push_back({model.info.inputs[i].name, model.graph.input(at.extra(i), Inputs::kExtras),
                   model.graph.input(at.extra_rate(i), Inputs::kRates),
                   model.graph.input(at.extra_acceleration(i), Inputs::kRates)});
  return all;
}

}  // namespace

void read_inputs(const ConfigValue& root, MechanismDraft& draft) {
  const auto all = root.find_table("inputs");
  if (!all) return;
  generic::Model& model = draft.model;
  for (const std::string& name : all->keys()) {
    const ConfigValue table = *all->find_table(name);
    if (model.inputs.extras == Inputs::kMaxExtras)
      throw table.refusal("a mechanism has at most " + std::to_string(Inputs::kMaxExtras) + " inputs");
    const std::string unit = si_unit(table.at("unit", "the input's unit: \"rad\", \"m\", \"1\""));
    model.info.inputs.push_back(
        {name, unit, text_of(table, "meaning"), table.find_number("default", unit).value_or(0)});
    draft.scope.add(table, name, model.graph.input(model.inputs.extra(model.inputs.extras++), Inputs::kExtras));
  }
}

void read_quantities(const ConfigValue& root, MechanismDraft& draft) {
  const auto tables = root.tables("quantity");
  if (tables.empty()) return;
  generic::Model& model = draft.model;
  const std::vector<Moving> moving = moving_inputs(model);
  expression::Rates rates(model.graph);
  for (const Moving& each : moving) {
    rates.set_rate(each.value, each.rate);
    rates.set_rate(each.rate, each.acceleration);
  }
  const auto add_rate = [&](const ConfigValue& at, const std::string& name, Node node) {
    if (!draft.scope.knows(name + "_rate")) draft.scope.add(at, name + "_rate", rates.of(node).node());
  };
  for (const Moving& each : moving) add_rate(tables.front(), each.name, each.value);
  draft.scope.allow_motion(true);
  for (const ConfigValue& table : tables) {
    const std::string name = new_name(table, "quantity", model.info.quantities, "the quantity's name");
    if (contains(kTaken, name)) throw table.find("name")->refusal("'" + name + "' is a name that every mechanism has");
    const auto given = table.find("unit");
    const std::string unit = given ? si_unit(*given) : "1";
    const Node node = draft.scope.formula(table.at("formula", "a formula"), unit, name).node();
    const expression::Groups groups = model.graph[node].groups;
    draft.scope.add(table, name, node);
    add_rate(table, name, node);
    model.quantities.push_back(node);
    model.info.quantities.push_back({.name = name,
                                     .unit = unit,
                                     .meaning = text_of(table, "meaning"),
                                     .of_design = (groups & ~Inputs::kDesign) == 0,
                                     .of_motion = (groups & (Inputs::kExtras | Inputs::kRates)) != 0});
  }
  draft.scope.allow_motion(false);
}

}  // namespace pkm
