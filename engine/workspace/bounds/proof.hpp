// Proof of volume bounds as text, for the independent proof checker (experiments/checker): the bounds, the given
// numbers, the constraints as formulas, and the steps of each box. README.md explains the format with an example.
#pragma once

#include <string>
#include <vector>

#include "engine/workspace/bounds/volume_bounds.hpp"

namespace pkm::bounds {

/// The statement to be proved: bounds of the volume in which all constraints are satisfied.
struct Statement {
  const expression::Graph& graph;
  const Constraints& constraints;        ///< constraints on the graph's inputs
  std::vector<std::string> axes;         ///< names of the axes, the column coordinate last
  std::vector<std::size_t> positions;    ///< for each axis, its index among the graph's inputs
  Ranges ranges;                         ///< range of each axis
  std::vector<Interval> inputs;          ///< values of all inputs of the graph
  std::vector<std::string> input_names;  ///< names of the graph's inputs, for readers of the proof; may be ""
  std::string title;
};

/// Throws std::runtime_error if the text would be longer than 100 MB, or if a number in it is not finite.
std::string proof_text(const Statement& statement, const VolumeBounds& bounds, const ProofTree& tree);

}  // namespace pkm::bounds
