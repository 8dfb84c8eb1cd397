#include "engine/generic/constraints.hpp"

#include <algorithm>

namespace pkm::generic {
namespace {

template <class Visit>
void for_each_node(PoseConstraints& constraints, const Visit& visit) {
  std::ranges::for_each(constraints.all, visit);
  for (CrankRangeNodes& r : constraints.crank_ranges) {
    for (Node* const node : {&r.at_min, &r.at_max, &r.after_min, &r.before_max, &r.half_turn, &r.reach, &r.branch})
      visit(*node);
    std::ranges::for_each(r.constraints, visit);
  }
  for (AnnulusNodes& annulus : constraints.annuli) {
    std::ranges::for_each(annulus.surfaces, visit);
    std::ranges::for_each(annulus.constraints, visit);
  }
  for (RodAndPathNodes& path : constraints.paths) {
    for (auto* const vector : {&path.v, &path.axis, &path.zero}) std::ranges::for_each(*vector, visit);
    for (Node* const node : {&path.crank, &path.rod, &path.branch, &path.from, &path.to}) visit(*node);
    std::ranges::for_each(path.constraints, visit);
  }
  for (auto& ends : constraints.box)
    if (ends) std::ranges::for_each(*ends, visit);
}

}  // namespace

PoseConstraints constraints_of(const Model& model, std::size_t mode) {
  std::vector<std::optional<double>> signs(model.inputs.sign(0));
  for (const double sign : model.signs[mode]) signs.emplace_back(sign);
  PoseConstraints constraints{.graph = {},
                              .all = {},
                              .crank_ranges = model.crank_ranges,
                              .annuli = model.annuli,
                              .paths = model.paths,
                              .box = model.box};
  for (const auto* const list : {&model.domains, &model.margins})
    for (const Result& result : *list) constraints.all.push_back(result.node);
  constraints.all.insert(constraints.all.end(), model.defined.begin(), model.defined.end());
  std::vector<Node> nodes;
  for_each_node(constraints, [&](Node& node) { nodes.push_back(node); });
  constraints.graph = substitute_numbers(model.graph, signs, nodes);
  auto next = nodes.begin();
  for_each_node(constraints, [&](Node& node) { node = *next++; });
  return constraints;
}

std::vector<Node> finiteness_constraints(Graph& graph, Node constraint, Groups along) {
  // Names of functions whose value is finite for all finite arguments, except for overflow.
  static const std::vector<std::string> finite = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "turn", "tanh"};
  const auto may_be_infinite = [&graph](const expression::Entry& entry) {
    if (!entry.operation) return false;
    if (entry.operation->code == expression::Code::divide) {
      const expression::Entry& divisor = graph[entry.arguments[1]];
      return !divisor.is_number() || divisor.number == 0;
    }
    const bool is_predicate = entry.operation->rank > 0 && entry.operation->name != "^";
    return entry.operation->code == expression::Code::other && !is_predicate &&
           entry.operation != &expression::choice() && std::ranges::find(finite, entry.operation->name) == finite.end();
  };
  const auto is_independent = [&](Node node) { return (graph[node].groups & along) == 0; };
  const auto is_divisor = [&](Node node) {
    return is_independent(node) && !(graph[node].is_number() && graph[node].number != 0);
  };
  std::vector<Node> subexpressions;
  std::vector<bool> is_listed(graph.size());
  for (const Node node : graph.reachable({&constraint, 1}, is_independent)) {
    const expression::Entry entry = graph[node];
    for (const Node operand : entry.operands()) {
      if (!is_independent(operand) || is_listed[static_cast<std::size_t>(operand)]) continue;
      is_listed[static_cast<std::size_t>(operand)] = true;
      subexpressions.push_back(operand);
    }
    if (entry.operation && entry.operation->code == expression::Code::divide && is_divisor(entry.arguments[1]))
      subexpressions.push_back(graph.apply(*entry.operation, std::array{graph.number(1), entry.arguments[1]}));
  }
  std::vector<bool> is_infinite(graph.size());  // for each node, true if its value may be infinite or undefined
  for (const Node node : graph.reachable(subexpressions))
    is_infinite[static_cast<std::size_t>(node)] =
        may_be_infinite(graph[node]) || std::ranges::any_of(graph[node].operands(), [&](Node operand) {
          return is_infinite[static_cast<std::size_t>(operand)];
        });
  std::erase_if(subexpressions, [&](Node node) { return !is_infinite[static_cast<std::size_t>(node)]; });
  for (Node& node : subexpressions) node = graph.apply(expression::operation("*"), std::array{node, graph.number(0)});
  return subexpressions;
}

std::string constraint_name(const Model& model, std::size_t constraint) {
  if (constraint < model.domains.size()) return model.domains[constraint].name;
  constraint -= model.domains.size();
  if (constraint < model.margins.size()) return model.margins[constraint].name;
  return "a joint's formula";
}

}  // namespace pkm::generic
