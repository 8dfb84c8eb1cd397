#include "engine/generic/interval_constraints.hpp"

#include <algorithm>
#include <optional>
#include <unordered_set>

#include "engine/expression/program.hpp"

namespace pkm::generic {
namespace {

using expression::Code, expression::Entry, expression::Term;

/// Enclosure of a node's value for a design; std::nullopt if the node depends on inputs other than the design.
std::optional<Interval> design_value(const Graph& graph, Node node, const std::vector<Interval>& inputs) {
  if ((graph[node].groups & ~Inputs::kDesign) != 0) return {};
  std::vector<Interval> registers;
  const expression::Program program(graph, {&node, 1});
  program.run_all<Interval>(inputs, registers);
  return registers[program.outputs().front()];
}
bool is_nonnegative(const Graph& graph, Node node, const std::vector<Interval>& inputs) {
  const auto number = design_value(graph, node, inputs);
  return number && number->is_certified_satisfied();
}
bool is_zero(const Graph& graph, Node node, const std::vector<Interval>& inputs) {
  const auto number = design_value(graph, node, inputs);
  return number && number->lower == 0 && number->upper == 0;
}
/// True if the node depends on the design only and its value is certain to be in [0, pi]. (The double kPi is less than
/// pi.)
bool is_value_of_acos(const Graph& graph, Node node, const std::vector<Interval>& inputs) {
  const auto number = design_value(graph, node, inputs);
  return number && number->is_certified_satisfied() && number->upper <= kPi;
}

std::optional<Node> radicand(const Graph& graph, Node node) {
  const Entry& entry = graph[node];
  if (!entry.operation || entry.operation->code != Code::sqrt) return {};
  return entry.arguments[0];
}

/// Rewrites c - sqrt(a) >= 0 and sqrt(a) - c >= 0 without the root, where c >= 0 depends on the design only: c^2 - a >=
/// 0 and a - c^2 >= 0; for c = 0 the second one becomes a >= 0. All other constraints are returned unchanged.
Node squared(Graph& graph, Node constraint, const std::vector<Interval>& inputs) {
  const Entry entry = graph[constraint];
  if (!entry.operation || entry.operation->code != Code::subtract) return constraint;
  const auto [left, right] = std::pair(entry.arguments[0], entry.arguments[1]);
  const auto square = [&](Node node) { return Term(graph, node) * Term(graph, node); };
  if (const auto a = radicand(graph, right); a && is_nonnegative(graph, left, inputs))
    return (square(left) - Term(graph, *a)).node();
  if (const auto a = radicand(graph, left); a && is_nonnegative(graph, right, inputs))
    return is_zero(graph, right, inputs) ? *a : (Term(graph, *a) - square(right)).node();
  return constraint;
}

/// Rewrites c - acos(u) >= 0 and acos(u) - c >= 0 by taking cosines. For u = k / sqrt(a), the constraint is also
/// multiplied by sqrt(a). The condition that u is in [-1, 1] is a separate constraint, or always satisfied. All other
/// constraints are returned unchanged.
/// @param quotient  receives u = k / sqrt(a), which has to be finite
Node without_acos(Graph& graph, Node constraint, const std::vector<Interval>& inputs, std::optional<Node>& quotient) {
  const Entry entry = graph[constraint];
  if (!entry.operation || entry.operation->code != Code::subtract) return constraint;
  const auto [left, right] = std::pair(entry.arguments[0], entry.arguments[1]);
  const auto is_acos = [&](Node node) { return graph[node].operation && graph[node].operation->name == "acos"; };
  // is_upper: true if the constraint is c - acos(u) >= 0; false if it is acos(u) - c >= 0
  const bool is_upper = is_acos(right) && is_value_of_acos(graph, left, inputs);
  if (!is_upper && !(is_acos(left) && is_value_of_acos(graph, right, inputs))) return constraint;
  const Term cosine = cos(Term(graph, is_upper ? left : right));
  const Node u = graph[is_upper ? right : left].arguments[0];
  const Entry fraction = graph[u];
  if (!fraction.operation || fraction.operation->code != Code::divide || !radicand(graph, fraction.arguments[1]))
    return (is_upper ? Term(graph, u) - cosine : cosine - Term(graph, u)).node();
  quotient = u;
  const Term k(graph, fraction.arguments[0]), bound = Term(graph, fraction.arguments[1]) * cosine;
  return (is_upper ? k - bound : bound - k).node();
}

/// A constraint that is satisfied if and only if a node is finite.
Node is_finite(Graph& graph, Node node) {
  return graph.apply(expression::operation("*"), std::array{node, graph.number(0)});
}

/// Decides whether the argument of an operation is in its domain at every pose that satisfies all constraints.
class DomainTest {
 public:
  DomainTest(Graph& graph, const std::vector<bounds::NamedConstraint>& constraints) : graph_(graph) {
    for (const auto& constraint : constraints) known_.insert(constraint.node);
  }

  /// True if the operation is sqrt, acos or asin, and the constraints ensure that its argument is in its domain.
  bool ensures_domain(const Entry& entry) {
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

IntervalConstraints interval_constraints(const Model& model, const std::vector<Interval>& inputs,
                                         std::span<const Node> reach) {
  Graph graph = model.graph;
  std::vector<bounds::NamedConstraint> constraints;
  const auto add = [&](const std::string& name, Node constraint) {
    std::optional<Node> quotient;
    const Node node = without_acos(graph, constraint, inputs, quotient);
    constraints.push_back({name, squared(graph, node, inputs)});
    if (quotient) constraints.push_back({name, is_finite(graph, *quotient)});
  };
  for (const Result& domain : model.domains) add(domain.name, domain.node);
  for (const Node node : reach) add("reach", node);
  for (const Result& margin : model.margins) add(margin.name, margin.node);
  for (const Node node : model.defined) constraints.push_back({"formulas have values", node});
  // Remove duplicates: a box over which two copies of a constraint are undecided would have no unique root.
  std::unordered_set<Node> listed;
  std::erase_if(constraints, [&](const auto& constraint) { return !listed.insert(constraint.node).second; });

  DomainTest test(graph, constraints);
  std::vector<Node> roots;
  for (const auto& constraint : constraints) roots.push_back(constraint.node);
  IntervalConstraints made;
  std::vector<Node> copies(graph.size());
  for (const Node node : graph.reachable(roots)) {
    const Entry entry = graph[node];
    Node& to = copies[static_cast<std::size_t>(node)];
    if (!entry.operation) {
      to = entry.is_number() ? made.graph.number(entry.number)
                             : made.graph.input(static_cast<std::size_t>(entry.input), entry.groups);
      continue;
    }
    std::vector<Node> arguments;
    for (const Node operand : entry.operands()) arguments.push_back(copies[static_cast<std::size_t>(operand)]);
    if (test.ensures_domain(entry)) {
      const auto clamp = [&](const char* function, double bound) {
        arguments[0] =
            made.graph.apply(expression::operation(function), std::array{arguments[0], made.graph.number(bound)});
      };
      clamp("max", entry.operation->code == Code::sqrt ? 0 : -1);
      if (entry.operation->code != Code::sqrt) clamp("min", 1);
    }
    to = made.graph.apply_like(entry, arguments);
  }
  for (const auto& constraint : constraints) {
    // The margin of a balance is neither a difference nor a root, and therefore among the constraints as it is.
    if (model.balance && constraint.node == model.balance->margin) made.balance = made.all.size();
    made.all.push_back({constraint.name, copies[static_cast<std::size_t>(constraint.node)]});
  }
  return made;
}

}  // namespace pkm::generic
