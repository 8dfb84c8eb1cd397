// The proof of a volume's bounds as text, which another program checks (experiments/checker): what is given, the
// conditions as formulas, the bounds, and what was found of each box. experiments/checker/README.md has the format.
#pragma once

#include <string>
#include <vector>

#include "engine/workspace/bounds/volume_bounds.hpp"

namespace pkm::bounds {

/// What a proof is of.
struct Statement {
  const expression::Graph& graph;
  const Conditions& conditions;        ///< of the graph
  std::vector<std::string> axes;       ///< names, the innermost last
  std::vector<std::size_t> positions;  ///< of the graph's inputs that they are
  Ranges ranges;
  std::vector<Interval> inputs;          ///< of the graph
  std::vector<std::string> input_names;  ///< for people; "" where there is none
  std::string title;
};

/// Throws std::runtime_error where the text would be longer than 100 MB.
std::string proof_text(const Statement& statement, const VolumeBounds& bounds, const ProofTree& tree);

}  // namespace pkm::bounds
