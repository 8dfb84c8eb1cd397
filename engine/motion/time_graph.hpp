// Expression graph of a motion over time. Evaluated with interval arithmetic over a time interval, it encloses the
// motion at every instant, so that constraints can be certified between samples.
#pragma once

#include "engine/expression/graph.hpp"
#include "engine/math/interval.hpp"

namespace pkm {

/// The graph to which a motion adds its pose. Constants that the motion computes from its data, such as the distance
/// between two points, become inputs whose intervals enclose the exact values.
struct TimeGraph {
  expression::Graph& graph;
  std::vector<Interval>& inputs;  ///< values of the graph's inputs
  std::size_t position;           ///< index of the time among the inputs
  expression::Term time;

  /// @param known  values of the existing inputs of the graph; the values of the time and of constants are appended
  TimeGraph(expression::Graph& to, std::vector<Interval>& known)
      : graph(to), inputs(known), position(known.size()), time(input(0.0)) {}

  /// Adds an input with a given value to the graph.
  expression::Term input(const Interval& value) {
    inputs.push_back(value);
    return {graph, graph.input(inputs.size() - 1)};
  }
  /// Adds a constant to the graph: a number if the interval is a single value, otherwise a new input.
  expression::Term number(const Interval& value) {
    return value.is_number() ? expression::Term(graph, value.lower) : input(value);
  }
};

}  // namespace pkm
