// Derivatives of nodes as nodes of the same graph: what a formula's value does while inputs move.
//
// d f(x, y) = f_x dx + f_y dy, node by node; what does not move has the derivative 0 and is left out. So a velocity is
// a few more operations that share the formula's own, and its derivative again is an acceleration. At kinks (abs, min,
// max, c ? x : y) the derivative is that of the branch that gives the value.
#pragma once

#include <unordered_map>

#include "engine/graph/graph.hpp"

namespace pkm::graph {

/// While inputs move at given rates.
class Rates {
 public:
  explicit Rates(Graph& graph) : graph_(graph) {}

  /// Lets an input move at this rate; before the first derivative.
  void move(Node input, Node rate) { known_.emplace(input, rate); }
  Term of(Node node);
  Term of(const Term& term) { return of(term.node()); }

 private:
  Term known(Node node) { return {graph_, known_.at(node)}; }
  Term of_operation(Node node);

  Graph& graph_;
  std::unordered_map<Node, Node> known_;  ///< derivatives
};

/// The derivative of f by one input, to be bounded by intervals as f is: over a box that holds a kink it holds both
/// sides. At a jump it means nothing; there, an interval of f says that f is not continuous.
inline Node derivative(Graph& graph, Node f, Node input) {
  Rates rates(graph);
  rates.move(input, graph.number(1));
  return rates.of(f).node();
}

}  // namespace pkm::graph
