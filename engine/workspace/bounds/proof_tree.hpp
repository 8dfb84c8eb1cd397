// What was found of each box, in the order of their halving: the greater part of a proof.
#pragma once

#include <string>
#include <vector>

#include "engine/workspace/bounds/column_box.hpp"

namespace pkm::bounds {

/// The boxes and what was found of each, as the proof has them.
class ProofTree {
 public:
  /// Nodes below one, whose sides along `axis` are halves of its.
  void split(std::size_t node, std::size_t axis, std::size_t first_child);
  void resize(std::size_t nodes) { nodes_.resize(nodes); }
  std::size_t size() const { return nodes_.size(); }
  void note(std::size_t node, const std::vector<Step>& steps);
  std::size_t bytes() const;
  void append_to(std::string& text) const;

 private:
  struct Node {
    std::string text;
    std::size_t axis = 0, first_child = 0;  ///< 0: none
  };
  std::vector<Node> nodes_;
};

}  // namespace pkm::bounds
