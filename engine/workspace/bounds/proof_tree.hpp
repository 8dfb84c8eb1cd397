// Tree of the bisected boxes with the proof steps of each: the main part of a proof.
#pragma once

#include <string>
#include <vector>

#include "engine/workspace/bounds/column_box.hpp"

namespace pkm::bounds {

/// A node is a box, stored with its proof steps as text; node 0 is the whole search box.
class ProofTree {
 public:
  void resize(std::size_t nodes) { nodes_.resize(nodes); }
  std::size_t size() const { return nodes_.size(); }
  /// Appends proof steps to a node.
  void record(std::size_t node, const std::vector<Step>& steps);
  /// Bisects a node along `axis`. Its lower half is node `first_child`, its upper half the node after that.
  void bisect(std::size_t node, std::size_t axis, std::size_t first_child);
  /// Upper bound of the length of the text that append_to() appends.
  std::size_t bytes() const;
  /// Appends to `text` one line per node, in depth-first order.
  void append_to(std::string& text) const;

 private:
  struct Node {
    std::string text;
    std::size_t axis = 0, first_child = 0;  ///< first_child = 0: the node is a leaf, i.e. its box is not divided
  };
  std::vector<Node> nodes_;
};

}  // namespace pkm::bounds
