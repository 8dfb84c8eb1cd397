// Constraints of a feasible pose in one working mode, for workspace analyses.
#pragma once

#include <string>

#include "engine/generic/model.hpp"

namespace pkm::generic {

/// Nodes of a graph of their own, in which the signs of the working mode are constants.
struct PoseConstraints {
  Graph graph;
  std::vector<Node> all;  ///< satisfied if >= 0: Model::domains, margins, defined
  std::vector<CrankRangeNodes> crank_ranges;
  std::vector<AnnulusNodes> annuli;
  std::vector<RodAndPathNodes> paths;
  std::vector<std::optional<std::array<Node, 2>>> box;  ///< by coordinate
};

PoseConstraints constraints_of(const Model& model, std::size_t mode);

/// Constraints that are satisfied if all subexpressions of a constraint that do not depend on some coordinates are
/// finite: 0 times the subexpression. The polynomial normal form along these coordinates requires them in addition,
/// because a constraint that is not finite is violated.
/// @param along  groups of the coordinates
std::vector<Node> finiteness_constraints(Graph& graph, Node constraint, Groups along);

/// @param constraint  index in PoseConstraints::all
std::string constraint_name(const Model& model, std::size_t constraint);

}  // namespace pkm::generic
