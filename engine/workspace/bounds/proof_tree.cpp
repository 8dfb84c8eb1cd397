#include "engine/workspace/bounds/proof_tree.hpp"

namespace pkm::bounds {

void ProofTree::split(std::size_t node, std::size_t axis, std::size_t first_child) {
  nodes_[node].axis = axis;
  nodes_[node].first_child = first_child;
}

void ProofTree::note(std::size_t node, const std::vector<Step>& steps) {
  std::string& text = nodes_[node].text;
  for (const Step& step : steps) {
    using Kind = Step::Kind;
    text += static_cast<char>(step.kind);
    const auto add = [&](std::int64_t number) { text += std::to_string(number) + ' '; };
    if (step.kind == Kind::fails || step.kind == Kind::holds || step.kind == Kind::trims)
      add(static_cast<std::int64_t>(step.condition));
    if (step.kind == Kind::trims || step.kind == Kind::splits) {
      add(step.from);
      add(step.to);
    }
    if (step.kind == Kind::trims || step.kind == Kind::has_root) add(step.guess);
  }
  text.shrink_to_fit();
}

std::size_t ProofTree::bytes() const {
  std::size_t bytes = 0;
  for (const Node& node : nodes_) bytes += node.text.size() + 3;
  return bytes;
}

void ProofTree::append_to(std::string& text) const {
  std::vector<std::size_t> left = {0};
  while (!left.empty()) {
    const Node& node = nodes_[left.back()];
    left.pop_back();
    text += node.text;
    if (node.first_child == 0) {
      text += ".\n";
    } else {
      text += '/' + std::to_string(node.axis) + '\n';
      left.push_back(node.first_child + 1);
      left.push_back(node.first_child);
    }
  }
}

}  // namespace pkm::bounds
