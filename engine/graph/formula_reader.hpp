// A formula's text as nodes of a graph.
#pragma once

#include <span>
#include <string>

#include "engine/graph/graph.hpp"
#include "engine/graph/names.hpp"

namespace pkm::graph {

/// Throws std::invalid_argument with a sentence that names the place when the text is no formula of these names.
/// @param names  letters, digits and '_', each once, none that a formula knows anyway (may_be_name)
/// @param nodes  what each of them is
Node read_formula(Graph& graph, const std::string& text, const Names& names, std::span<const Node> nodes);

}  // namespace pkm::graph
