// Constraints of a feasible pose in one working mode, for workspace analyses.
#pragma once

#include <string>

#include "engine/generic/model.hpp"

namespace pkm::generic {

/// The constraints of a feasible pose as nodes of a separate graph, in which the signs of the working mode are
/// constants.
struct PoseConstraints {
  Graph graph;
  /// Constraints, each satisfied if >= 0, in the order Model::domains, Model::margins, Model::defined.
  std::vector<Node> all;
  std::vector<CrankRangeNodes> crank_ranges;
  std::vector<AnnulusNodes> annuli;
  std::vector<RodAndPathNodes> paths;
  /// Lower and upper bound of the range in which a coordinate is searched, by coordinate; std::nullopt if the mechanism
  /// file does not define it.
  std::vector<std::optional<std::array<Node, 2>>> box;
};

/// The constraints of a model in one working mode.
PoseConstraints constraints_of(const Model& model, std::size_t mode);

/// A constraint that is not finite counts as violated. Its polynomial normal form does not show this for subexpressions
/// that are constant along the coordinate of the polynomials. For each such subexpression that may be infinite or
/// undefined, this function returns the additional constraint 0 * subexpression >= 0, which is satisfied if and only if
/// the subexpression is finite.
/// @param along  input groups of the coordinates along which polynomials are formed
std::vector<Node> finiteness_constraints(Graph& graph, Node constraint, Groups along);

/// Name of a constraint, for messages.
/// @param constraint  index in PoseConstraints::all
std::string constraint_name(const Model& model, std::size_t constraint);

}  // namespace pkm::generic
