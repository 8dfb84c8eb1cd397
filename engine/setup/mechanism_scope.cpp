#include "engine/setup/mechanism_scope.hpp"

#include <algorithm>

#include "engine/core/unit.hpp"
#include "engine/graph/formula_reader.hpp"
#include "engine/graph/formula_words.hpp"

namespace pkm {

using graph::Node, limbs::Term, limbs::Vector3;

void MechanismScope::add(const ConfigValue& at, const std::string& name, Node node) {
  if (!graph::may_be_name(name))
    throw at.refusal("'" + name + "' is no name for formulas: letters, digits and '_', none of the functions nor pi");
  if (knows(name)) throw at.refusal("there is already something called '" + name + "'");
  names_.push_back(name);
  nodes_.push_back(node);
}

void MechanismScope::replace(const std::string& name, Node node) {
  nodes_[static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin())] = node;
}

bool MechanismScope::knows(const std::string& name) const { return std::ranges::find(names_, name) != names_.end(); }

Term MechanismScope::formula(const ConfigValue& value, const std::string& unit, const std::string& what) {
  if (!value.is_text()) return model_.term(model_.graph.number(value.number(unit)));
  const std::string& text = value.text("a number or a formula");
  if (const auto number = parse_quantity(text, unit)) return model_.term(model_.graph.number(*number));
  const Node node = value.explained([&] { return graph::read_formula(model_.graph, text, names_, nodes_); });
  watch(node, what);
  return model_.term(node);
}

Term MechanismScope::of_design(const ConfigValue& value, const std::string& unit, const std::string& what) {
  const Term term = formula(value, unit, what);
  if ((model_.graph[term.node()].groups & ~described::Inputs::kDesign) != 0)
    throw value.error("a formula of parameters alone, without coordinates");
  return term;
}

Vector3 MechanismScope::point(const ConfigValue& value, const std::string& what) {
  constexpr const char* kExpected = "three numbers or formulas [x, y, z]";
  const std::vector<ConfigValue> elements = value.elements(kExpected);
  if (elements.size() != 3) throw value.error(kExpected);
  return {formula(elements[0], "m", what), formula(elements[1], "m", what), formula(elements[2], "m", what)};
}

Vector3 MechanismScope::direction(const ConfigValue& value, const std::string& what) {
  constexpr const char* kExpected = "a direction, three numbers or formulas [x, y, z] that are not all 0";
  const std::vector<ConfigValue> elements = value.elements(kExpected);
  if (elements.size() != 3) throw value.error(kExpected);
  const Vector3 v = {formula(elements[0], "1", what), formula(elements[1], "1", what), formula(elements[2], "1", what)};
  const Term length = limbs::length(v);
  if (length.is(0)) throw value.error(kExpected);
  known_to_exist(length.node());
  return v / length;
}

void MechanismScope::known_to_exist(Node node) {
  for (const Node each : model_.graph.reachable({&node, 1})) seen_.insert(each);
}

void MechanismScope::watch(Node root, const std::string& what) {
  const auto has_domain = [](const graph::Operation* operation) {
    return operation && (operation->name == "sqrt" || operation->name == "asin" || operation->name == "acos" ||
                         operation->name == "log" || operation->name == "log10");
  };
  int count = 0;
  for (const Node node : model_.graph.reachable({&root, 1}))
    if (seen_.insert(node).second && has_domain(model_.graph[node].operation))
      watched_.push_back({node, what + (++count > 1 ? " exists (" + std::to_string(count) + ")" : " exists")});
}

void MechanismScope::note_domains() {
  std::vector<Node> used = model_.joints;
  for (const described::Result& margin : model_.margins) used.push_back(margin.node);
  const std::vector<Node> reachable = model_.graph.reachable(used);
  for (const auto& [node, name] : watched_) {
    if (!std::ranges::binary_search(reachable, node)) continue;
    const graph::Entry entry = model_.graph[node];
    const Term argument = model_.term(entry.arguments[0]), one(model_.graph, 1.0);
    const bool of_circle = entry.operation->name == "asin" || entry.operation->name == "acos";
    model_.domains.push_back({name, "", (of_circle ? one - abs(argument) : argument).node()});
  }
}

}  // namespace pkm
