// Non-dominated sorting and an incrementally maintained non-dominated set. All scores are minimised; a design dominates
// another if it is not worse in any score and better in at least one (Pareto dominance).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/problem/front.hpp"

namespace pkm {

/// Indices of the designs in lexicographic order of their scores; designs with equal scores by ascending index.
std::vector<std::uint32_t> lexicographic_order(const Scores& scores);

/// Efficient non-dominated sort with binary search (ENS-BS, Zhang et al. 2015). No design dominates the members of
/// front 0; every member of front k is dominated by a member of front k - 1. Designs with equal scores share a front.
///
/// The designs are inserted in lexicographic order, in which a later design cannot dominate an earlier one, each into
/// the first front that does not weakly dominate it. That test uses a running minimum for 2 objectives, O(n log n) in
/// all, a sorted staircase for 3, O(n log^2 n) plus the insertions into the staircase, and pairwise comparisons for
/// more.
/// @param front  receives the front index of each design
void non_dominated_sort(const Scores& scores, std::vector<std::uint32_t>& front);

/// The non-dominated designs among all that were added, each with an identifier, in lexicographic order of their
/// scores. Of designs with equal scores, the one added first is kept.
class NonDominatedSet {
 public:
  /// @param limit  maximum size, to which a larger set is truncated by crowding distance (crowding.hpp); 0: unlimited
  explicit NonDominatedSet(std::size_t objectives, std::size_t limit = 0) : limit_(limit), scores_{objectives} {}

  /// Adds designs, given by their scores; `ids` has one identifier for each row of `scores`.
  /// @return true if at least one of them became a member of the non-dominated set
  bool add(const Scores& scores, std::span<const std::int64_t> ids);

  std::size_t size() const { return ids_.size(); }
  const Scores& scores() const { return scores_; }
  const std::vector<std::int64_t>& ids() const { return ids_; }

 private:
  std::size_t limit_;
  Scores scores_, merged_;
  std::vector<std::int64_t> ids_, merged_ids_;
};

}  // namespace pkm
