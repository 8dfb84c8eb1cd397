#include "engine/graph/formula.hpp"

#include <algorithm>

#include "engine/core/catalogue.hpp"
#include "engine/graph/formula_reader.hpp"

namespace pkm {

Formula::Formula(const std::string& text, const std::vector<std::string>& names) {
  graph::Graph graph;
  std::vector<graph::Node> nodes;
  for (std::size_t i = 0; i < names.size(); ++i) nodes.push_back(graph.input(i));
  const graph::Node value = graph::read_formula(graph, text, names, nodes);
  program_ = graph::Program(graph, {&value, 1});
  for (const auto& input : program_.stages().front().inputs) used_.push_back(input.position);
  std::ranges::sort(used_);
}

std::string formula_help() {
  return "numbers, pi, + - * / ^, comparisons, && ||, c ? x : y, and the functions " +
         join(names_of(graph::functions()));
}

}  // namespace pkm
