#include "engine/optimisers/dominance.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/team_sort.hpp"
#include "engine/optimisers/crowding.hpp"

namespace pkm {
namespace {

bool equal(const double* a, const double* b, std::size_t objectives) { return std::equal(a, a + objectives, b); }

bool lexicographically_less(const double* a, const double* b, std::size_t objectives) {
  return std::lexicographical_compare(a, a + objectives, b, b + objectives);
}

// Each of the three classes below represents one front during a scan in lexicographic order, and answers whether one of
// its members weakly dominates (dominates or equals) the next design. The first score of the next design is never
// smaller than the members' first scores, so only the other scores are compared.

/// A front for 2 objectives: stores the minimum of the second score, which is that of the last member.
struct RunningMinimum {
  explicit RunningMinimum(std::size_t) {}
  bool weakly_dominates(const double* p) const { return any && minimum <= p[1]; }
  void add(const double* p) {
    any = true;
    minimum = p[1];
  }
  bool any = false;
  double minimum = 0;
};

/// A front for 3 objectives: stores the non-dominated pairs of second and third score, sorted by ascending second and
/// therefore descending third score.
struct Staircase {
  explicit Staircase(std::size_t) {}
  bool weakly_dominates(const double* p) const {
    const auto after = std::upper_bound(steps.begin(), steps.end(), p[1],
                                        [](double value, const std::array<double, 2>& s) { return value < s[0]; });
    return after != steps.begin() && (*(after - 1))[1] <= p[2];
  }
  void add(const double* p) {
    const auto from = std::lower_bound(steps.begin(), steps.end(), p[1],
                                       [](const std::array<double, 2>& s, double value) { return s[0] < value; });
    auto to = from;
    while (to != steps.end() && (*to)[1] >= p[2]) ++to;
    if (from == to) {
      steps.insert(from, {p[1], p[2]});
    } else {
      *from = {p[1], p[2]};
      steps.erase(from + 1, to);
    }
  }
  std::vector<std::array<double, 2>> steps;
};

/// A front for any number of objectives: stores all members and compares them one by one, starting with the last, which
/// is the most likely to dominate.
struct MemberList {
  explicit MemberList(std::size_t objectives) : n(objectives) {}
  bool weakly_dominates(const double* p) const {
    return std::any_of(list.rbegin(), list.rend(), [&](const double* m) {
      for (std::size_t k = 1; k < n; ++k)
        if (m[k] > p[k]) return false;
      return true;
    });
  }
  void add(const double* p) { list.push_back(p); }
  std::size_t n;
  std::vector<const double*> list;
};

template <class Front>
void sort_into_fronts(const Scores& scores, std::vector<std::uint32_t>& front) {
  const std::size_t m = scores.objectives;
  const std::vector<std::uint32_t> order = lexicographic_order(scores);
  front.resize(order.size());
  std::vector<Front> fronts;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t row = order[i];
    const double* p = scores[row];
    if (i > 0 && equal(p, scores[order[i - 1]], m)) {
      front[row] = front[order[i - 1]];
      continue;
    }
    const auto found =
        std::partition_point(fronts.begin(), fronts.end(), [&](const Front& f) { return f.weakly_dominates(p); });
    front[row] = static_cast<std::uint32_t>(found - fronts.begin());
    if (found == fronts.end())
      fronts.emplace_back(m).add(p);
    else
      found->add(p);
  }
}

/// Merges the old members of a non-dominated set with new designs. Calls keep(is_new, index) for each design
/// that no other one dominates, in lexicographic order of the scores. If scores are equal, an old member precedes a new
/// design.
/// @param order  indices of the new designs, in lexicographic order of their scores
template <class Front, class Keep>
void merge_non_dominated(const Scores& old, const Scores& fresh, const std::vector<std::uint32_t>& order,
                         const Keep& keep) {
  const std::size_t m = old.objectives;
  Front all(m), added(m);
  std::size_t i = 0, j = 0;
  while (i < old.size() || j < order.size()) {
    const bool is_new = i == old.size() || (j < order.size() && lexicographically_less(fresh[order[j]], old[i], m));
    const double* p = is_new ? fresh[order[j]] : old[i];
    if (!(is_new ? all : added).weakly_dominates(p)) {
      all.add(p);
      if (is_new) added.add(p);
      keep(is_new, is_new ? order[j] : i);
    }
    ++(is_new ? j : i);
  }
}

/// Calls work.template operator()<Front>(), where Front is RunningMinimum for two objectives, Staircase for three and
/// MemberList for more.
template <class Work>
void dispatch_front_type(std::size_t objectives, const Work& work) {
  if (objectives == 2)
    work.template operator()<RunningMinimum>();
  else if (objectives == 3)
    work.template operator()<Staircase>();
  else
    work.template operator()<MemberList>();
}

}  // namespace

std::vector<std::uint32_t> lexicographic_order(const Scores& scores) {
  // Pairs of the first score of a design and its index. Storing the score here avoids most accesses to `scores` in
  // comparisons.
  std::vector<std::pair<double, std::uint32_t>> order(scores.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = {scores[i][0], static_cast<std::uint32_t>(i)};
  parallel_sort(order, 0, [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const double *p = scores[a.second], *q = scores[b.second];
    return equal(p, q, scores.objectives) ? a.second < b.second : lexicographically_less(p, q, scores.objectives);
  });
  std::vector<std::uint32_t> rows;
  for (const auto& [score, row] : order) rows.push_back(row);
  return rows;
}

void non_dominated_sort(const Scores& scores, std::vector<std::uint32_t>& front) {
  dispatch_front_type(scores.objectives, [&]<class Front> { sort_into_fronts<Front>(scores, front); });
}

bool NonDominatedSet::add(const Scores& scores, std::span<const std::int64_t> ids) {
  const std::size_t m = scores_.objectives;
  const std::vector<std::uint32_t> order = lexicographic_order(scores);
  bool changed = false;
  merged_.objectives = m;
  merged_.clear();
  merged_ids_.clear();
  const auto keep = [&](bool is_new, std::size_t i) {
    merged_.add({(is_new ? scores : scores_)[i], m});
    merged_ids_.push_back(is_new ? ids[i] : ids_[i]);
    changed = changed || is_new;
  };
  dispatch_front_type(m, [&]<class Front> { merge_non_dominated<Front>(scores_, scores, order, keep); });
  if (!changed) return false;
  std::swap(scores_, merged_);
  std::swap(ids_, merged_ids_);
  if (limit_ == 0 || ids_.size() <= limit_) return true;

  std::vector<std::uint32_t> survivors = order_by_crowding(scores_, limit_);
  survivors.resize(limit_);
  std::sort(survivors.begin(), survivors.end());
  merged_.clear();
  merged_ids_.clear();
  for (const std::uint32_t i : survivors) keep(false, i);
  std::swap(scores_, merged_);
  std::swap(ids_, merged_ids_);
  return true;
}

}  // namespace pkm
