// Symbolic differentiation: derivatives of nodes as nodes of the same graph.
//
// The chain rule d f(x, y) = f_x dx + f_y dy is applied node by node. Nodes that do not depend on the variables have
// the derivative 0, and their terms are dropped. A derivative shares the operations of the formula itself
// (hash-consing), so a velocity costs a few additional operations; differentiating it again gives the acceleration.
// Where abs, min, max or c ? x : y are not differentiable, the derivative is that of the branch that gives the value.
#pragma once

#include <unordered_map>

#include "engine/expression/graph.hpp"

namespace pkm::expression {

/// Directional derivatives: the rates of change of nodes for given rates of change of some inputs.
class Rates {
 public:
  explicit Rates(Graph& graph) : graph_(graph) {}

  /// Sets the rate of change of an input, or of another node that is then not differentiated. To be called before of().
  void set_rate(Node node, Node rate) { rates_.emplace(node, rate); }
  /// The rate of change of a node. The rates of all nodes that it depends on are cached.
  Term of(Node node);
  Term of(const Term& term) { return of(term.node()); }

 private:
  Term cached(Node node) { return {graph_, rates_.at(node)}; }
  /// Applies the chain rule to a node whose operands have cached rates.
  Term differentiate(Node node);
  /// Caches the rates of the unknowns of a system by the implicit function theorem: J u' = -(rates of the equations
  /// while u is fixed). The rates of the system's operands are cached.
  void add_rates_of_unknowns(Node status);

  Graph& graph_;
  std::unordered_map<Node, Node> rates_;  ///< rates of change that were set or computed, by node
};

/// The partial derivative of f with respect to one input. Evaluated with intervals over a box that contains a kink of
/// f, it encloses the derivatives on both sides. At a discontinuity it is meaningless; there, the interval of f is
/// marked as not continuous.
inline Node derivative(Graph& graph, Node f, Node input) {
  Rates rates(graph);
  rates.set_rate(input, graph.number(1));
  return rates.of(f).node();
}

}  // namespace pkm::expression
