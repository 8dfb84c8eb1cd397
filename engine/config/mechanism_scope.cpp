#include "engine/config/mechanism_scope.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/expression/formula_lexer.hpp"
#include "engine/expression/formula_parser.hpp"
#include "engine/expression/program.hpp"

namespace pkm {

using expression::Node, limbs::Term, limbs::Vector3;

void MechanismScope::add(const ConfigValue& at, const std::string& name, Node node) {
  if (!expression::may_be_name(name))
    throw at.refusal(
        "'" + name +
        "' is not a valid name in formulas; expected letters, digits and '_', not beginning with a digit, and no "
        "function or pi");
  if (const auto known = names_.find(name))
    throw at.refusal("'" + name + "' is already the name of " + origins_[*known]);
  names_.add(name);
  origins_.push_back(at.place().key + " (" + at.line() + ")");
  nodes_.push_back(node);
}

void MechanismScope::replace(const std::string& name, Node node) { nodes_[names_.find(name).value()] = node; }

bool MechanismScope::knows(const std::string& name) const { return names_.find(name).has_value(); }

Term MechanismScope::formula(const ConfigValue& value, const std::string& unit, const std::string& what) {
  value.expect_formula(unit);
  if (!value.is_text()) return model_.term(model_.graph.number(value.number(unit)));
  const std::string& text = value.text("a number or a formula");
  if (const auto number = parse_quantity(text, unit)) return model_.term(model_.graph.number(*number));
  if (const std::string kind = kind_of_quantity(text); !kind.empty())
    throw value.error_of('"' + text + "\", " + kind, kind_of_unit(unit) + ", or a formula: " + quantity_hint(unit));
  const Node node = value.explained([&] { return expression::read_formula(model_.graph, text, names_, nodes_); });
  if (!motion_allowed_ && (model_.graph[node].groups & (generic::Inputs::kExtras | generic::Inputs::kRates)) != 0)
    throw value.refusal("only the formula of a [[quantity]] may depend on [inputs] or rates");
  register_partial_operations(node, what);
  return model_.term(node);
}

Term MechanismScope::of_design(const ConfigValue& value, const std::string& unit, const std::string& what) {
  const Term term = formula(value, unit, what);
  std::vector<std::string> moving;
  for (std::size_t i = 0; i < model_.info.coordinates.size(); ++i)
    if (model_.graph[term.node()].groups & generic::Inputs::coordinate_group(i))
      moving.push_back("'" + model_.info.coordinates[i].name + "'");
  if (!moving.empty()) throw value.error("a formula of parameters only, which does not depend on " + join(moving));
  return term;
}

Term MechanismScope::positive(const ConfigValue& value, const std::string& unit, const std::string& what,
                              bool may_vanish) {
  const Term term = of_design(value, unit, what);
  const auto& node = model_.graph[term.node()];
  if (node.is_number() && !(node.number > 0 || (may_vanish && node.number == 0)))
    throw value.error((may_vanish ? "a number >= " : "a number > ") + with_unit(0, unit));
  return term;
}

namespace {

constexpr const char* kPoint = "three numbers or formulas [x, y, z]";
constexpr const char* kDirection = "a direction, three numbers or formulas [x, y, z] that are not all 0";

/// Reads [x, y, z], each element by `read`.
template <class Read>
Vector3 three(const ConfigValue& value, const char* expected, const Read& read) {
  const std::vector<ConfigValue> elements = value.elements(expected);
  if (elements.size() != 3) throw value.error(expected);
  return {read(elements[0]), read(elements[1]), read(elements[2])};
}

}  // namespace

Vector3 MechanismScope::point(const ConfigValue& value, const std::string& what) {
  return three(value, kPoint, [&](const ConfigValue& each) { return formula(each, "m", what); });
}

Vector3 MechanismScope::point_of_design(const ConfigValue& value, const std::string& what) {
  return three(value, kPoint, [&](const ConfigValue& each) { return of_design(each, "m", what); });
}

Vector3 MechanismScope::direction(const ConfigValue& value, const std::string& what) {
  const Vector3 v = three(value, kDirection, [&](const ConfigValue& each) { return of_design(each, "1", what); });
  const Term length = limbs::length(v);
  if (!(at_default(length) > 0)) throw value.error(kDirection);
  mark_as_defined(length.node());
  return v / length;
}

double MechanismScope::at_default(const Term& term) const {
  const expression::Node node = term.node();
  const expression::Program program(model_.graph, {&node, 1});
  std::vector<double> inputs(model_.inputs.count(), 1), registers;
  for (std::size_t i = 0; i < model_.info.parameters.size(); ++i) inputs[i] = model_.info.parameters[i].nominal;
  for (std::size_t i = 0; i < model_.inputs.limits; ++i)
    inputs[model_.inputs.limit(i)] = model_.info.limits[i].inactive;
  for (std::size_t i = 0; i < model_.info.coordinates.size(); ++i)  // an arbitrary, generic pose
    inputs[model_.inputs.coordinate(i)] = 0.37 + 0.11 * static_cast<double>(i);
  program.run_all<double>(inputs, registers);
  return registers[program.outputs().front()];
}

void MechanismScope::refuse_empty(const ConfigValue& range, const Term& from, const Term& to) const {
  const double least = at_default(from), greatest = at_default(to);
  if (least > greatest)
    throw range.error("[minimum, maximum] with minimum <= maximum; for the default parameters it is [" +
                      shortest(least) + ", " + shortest(greatest) + "]");
}

std::vector<Node> MechanismScope::unvisited_nodes(Node root) const {
  return model_.graph.reachable({&root, 1}, [&](Node each) { return visited_.contains(each); });
}

void MechanismScope::mark_as_defined(Node node) {
  for (const Node each : unvisited_nodes(node)) visited_.insert(each);
}

void MechanismScope::register_partial_operations(Node root, const std::string& what) {
  const auto has_domain = [](const expression::Operation* operation) {
    return operation && (operation->name == "sqrt" || operation->name == "asin" || operation->name == "acos" ||
                         operation->name == "log" || operation->name == "log10");
  };
  int count = 0;
  for (const Node node : unvisited_nodes(root)) {
    visited_.insert(node);
    if (has_domain(model_.graph[node].operation))
      partial_operations_.push_back(
          {node, what, what + (++count > 1 ? " exists (" + std::to_string(count) + ")" : " exists")});
  }
}

void MechanismScope::add_domains() {
  std::vector<Node> used = model_.joints, limited;
  for (const generic::Result& margin : model_.margins) {
    const LimitInfo* const limit = find_named(model_.info.limits, margin.name);
    (limit && limit->group == kQuantityLimit ? limited : used).push_back(margin.node);
  }
  const std::vector<Node> reachable = model_.graph.reachable(used), of_limits = model_.graph.reachable(limited);
  std::vector<std::vector<Node>> of_joints;
  for (const Node& joint : model_.joints) of_joints.push_back(model_.graph.reachable({&joint, 1}));
  for (const auto& [node, what, name] : partial_operations_) {
    const bool is_needed = std::ranges::binary_search(reachable, node);
    if (!is_needed && !std::ranges::binary_search(of_limits, node)) continue;
    std::string consequence = what + " has no real value";
    for (std::size_t i = of_joints.size(); i-- > 0;)
      if (std::ranges::binary_search(of_joints[i], node))
        consequence = what + " has no real value, so " + model_.info.joints[i].name + " is undefined";
    const expression::Entry entry = model_.graph[node];
    const Term argument = model_.term(entry.arguments[0]), one(model_.graph, 1.0);
    const bool of_circle = entry.operation->name == "asin" || entry.operation->name == "acos";
    // The mechanism may be assembled at a pose where a limited quantity is undefined.
    (is_needed ? model_.domains : model_.margins)
        .push_back({name, "", (of_circle ? one - abs(argument) : argument).node(), consequence});
  }
}

}  // namespace pkm
