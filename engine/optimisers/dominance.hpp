// Order among designs that are judged by several numbers. All scores are to be minimised; a design dominates another
// when it is nowhere worse and somewhere better.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/problem/front.hpp"

namespace pkm {

/// The designs in lexicographic order of their scores; of equal ones the first comes first.
std::vector<std::uint32_t> in_order(const Scores& scores);

/// Non-dominated sorting: front 0 is dominated by nobody, front k only by members of the fronts before it. Designs with
/// equal scores share a front. Each is put into the first front that does not cover it, found by bisection (Zhang et
/// al. 2015), in an order in which later ones cannot dominate earlier ones; what a front covers is read from a
/// staircase of one or two scores: O(n log n) for 2 objectives, O(n log^2 n) but for moving the steps for 3, and
/// pairwise comparison for more.
/// @param front  receives the number of each row's front
void sort_fronts(const Scores& scores, std::vector<std::uint32_t>& front);

/// All non-dominated designs of those it was given, each with an identity: in the order of their scores, the first one
/// first. Of designs with equal scores it keeps the one that came first.
class Archive {
 public:
  /// @param limit  most members; more are thinned out to it (see diversity.hpp). 0: no limit
  explicit Archive(std::size_t objectives, std::size_t limit = 0) : limit_(limit), scores_{objectives} {}

  /// Adds designs, `scores` and `ids` alike in length. Returns whether any of them became a member.
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
