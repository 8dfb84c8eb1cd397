// Text of the steps of a proof.
#include "engine/workspace/bounds/proof_tree.hpp"

#include <gtest/gtest.h>

namespace pkm::bounds {
namespace {

TEST(ProofTree, WritesBoxesDepthFirstAndTheLowerHalfFirst) {
  ProofTree tree;
  tree.resize(1);
  tree.record(0, {{Step::Kind::satisfied, 2}, {Step::Kind::open}});
  tree.resize(3);
  tree.bisect(0, 1, 1);
  tree.resize(5);
  tree.bisect(2, 0, 3);  // numbers of nodes follow the rounds of the search, not the order of the text
  tree.record(1, {{Step::Kind::split, 0, 5, 9}, {Step::Kind::violated, 3}, {Step::Kind::one_root, 0, 0, 0, 7}});
  tree.record(3, {{Step::Kind::contracted, 4, 5, 6, 7}});
  tree.record(4, {{Step::Kind::violated, 0}});
  std::string text = "boxes\n";
  tree.append_to(text);
  EXPECT_EQ(text, "boxes\nh2 n/1\ns5 9 x3 r7 .\n/0\nt4 5 6 7 .\nx0 .\n");
  EXPECT_GE(tree.bytes(), text.size() - 6);
}

}  // namespace
}  // namespace pkm::bounds
