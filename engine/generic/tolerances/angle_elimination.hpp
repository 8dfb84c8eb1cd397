// Elimination of inverse trigonometric functions from the sines and cosines of angles, for tighter enclosures without
// branch cuts.
#pragma once

#include <functional>
#include <vector>

#include "engine/expression/graph.hpp"

namespace pkm::generic {

/// Rewrites the sine and cosine of angles that are given by inverse functions, their sums and differences:
///
///     sin(atan2(y, x))     y / sqrt(x^2 + y^2)             cos(atan2(y, x))    x / sqrt(x^2 + y^2)
///     sin(acos(u))         sqrt(1 - u^2)                   cos(asin(u))        sqrt(1 - u^2)
///     sin(a + wrap(b - a)) sin(b)                          sin(wrap(a))        sin(a)
///     sin(s a)             s sin(a), for a sign s
///
/// The values are the same wherever the new formula is defined.
/// @param is_sign  whether a node is a sign, -1 or 1
/// @param roots    become the rewritten nodes, which are added to the graph
void eliminate_angles(expression::Graph& graph, const std::function<bool(expression::Node)>& is_sign,
                      std::vector<expression::Node>& roots);

}  // namespace pkm::generic
