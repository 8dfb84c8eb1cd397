#include "engine/config/mechanism_scope.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/catalogue.hpp"
#include "engine/core/unit.hpp"
#include "engine/expression/formula_lexer.hpp"
#include "engine/expression/formula_parser.hpp"
#include "engine/expression/program.hpp"

namespace pkm {

using expression::Node, limbs::Term, limbs::Vector3;

void MechanismScope::add(const ConfigValue& at, const std::string& name, const Value& value) {
  if (!expression::may_be_name(name))
    throw at.refusal(
        "'" + name +
        "' is not a valid name in formulas; expected letters, digits and '_', not beginning with a digit, and no "
        "function or pi");
  const std::string origin = at.place().key + " (" + at.line() + ")";
  if (const auto known = names_.find(name)) {
    if (!origins_[*known].empty()) throw at.refusal("'" + name + "' is already the name of " + origins_[*known]);
    origins_[*known] = origin;
    return replace(name, value);
  }
  names_.add(name);
  origins_.push_back(origin);
  values_.push_back(value);
}

void MechanismScope::add_deferred(const ConfigValue& at, const std::string& name, std::function<Value()> value) {
  add(at, name, Value(model_.term(model_.graph.number(0))));
  deferred_[*names_.find(name)] = {name, std::move(value)};
}

void MechanismScope::add_predefined(const std::string& name, std::function<Value()> value) {
  if (names_.find(name)) return;
  using Listing = expression::Names::Listing;
  names_.add(name, name.find('.') == std::string::npos ? Listing::always : Listing::never);
  origins_.emplace_back();
  values_.push_back(model_.term(model_.graph.number(0)));
  deferred_[values_.size() - 1] = {name, std::move(value)};
}

const MechanismScope::Value& MechanismScope::value_of(std::size_t index, const ConfigValue& user) {
  if (const auto found = deferred_.find(index); found != deferred_.end()) {
    Deferred& deferred = found->second;
    if (!deferred.compute) throw user.refusal("'" + deferred.name + "' depends on itself");
    const auto compute = std::exchange(deferred.compute, nullptr);
    const bool motion_was_allowed = std::exchange(motion_allowed_, false);
    values_[index] = compute();
    motion_allowed_ = motion_was_allowed;
    deferred_.erase(index);
  }
  return values_[index];
}

void MechanismScope::resolve(const ConfigValue& root) {
  while (!deferred_.empty()) value_of(deferred_.begin()->first, root);
}

void MechanismScope::add_member(const std::string& name, const Value& value) {
  names_.add(name);
  origins_.emplace_back();
  values_.push_back(value);
}

void MechanismScope::replace(const std::string& name, const Value& value) {
  values_[names_.find(name).value()] = value;
  deferred_.erase(names_.find(name).value());
}

bool MechanismScope::knows(const std::string& name) const {
  const auto index = names_.find(name);
  return index && !origins_[*index].empty();
}

MechanismScope::Value MechanismScope::formula_of_any_kind(const ConfigValue& value, const std::string& unit,
                                                          const std::string& what) {
  value.expect_formula(unit);
  if (!value.is_text()) return model_.term(model_.graph.number(value.number(unit)));
  const std::string& text = value.text("a number or a formula");
  if (const auto number = parse_quantity(text, unit)) return model_.term(model_.graph.number(*number));
  if (const std::string kind = kind_of_quantity(text); !kind.empty())
    throw value.error_of('"' + text + "\", " + kind, kind_of_unit(unit) + ", or a formula: " + quantity_hint(unit));
  const auto [parsed, norms] = value.explained([&] {
    return expression::parse_formula(model_.graph, text, names_, [&](std::size_t i) { return value_of(i, value); });
  });
  for (const Node norm : norms) {
    const expression::Entry root = model_.graph[norm];
    for (const Node argument : root.operands()) register_partial_operations(argument, what);
    visited_.insert(norm);
  }
  for (const Term& term : expression::elements(parsed)) {
    if (!motion_allowed_ &&
        (model_.graph[term.node()].groups & (generic::Inputs::kExtras | generic::Inputs::kRates)) != 0)
      throw value.refusal("only the formula of a [[quantity]] may depend on [inputs] or rates");
    register_partial_operations(term.node(), what);
  }
  return parsed;
}

Term MechanismScope::formula(const ConfigValue& value, const std::string& unit, const std::string& what) {
  const Value found = formula_of_any_kind(value, unit, what);
  if (const Term* const term = std::get_if<Term>(&found)) return *term;
  throw value.error_of(expression::kind_of(found) + ", the value of this formula", "a scalar");
}

void MechanismScope::refuse_pose(const ConfigValue& value, std::span<const Term> terms) const {
  std::vector<std::string> moving;
  for (std::size_t i = 0; i < model_.info.coordinates.size(); ++i)
    if (std::ranges::any_of(terms, [&](const Term& term) {
          return model_.graph[term.node()].groups & generic::Inputs::coordinate_group(i);
        }))
      moving.push_back("'" + model_.info.coordinates[i].name + "'");
  if (!moving.empty()) throw value.error("a formula of parameters only, which does not depend on " + join(moving));
}

Term MechanismScope::of_design(const ConfigValue& value, const std::string& unit, const std::string& what) {
  const Term term = formula(value, unit, what);
  refuse_pose(value, {&term, 1});
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

constexpr const char* kPoint = "three numbers or formulas [x, y, z], or a formula whose value is a vector";
constexpr const char* kDirection =
    "a direction, three numbers or formulas [x, y, z] that are not all 0, or a formula whose value is a vector";

}  // namespace

Vector3 MechanismScope::vector(const ConfigValue& value, const std::string& unit, const std::string& what,
                               const char* expected, bool depends_on_pose) {
  if (value.is_text()) {
    const Value found = formula_of_any_kind(value, unit, what);
    const Vector3* const v = std::get_if<Vector3>(&found);
    if (!v) throw value.error_of(expression::kind_of(found) + ", the value of this formula", expected);
    if (!depends_on_pose) refuse_pose(value, *v);
    return *v;
  }
  const std::vector<ConfigValue> elements = value.elements(expected);
  if (elements.size() != 3) throw value.error(expected);
  const auto element = [&](std::size_t i) {
    return depends_on_pose ? formula(elements[i], unit, what) : of_design(elements[i], unit, what);
  };
  return {element(0), element(1), element(2)};
}

Vector3 MechanismScope::point(const ConfigValue& value, const std::string& what) {
  return vector(value, "m", what, kPoint, true);
}

Vector3 MechanismScope::point_of_design(const ConfigValue& value, const std::string& what) {
  return vector(value, "m", what, kPoint, false);
}

Vector3 MechanismScope::direction(const ConfigValue& value, const std::string& what) {
  const Vector3 v = vector(value, "1", what, kDirection, false);
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
  // Use an arbitrary pose without special symmetry.
  for (std::size_t i = 0; i < model_.info.coordinates.size(); ++i)
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
    // A quantity with a limit may be undefined at a pose at which the mechanism can be assembled. The condition that it
    // is defined is therefore a margin of the pose.
    (is_needed ? model_.domains : model_.margins)
        .push_back({name, "", (of_circle ? one - abs(argument) : argument).node(), consequence});
  }
}

}  // namespace pkm
