#include "engine/generic/pose_conditions.hpp"

#include <algorithm>
#include <optional>
#include <unordered_set>

#include "engine/expression/program.hpp"

namespace pkm::generic {
namespace {

using expression::Code, expression::Entry, expression::Term;

/// What a node comes to where it is a number of the design.
std::optional<Interval> of_design(const Graph& graph, Node node, const std::vector<Interval>& inputs) {
  if ((graph[node].groups & ~Inputs::kDesign) != 0) return {};
  std::vector<Interval> registers;
  const expression::Program program(graph, {&node, 1});
  program.run_all<Interval>(inputs, registers);
  return registers[program.outputs().front()];
}
bool is_positive(const Graph& graph, Node node, const std::vector<Interval>& inputs) {
  const auto number = of_design(graph, node, inputs);
  return number && number->is_certified_satisfied();
}
bool is_zero(const Graph& graph, Node node, const std::vector<Interval>& inputs) {
  const auto number = of_design(graph, node, inputs);
  return number && number->lower == 0 && number->upper == 0;
}
bool is_angle(const Graph& graph, Node node, const std::vector<Interval>& inputs) {
  const auto number = of_design(graph, node, inputs);
  return number && number->is_certified_satisfied() && number->upper <= kPi;  // which is less than pi
}

std::optional<Node> radicand(const Graph& graph, Node node) {
  const Entry& entry = graph[node];
  if (!entry.operation || entry.operation->code != Code::sqrt) return {};
  return entry.arguments[0];
}

/// Without the root, where a length is compared with one of the design; with 0: the condition that there is a root.
Node squared(Graph& graph, Node condition, const std::vector<Interval>& inputs) {
  const Entry entry = graph[condition];
  if (!entry.operation || entry.operation->code != Code::subtract) return condition;
  const auto [left, right] = std::pair(entry.arguments[0], entry.arguments[1]);
  const auto square = [&](Node node) { return Term(graph, node) * Term(graph, node); };
  if (const auto a = radicand(graph, right); a && is_positive(graph, left, inputs))
    return (square(left) - Term(graph, *a)).node();
  if (const auto a = radicand(graph, left); a && is_positive(graph, right, inputs))
    return is_zero(graph, right, inputs) ? *a : (Term(graph, *a) - square(right)).node();
  return condition;
}

/// Without the arc cosine, where an angle acos(u) is compared with one of the design in [0, pi]; of u = k / sqrt(a)
/// without the quotient. That u is within [-1, 1] is a condition by itself, or goes without saying.
/// @param value  u where it is a quotient: there has to be one
Node by_cosine(Graph& graph, Node condition, const std::vector<Interval>& inputs, std::optional<Node>& value) {
  const Entry entry = graph[condition];
  if (!entry.operation || entry.operation->code != Code::subtract) return condition;
  const auto [left, right] = std::pair(entry.arguments[0], entry.arguments[1]);
  const auto is_acos = [&](Node node) { return graph[node].operation && graph[node].operation->name == "acos"; };
  const bool most = is_acos(right) && is_angle(graph, left, inputs);
  if (!most && !(is_acos(left) && is_angle(graph, right, inputs))) return condition;
  const Term bound = cos(Term(graph, most ? left : right));
  const Entry u = graph[graph[most ? right : left].arguments[0]];
  const bool quotient = u.operation && u.operation->code == Code::divide && radicand(graph, u.arguments[1]);
  if (quotient) value = graph[most ? right : left].arguments[0];
  const Term over(graph, quotient ? u.arguments[0] : graph[most ? right : left].arguments[0]);
  const Term least = quotient ? Term(graph, u.arguments[1]) * bound : bound;
  return (most ? over - least : least - over).node();
}

/// >= 0 where a node has a value.
Node exists(Graph& graph, Node node) {
  return graph.apply(expression::operation("*"), std::array{node, graph.number(0)});
}

class Guard {
 public:
  Guard(Graph& graph, const std::vector<bounds::NamedCondition>& conditions) : graph_(graph) {
    for (const auto& condition : conditions) known_.insert(condition.node);
  }

  /// Whether where the conditions hold, the operation is defined as far as its argument goes.
  bool guards(const Entry& entry) {
    const std::string& name = entry.operation->name;
    if (name == "sqrt") return known_.contains(entry.arguments[0]);
    if (name != "acos" && name != "asin") return false;
    const Term u(graph_, entry.arguments[0]);
    if (known_.contains((Term(graph_, 1.0) - abs(u)).node())) return true;
    const Entry quotient = graph_[u.node()];
    if (!quotient.operation || quotient.operation->code != Code::divide) return false;
    const Term k(graph_, quotient.arguments[0]), h(graph_, quotient.arguments[1]);
    return known_.contains((h - k).node()) && known_.contains((h + k).node());
  }

 private:
  Graph& graph_;
  std::unordered_set<Node> known_;
};

}  // namespace

PoseConditions pose_conditions(const Model& model, const std::vector<Interval>& inputs) {
  Graph graph = model.graph;
  std::vector<bounds::NamedCondition> conditions;
  for (const auto* const list : {&model.domains, &model.margins})
    for (const Result& result : *list) {
      std::optional<Node> value;
      const Node angle = by_cosine(graph, result.node, inputs, value);
      conditions.push_back({result.name, squared(graph, angle, inputs)});
      if (value) conditions.push_back({result.name, exists(graph, *value)});
    }
  for (const Node node : model.defined) conditions.push_back({"formulas have values", node});
  // the first of its kind: of two that are open over the same boxes neither would have the root
  std::unordered_set<Node> seen;
  std::erase_if(conditions, [&](const auto& condition) { return !seen.insert(condition.node).second; });

  Guard guard(graph, conditions);
  std::vector<Node> roots;
  for (const auto& condition : conditions) roots.push_back(condition.node);
  const std::vector<Node> used = graph.reachable(roots);
  PoseConditions made;
  std::vector<Node> now(graph.size());
  for (const Node node : used) {
    const Entry entry = graph[node];
    Node& to = now[static_cast<std::size_t>(node)];
    if (!entry.operation) {
      to = entry.is_number() ? made.graph.number(entry.number)
                             : made.graph.input(static_cast<std::size_t>(entry.input), entry.groups);
      continue;
    }
    std::array<Node, expression::kMaxArguments> arguments{};
    for (std::size_t i = 0; i < entry.count; ++i) arguments[i] = now[static_cast<std::size_t>(entry.arguments[i])];
    if (guard.guards(entry)) {
      const auto bounded = [&](const char* by, double number) {
        arguments[0] = made.graph.apply(expression::operation(by), std::array{arguments[0], made.graph.number(number)});
      };
      bounded("max", entry.operation->code == Code::sqrt ? 0 : -1);
      if (entry.operation->code != Code::sqrt) bounded("min", 1);
    }
    to = made.graph.apply(*entry.operation, std::span(arguments).first(entry.count));
  }
  for (const auto& condition : conditions)
    made.all.push_back({condition.name, now[static_cast<std::size_t>(condition.node)]});
  return made;
}

}  // namespace pkm::generic
