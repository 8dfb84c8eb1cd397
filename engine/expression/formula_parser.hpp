// Parser of formulas: converts text into nodes of an expression graph.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/expression/formula_value.hpp"
#include "engine/expression/graph.hpp"
#include "engine/expression/symbol_table.hpp"

namespace pkm::expression {

/// Parses a formula; see engine/expression/formula.hpp for the syntax. Throws std::invalid_argument with a message that
/// gives the position of the error if `text` is not a valid formula.
/// @param names  variables that the formula may use; may_be_name() is true for each name
/// @param nodes  the node of each variable
/// @return the node of the formula's value
Node read_formula(Graph& graph, const std::string& text, const Names& names, std::span<const Node> nodes);

struct ParsedFormula {
  FormulaValue value;
  /// Nodes of the vector norms in the formula: square roots that are defined for all arguments.
  std::vector<Node> norms;
};
/// Parses a formula whose value and whose variables may be scalars, vectors, rotations or frames. Throws
/// std::invalid_argument with a message that gives the position of the error if `text` is not a valid formula.
/// @param value_of  the value of a name, by its index in `names`
ParsedFormula parse_formula(Graph& graph, const std::string& text, const Names& names,
                            const std::function<FormulaValue(std::size_t)>& value_of);

}  // namespace pkm::expression
