// Constraints of the coordinates x, y and z, given as formulas, for tests of certified bounds.
#pragma once

#include <string>
#include <vector>

#include "engine/expression/formula_parser.hpp"
#include "engine/workspace/bounds/constraints.hpp"

namespace pkm::bounds {

/// A graph whose inputs are coordinates, by the letters of `axes`: "xyz", "yx" or "z", the column coordinate last.
struct Formulas {
  explicit Formulas(const std::string& axes) {
    for (const char axis : axes) {
      names.emplace_back(1, axis);
      positions.push_back(nodes.size());
      nodes.push_back(graph.input(nodes.size()));
    }
  }
  expression::Node read(const std::string& text) { return expression::read_formula(graph, text, names, nodes); }

  Constraints conditions(const std::vector<std::string>& texts) {
    std::vector<NamedConstraint> all;
    for (const std::string& text : texts) all.push_back({text, read(text)});
    return {graph, all, positions, inputs()};
  }
  std::vector<Interval> inputs() const { return std::vector<Interval>(nodes.size()); }

  expression::Graph graph;
  std::vector<std::string> names;
  std::vector<expression::Node> nodes;
  std::vector<std::size_t> positions;
};

inline Constraints conditions(const std::string& axes, const std::vector<std::string>& texts) {
  return Formulas(axes).conditions(texts);
}

}  // namespace pkm::bounds
