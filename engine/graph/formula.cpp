#include "engine/graph/formula.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/graph/formula_reader.hpp"
#include "engine/graph/formula_words.hpp"

namespace pkm {

Formula::Formula(const std::string& text, const std::vector<std::string>& names) : text_(text) {
  graph::Graph graph;
  std::vector<graph::Node> nodes;
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (!graph::may_be_name(*name) || std::find(name + 1, names.end(), *name) != names.end())
      throw std::logic_error("a formula cannot know a number called '" + *name + "'");
    nodes.push_back(graph.input(nodes.size()));
  }
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
