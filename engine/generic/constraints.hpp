// Constraints of a feasible pose in one working mode, for workspace analyses.
#pragma once

#include <string>

#include "engine/generic/model.hpp"

namespace pkm::generic {

/// The constraints as nodes of a separate graph, in which the signs of the working mode are constants.
struct PoseConstraints {
  Graph graph;
  /// Constraints, each satisfied if >= 0, in the order Model::domains, Model::margins, Model::defined.
  std::vector<Node> all;
  std::vector<CrankRangeNodes> crank_ranges;
  std::vector<AnnulusNodes> annuli;
  std::vector<RodAndPathNodes> paths;
  /// Lower and upper bound of the range that is searched, by coordinate; std::nullopt if the file does not define it.
  std::vector<std::optional<std::array<Node, 2>>> box;
};

/// The constraints of a model in one working mode.
PoseConstraints constraints_of(const Model& model, std::size_t mode);

/// A constraint that is not finite is violated, but its polynomial normal form along some coordinates does not show
/// this for subexpressions that are constant along them. For each of these subexpressions this function returns a
/// constraint, 0 times the subexpression, which is satisfied if it is finite.
/// @param along  input groups of these coordinates
std::vector<Node> finiteness_constraints(Graph& graph, Node constraint, Groups along);

/// Name of a constraint, for messages.
/// @param constraint  index in PoseConstraints::all
std::string constraint_name(const Model& model, std::size_t constraint);

}  // namespace pkm::generic
