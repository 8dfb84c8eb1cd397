#include "engine/optimisers/dominance.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/team_sort.hpp"
#include "engine/optimisers/diversity.hpp"

namespace pkm {
namespace {

bool equal(const double* a, const double* b, std::size_t objectives) { return std::equal(a, a + objectives, b); }

bool before(const double* a, const double* b, std::size_t objectives) {
  return std::lexicographical_compare(a, a + objectives, b, b + objectives);
}

// What a front covers of the designs that come after its members in lexicographic order: those that a member dominates
// or equals. The first score of a later design is never less, so only the others count.

/// 2 objectives: the last member has the least second score.
struct Step {
  explicit Step(std::size_t) {}
  bool covers(const double* p) const { return any && least <= p[1]; }
  void add(const double* p) {
    any = true;
    least = p[1];
  }
  bool any = false;
  double least = 0;
};

/// 3 objectives: the minimal pairs of the second and third score, the second ascending, the third descending.
struct Staircase {
  explicit Staircase(std::size_t) {}
  bool covers(const double* p) const {
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

/// Any number of objectives: every member. The last ones are the likeliest to cover what comes next.
struct Members {
  explicit Members(std::size_t objectives) : n(objectives) {}
  bool covers(const double* p) const {
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
void sort_by(const Scores& scores, std::vector<std::uint32_t>& front) {
  const std::size_t m = scores.objectives;
  const std::vector<std::uint32_t> order = in_order(scores);
  front.resize(order.size());
  std::vector<Front> fronts;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::uint32_t row = order[i];
    const double* p = scores[row];
    if (i > 0 && equal(p, scores[order[i - 1]], m)) {
      front[row] = front[order[i - 1]];
      continue;
    }
    const auto found = std::partition_point(fronts.begin(), fronts.end(), [&](const Front& f) { return f.covers(p); });
    front[row] = static_cast<std::uint32_t>(found - fronts.begin());
    if (found == fronts.end())
      fronts.emplace_back(m).add(p);
    else
      found->add(p);
  }
}

/// The non-dominated of old members, among which none covers another, and of new ones. Both in lexicographic order;
/// old ones come first where scores are equal. Calls keep(is_new, index) in the order of the result.
template <class Front, class Keep>
void merge_fronts(const Scores& old, const Scores& fresh, const std::vector<std::uint32_t>& order, const Keep& keep) {
  const std::size_t m = old.objectives;
  Front all(m), added(m);
  std::size_t i = 0, j = 0;
  while (i < old.size() || j < order.size()) {
    const bool is_new = i == old.size() || (j < order.size() && before(fresh[order[j]], old[i], m));
    const double* p = is_new ? fresh[order[j]] : old[i];
    if (!(is_new ? all : added).covers(p)) {
      all.add(p);
      if (is_new) added.add(p);
      keep(is_new, is_new ? order[j] : i);
    }
    ++(is_new ? j : i);
  }
}

/// work.template operator()<Front>() for what tells what fronts of so many objectives cover.
template <class Work>
void with_front(std::size_t objectives, const Work& work) {
  if (objectives == 2)
    work.template operator()<Step>();
  else if (objectives == 3)
    work.template operator()<Staircase>();
  else
    work.template operator()<Members>();
}

}  // namespace

std::vector<std::uint32_t> in_order(const Scores& scores) {
  // The first score stands beside the index: most comparisons need no more.
  std::vector<std::pair<double, std::uint32_t>> order(scores.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = {scores[i][0], static_cast<std::uint32_t>(i)};
  sort_with_team(order, 0, [&](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first < b.first;
    const double *p = scores[a.second], *q = scores[b.second];
    return equal(p, q, scores.objectives) ? a.second < b.second : before(p, q, scores.objectives);
  });
  std::vector<std::uint32_t> rows;
  for (const auto& [score, row] : order) rows.push_back(row);
  return rows;
}

void sort_fronts(const Scores& scores, std::vector<std::uint32_t>& front) {
  with_front(scores.objectives, [&]<class Front> { sort_by<Front>(scores, front); });
}

bool Archive::add(const Scores& scores, std::span<const std::int64_t> ids) {
  const std::size_t m = scores_.objectives;
  const std::vector<std::uint32_t> order = in_order(scores);
  bool gained = false;
  merged_.objectives = m;
  merged_.clear();
  merged_ids_.clear();
  const auto keep = [&](bool is_new, std::size_t i) {
    merged_.add({(is_new ? scores : scores_)[i], m});
    merged_ids_.push_back(is_new ? ids[i] : ids_[i]);
    gained = gained || is_new;
  };
  with_front(m, [&]<class Front> { merge_fronts<Front>(scores_, scores, order, keep); });
  if (!gained) return false;
  std::swap(scores_, merged_);
  std::swap(ids_, merged_ids_);
  if (limit_ == 0 || ids_.size() <= limit_) return true;

  std::vector<std::uint32_t> kept = most_diverse(scores_, limit_);
  kept.resize(limit_);
  std::sort(kept.begin(), kept.end());
  merged_.clear();
  merged_ids_.clear();
  for (const std::uint32_t i : kept) keep(false, i);
  std::swap(scores_, merged_);
  std::swap(ids_, merged_ids_);
  return true;
}

}  // namespace pkm
