#include "engine/workspace/bounds/proof_tree.hpp"

namespace pkm::bounds {

void ProofTree::bisect(std::size_t node, std::size_t axis, std::size_t first_child) {
  nodes_[node].axis = axis;
  nodes_[node].first_child = first_child;
}

void ProofTree::record(std::size_t node, const std::vector<Step>& steps) {
  std::string& text = nodes_[node].text;
  for (const Step& step : steps) {
    using Kind = Step::Kind;
    text += static_cast<char>(step.kind);
    const auto add = [&](std::int64_t number) { text += std::to_string(number) + ' '; };
    if (step.kind == Kind::violated || step.kind == Kind::satisfied || step.kind == Kind::contracted)
      add(static_cast<std::int64_t>(step.constraint));
    if (step.kind == Kind::contracted || step.kind == Kind::split) {
      add(step.from);
      add(step.to);
    }
    if (step.kind == Kind::contracted || step.kind == Kind::one_root) add(step.expansion);
  }
  text.shrink_to_fit();
}

std::size_t ProofTree::bytes() const {
  std::size_t bytes = 0;
  for (const Node& node : nodes_) bytes += node.text.size() + 3;
  return bytes;
}

void ProofTree::append_to(std::string& text) const {
  std::vector<std::size_t> stack = {0};
  while (!stack.empty()) {
    const Node& node = nodes_[stack.back()];
    stack.pop_back();
    text += node.text;
    if (node.first_child == 0) {
      text += ".\n";
    } else {
      text += '/' + std::to_string(node.axis) + '\n';
      stack.push_back(node.first_child + 1);
      stack.push_back(node.first_child);
    }
  }
}

}  // namespace pkm::bounds
