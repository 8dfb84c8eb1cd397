// Reads [inputs], [[quantity]] (named formulas of the design, the pose and its motion), and the limits that a study
// sets for quantities.

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {
namespace {

using expression::Node;
using generic::Inputs;

/// Names that a quantity must not have, because the program's output, fields of workspaces or formulas of studies use
/// these names.
const std::vector<std::string> kTaken = {"conditioning", "dci",    "dci_worst", "inertia_condition", "volume",
                                         "clearance",    "det_Jq", "det_G",     "feasible",          "margin"};

// Threshold that stands for "no limit": no value of a quantity violates it, whatever its unit.
constexpr double kNoLimit = 1e30;

/// A coordinate or an input of [inputs], with its value, rate and acceleration as inputs of the expression graph.
struct Moving {
  std::string name;
  Node value, rate, acceleration;
};

/// All coordinates and all inputs of [inputs], with the nodes of their values, rates and accelerations.
std::vector<Moving> moving_inputs(generic::Model& model) {
  const Inputs& at = model.inputs;
  std::vector<Moving> all;
  for (std::size_t i = 0; i < at.coordinates; ++i)
    all.push_back({model.info.coordinates[i].name, model.coordinate(i), model.graph.input(at.rate(i), Inputs::kRates),
                   model.graph.input(at.acceleration(i), Inputs::kRates)});
  for (std::size_t i = 0; i < at.extras; ++i)
    all.push_back({model.info.inputs[i].name, model.graph.input(at.extra(i), Inputs::kExtras),
                   model.graph.input(at.extra_rate(i), Inputs::kRates),
                   model.graph.input(at.extra_acceleration(i), Inputs::kRates)});
  return all;
}

std::string limit_name(const std::string& quantity, const std::string& side) { return quantity + "_" + side; }

/// Calls visit(name, side, value) for each limit that a study sets for a quantity; `side` is "min" or "max".
template <class Visit>
void visit_quantity_limits(const ConfigValue& study, const MechanismInfo& info, const Visit& visit) {
  const auto limits = limits_of_quantities(study);
  if (!limits) return;
  for (const std::string& name : limits->keys()) {
    const ConfigValue sides = *limits->find(name);
    if (!sides.is_table() || find_named(info.limits, name)) continue;
    for (const std::string& side : sides.keys())
      if (side == "min" || side == "max") visit(name, side, *sides.find(side));
  }
}

/// The margin of a limit: value - threshold for a minimum, threshold - value for a maximum. If the value is itself a
/// minimum or maximum, this operation is moved outwards, min(a, b) - t = min(a - t, b - t), so that the polynomial
/// normal form can eliminate it.
/// @param most  maximum number of minima and maxima that are moved outwards; decreased by one for each of them
Node margin_of(expression::Graph& graph, Node value, Node threshold, bool is_minimum, int& most) {
  const expression::Entry entry = graph[value];
  const auto is = [&](expression::Code code) { return entry.operation && entry.operation->code == code; };
  const bool is_min = is(expression::Code::min);
  if ((is_min || is(expression::Code::max)) && most-- > 0) {
    const Node first = margin_of(graph, entry.arguments[0], threshold, is_minimum, most),
               second = margin_of(graph, entry.arguments[1], threshold, is_minimum, most);
    return graph.apply(expression::operation(is_min == is_minimum ? "min" : "max"), std::array{first, second});
  }
  const limbs::Term left(graph, is_minimum ? value : threshold), right(graph, is_minimum ? threshold : value);
  return (left - right).node();
}

}  // namespace

std::optional<ConfigValue> limits_of_quantities(const ConfigValue& study) {
  const auto workspace = study.find("workspace");
  if (!workspace || !workspace->is_table()) return {};
  const auto limits = workspace->find("limits");
  const auto is_quantity = [&](const std::string& name) { return limits->find(name)->is_table(); };
  return limits && limits->is_table() && std::ranges::any_of(limits->keys(), is_quantity) ? limits : std::nullopt;
}

bool defines_quantity(const ConfigValue& root, const ConfigValue* study, const std::string& name) {
  const auto has = [&](const ConfigValue& file) {
    return std::ranges::any_of(file.tables("quantity"), [&](const ConfigValue& table) {
      const auto own = table.find("name");
      return own && own->text("the quantity's name") == name;
    });
  };
  return has(root) || (study && has(*study));
}

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

void read_quantities(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft) {
  auto tables = root.tables("quantity");
  if (study) std::ranges::copy(study->tables("quantity"), std::back_inserter(tables));
  generic::Model& model = draft.model;
  for (const generic::DependentCoordinate& each : model.dependent) {
    const std::string meaning = "dependent coordinate, " + each.kind;
    const auto of_pose = formula_quantity(each.name, each.unit, meaning, model.quantities.size());
    model.quantities.push_back(each.node);
    model.info.quantities.push_back({.name = each.name, .unit = each.unit, .meaning = meaning, .of_pose = of_pose});
  }
  if (tables.empty()) return;
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
  for (const generic::DependentCoordinate& each : model.dependent) add_rate(tables.front(), each.name, each.node);
  draft.scope.allow_motion(true);
  for (const ConfigValue& table : tables) {
    const std::string name = new_name(table, "quantity", model.info.quantities, "the quantity's name");
    if (contains(kTaken, name))
      throw table.find("name")->refusal("'" + name + "' is a predefined name of every mechanism");
    const auto given = table.find("unit");
    const std::string unit = given ? si_unit(*given) : "1";
    const Node node = draft.scope.formula(table.at("formula", "a formula"), unit, name).node();
    const expression::Groups groups = model.graph[node].groups;
    draft.scope.add(table, name, node);
    add_rate(table, name, node);
    const bool of_design = (groups & ~Inputs::kDesign) == 0, of_rates = (groups & Inputs::kRates) != 0;
    const std::string meaning = text_of(table, "meaning");
    const auto of_pose =
        of_design || of_rates ? nullptr : formula_quantity(name, unit, meaning, model.quantities.size());
    model.quantities.push_back(node);
    model.info.quantities.push_back({.name = name,
                                     .unit = unit,
                                     .meaning = meaning,
                                     .of_design = of_design,
                                     .of_motion = of_rates || (groups & Inputs::kExtras) != 0,
                                     .of_pose = of_pose});
  }
  draft.scope.allow_motion(false);
}

void read_quantity_limits(const ConfigValue& study, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  visit_quantity_limits(
      study, model.info, [&](const std::string& name, const std::string& side, const ConfigValue& at) {
        const std::string limit = limit_name(name, side);
        const double none = side == "min" ? -kNoLimit : kNoLimit;
        const Node threshold = model.graph.input(model.inputs.limit(model.inputs.limits++), Inputs::kDesign);
        draft.scope.add(at, limit, threshold);
        model.info.limits.push_back({.name = limit,
                                     .unit = "1",
                                     .inactive = none,
                                     .lower = -kNoLimit,
                                     .upper = kNoLimit,
                                     .group = kQuantityLimit,
                                     .derivation = "",
                                     .meaning = side == "min" ? "minimum of " + name : "maximum of " + name});
        model.limit_parameters.emplace_back();
        model.derived.emplace_back();
      });
}

void add_quantity_margins(const ConfigValue& study, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  visit_quantity_limits(
      study, model.info, [&](const std::string& name, const std::string& side, const ConfigValue& at) {
        const PoseQuantity* const quantity = at.explained([&] { return &pose_quantity_called(model.info, name); });
        if (quantity->needs_inertia())
          throw at.refusal(name +
                           " depends on the inertia, so it cannot restrict a workspace; constrain a statistic of it, " +
                           "or limit a [[quantity]] with a formula");
        const auto limit = std::ranges::find(model.info.limits, limit_name(name, side), &LimitInfo::name);
        limit->unit = quantity->unit;
        const auto i = static_cast<std::size_t>(limit - model.info.limits.begin());
        if (!quantity->formula) {
          model.report_limits.push_back({quantity, i, side == "min"});
          return;
        }
        const Node value = model.quantities[*quantity->formula];
        const Node threshold = model.graph.input(model.inputs.limit(i), Inputs::kDesign);
        int most = 100;
        model.margins.push_back(
            {limit->name, quantity->unit, margin_of(model.graph, value, threshold, side == "min", most)});
      });
}

}  // namespace pkm
