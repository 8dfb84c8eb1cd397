#include "engine/generic/conditions.hpp"

#include <algorithm>

namespace pkm::generic {

Conditions conditions_of(const Model& model, std::size_t mode) {
  std::vector<std::optional<double>> signs(model.inputs.sign(0));
  for (const double sign : model.signs[mode]) signs.emplace_back(sign);
  std::vector<Node> nodes;
  for (const auto* const list : {&model.domains, &model.margins})
    for (const Result& result : *list) nodes.push_back(result.node);
  nodes.insert(nodes.end(), model.defined.begin(), model.defined.end());
  const std::size_t own = nodes.size();
  for (const CoveredRange& crank : model.crank_ranges) {
    nodes.insert(nodes.end(), {crank.at_min, crank.at_max, crank.after_min, crank.before_max, crank.half_turn,
                               crank.reach, crank.branch});
    nodes.insert(nodes.end(), crank.conditions.begin(), crank.conditions.end());
  }
  for (const CoveredFolds& folds : model.folds) {
    nodes.insert(nodes.end(), folds.surfaces.begin(), folds.surfaces.end());
    nodes.insert(nodes.end(), folds.conditions.begin(), folds.conditions.end());
  }
  for (const auto& ends : model.box)
    if (ends) nodes.insert(nodes.end(), ends->begin(), ends->end());
  Conditions conditions;
  conditions.graph = substitute_numbers(model.graph, signs, nodes);
  const Node* n = nodes.data();
  conditions.all.assign(n, n + own);
  n += own;
  for (const CoveredRange& crank : model.crank_ranges) {
    const std::size_t count = crank.conditions.size();
    conditions.cranks.push_back({n[0], n[1], n[2], n[3], n[4], n[5], n[6], {n + 7, n + 7 + count}});
    n += 7 + count;
  }
  for (const CoveredFolds& folds : model.folds) {
    const std::size_t count = folds.conditions.size();
    conditions.folds.push_back({{n[0], n[1]}, {n + 2, n + 2 + count}, folds.crank_range});
    n += 2 + count;
  }
  for (const auto& ends : model.box) {
    conditions.box.emplace_back();
    if (!ends) continue;
    conditions.box.back() = {n[0], n[1]};
    n += 2;
  }
  return conditions;
}

std::vector<Node> finite_parts(Graph& graph, Node condition, Groups along) {
  // of finite numbers these are finite, but where they overflow
  static const std::vector<std::string> finite = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "turn", "tanh"};
  const auto may_be_infinite = [&graph](const expression::Entry& entry) {
    if (!entry.operation) return false;
    if (entry.operation->code == expression::Code::divide) {
      const expression::Entry& divisor = graph[entry.arguments[1]];
      return !divisor.is_number() || divisor.number == 0;
    }
    const bool is_step = entry.operation->rank > 0 && entry.operation->name != "^";
    return entry.operation->code == expression::Code::other && !is_step && entry.operation != &expression::choice() &&
           std::ranges::find(finite, entry.operation->name) == finite.end();
  };
  const auto is_free = [&](Node node) { return (graph[node].groups & along) == 0; };
  const auto is_divisor = [&](Node node) {
    return is_free(node) && !(graph[node].is_number() && graph[node].number != 0);
  };
  std::vector<Node> parts;
  std::vector<bool> is_part(graph.size());
  for (const Node node : graph.reachable({&condition, 1}, is_free)) {
    const expression::Entry entry = graph[node];
    for (const Node operand : entry.operands()) {
      if (!is_free(operand) || is_part[static_cast<std::size_t>(operand)]) continue;
      is_part[static_cast<std::size_t>(operand)] = true;
      parts.push_back(operand);
    }
    if (entry.operation && entry.operation->code == expression::Code::divide && is_divisor(entry.arguments[1]))
      parts.push_back(graph.apply(*entry.operation, std::array{graph.number(1), entry.arguments[1]}));
  }
  std::vector<bool> is_infinite(graph.size());  // maybe
  for (const Node node : graph.reachable(parts))
    is_infinite[static_cast<std::size_t>(node)] =
        may_be_infinite(graph[node]) || std::ranges::any_of(graph[node].operands(), [&](Node operand) {
          return is_infinite[static_cast<std::size_t>(operand)];
        });
  std::erase_if(parts, [&](Node part) { return !is_infinite[static_cast<std::size_t>(part)]; });
  for (Node& part : parts) part = graph.apply(expression::operation("*"), std::array{part, graph.number(0)});
  return parts;
}

std::string name_of_condition(const Model& model, std::size_t condition) {
  if (condition < model.domains.size()) return model.domains[condition].name;
  condition -= model.domains.size();
  if (condition < model.margins.size()) return model.margins[condition].name;
  return "a joint's formula";
}

}  // namespace pkm::generic
