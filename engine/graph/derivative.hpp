// Derivatives of formulas as formulas, so that they can be bounded as their values are.
#pragma once

#include <optional>
#include <vector>

#include "engine/graph/graph.hpp"

namespace pkm::graph {

/// The derivative of a node by an input; none: it is made of an operation that has no derivative as a formula. At a
/// kink it is that of one side, and what holds both sides over intervals that hold the kink. At a jump it means
/// nothing: there, an interval of f says that f is not continuous.
/// @param input  a node of the graph
std::optional<Node> derivative(Graph& graph, Node f, Node input);

}  // namespace pkm::graph
