// Conditions under which a matrix of formulas has full rank, as formulas.
#pragma once

#include <vector>

#include "engine/workspace/bounds/pose_box.hpp"

namespace pkm::generic {

/// Formulas that all differ from 0 if and only if a matrix has full column rank: det A, or det(A^T A) if it has more
/// rows than columns; for a square diagonal matrix its diagonal elements.
/// @param graph  graph of the matrix elements, to which the formulas are added
std::vector<expression::Node> rank_conditions(expression::Graph& graph, const bounds::NamedMatrix& matrix);

}  // namespace pkm::generic
