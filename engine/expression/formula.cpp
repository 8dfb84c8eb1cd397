#include "engine/expression/formula.hpp"

#include <algorithm>
#include <stdexcept>

#include "engine/core/catalogue.hpp"
#include "engine/expression/formula_lexer.hpp"
#include "engine/expression/formula_parser.hpp"

namespace pkm {

Formula::Formula(const std::string& text, const std::vector<std::string>& names) : text_(text) {
  expression::Graph graph;
  std::vector<expression::Node> nodes;
  for (auto name = names.begin(); name != names.end(); ++name) {
    if (!expression::may_be_name(*name) || std::find(name + 1, names.end(), *name) != names.end())
      throw std::logic_error("formula: invalid or repeated variable name '" + *name + "'");
    nodes.push_back(graph.input(nodes.size()));
  }
  const expression::Node value = expression::read_formula(graph, text, names, nodes);
  program_ = expression::Program(graph, {&value, 1});
  for (const auto& input : program_.stages().front().inputs) used_.push_back(input.position);
  std::ranges::sort(used_);
}

std::string formula_help() {
  return "numbers, pi, + - * / ^, comparisons, && ||, c ? x : y, and the functions " +
         join(names_of(expression::functions()));
}

}  // namespace pkm
