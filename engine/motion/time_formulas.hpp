// A motion as formulas of the time in a graph: what holds of them over an interval of times holds at every instant.
#pragma once

#include "engine/graph/graph.hpp"
#include "engine/math/interval.hpp"

namespace pkm {

/// A graph that a motion is written to. What a motion computes with its numbers before it begins, such as the way
/// between two points, becomes an input that holds it for certain.
struct TimeGraph {
  graph::Graph& graph;
  std::vector<Interval>& inputs;  ///< of the graph
  std::size_t position;           ///< of the time among them
  graph::Term time;

  /// @param known  inputs that the graph has already; the time and the numbers come behind them
  TimeGraph(graph::Graph& to, std::vector<Interval>& known)
      : graph(to), inputs(known), position(known.size()), time(input(0.0)) {}

  graph::Term input(const Interval& value) {
    inputs.push_back(value);
    return {graph, graph.input(inputs.size() - 1)};
  }
  graph::Term number(const Interval& value) {
    return value.is_number() ? graph::Term(graph, value.lower) : input(value);
  }
};

}  // namespace pkm
