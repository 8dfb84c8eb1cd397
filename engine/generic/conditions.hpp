// What has to hold at a pose of one working mode, for those who survey workspaces.
#pragma once

#include <string>

#include "engine/generic/model.hpp"

namespace pkm::generic {

/// Nodes of a graph of their own, in which the signs of the mode are numbers.
struct Conditions {
  Graph graph;
  std::vector<Node> all;             ///< >= 0 where it holds: domains, margins, and where formulas have a value
  std::vector<CoveredRange> cranks;  ///< what says the same as some of them
  std::vector<CoveredFolds> folds;   ///< the same
  std::vector<std::optional<std::array<Node, 2>>> box;  ///< by coordinate
};

Conditions conditions_of(const Model& model, std::size_t mode);

/// Conditions that are satisfied where what a condition computes without the coordinates `along` is finite: 0 times it.
/// A condition that is taken apart into polynomials along those needs them beside the polynomials.
std::vector<Node> finite_parts(Graph& graph, Node condition, Groups along);

/// The name of a model's condition, by its place in Conditions::all.
std::string name_of_condition(const Model& model, std::size_t condition);

}  // namespace pkm::generic
