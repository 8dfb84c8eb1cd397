// Parser of formulas: converts text into nodes of an expression graph.
#pragma once

#include <span>
#include <string>

#include "engine/expression/graph.hpp"
#include "engine/expression/symbol_table.hpp"

namespace pkm::expression {

/// Parses a formula; see engine/expression/formula.hpp for the syntax. Throws std::invalid_argument with a message that
/// gives the position of the error if `text` is not a valid formula.
/// @param names  variables that the formula may use; see may_be_name()
/// @param nodes  the node of each variable
/// @return the node of the formula's value
Node read_formula(Graph& graph, const std::string& text, const Names& names, std::span<const Node> nodes);

}  // namespace pkm::expression
