#include "engine/optimisers/crowding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pkm {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// The designs of a front sorted by their first score, as a doubly linked list from which designs are removed. A node
/// is a position in the sorted order.
class LinkedFront {
 public:
  /// @param scaled  scores for measuring distances, raw or normalised, indexed like `scores`
  LinkedFront(const Scores& scores, const Scores& scaled)
      : order_(lexicographic_order(scores)), scores_{scores.objectives} {
    const std::size_t n = order_.size();
    for (const std::uint32_t i : order_) scores_.add({scaled[i], scaled.objectives});
    previous_.resize(n);
    next_.resize(n);
    for (std::size_t node = 0; node < n; ++node) {
      previous_[node] = node - 1;  // node 0 has no predecessor: 0 - 1 wraps around to kNone
      next_[node] = node + 1 < n ? node + 1 : kNone;
    }
    present_.assign(n, 1);
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t size() const { return order_.size(); }
  std::size_t objectives() const { return scores_.objectives; }
  const Scores& scores() const { return scores_; }
  std::uint32_t index(std::size_t node) const { return order_[node]; }
  const double* score(std::size_t node) const { return scores_[node]; }
  std::size_t previous(std::size_t node) const { return previous_[node]; }
  std::size_t next(std::size_t node) const { return next_[node]; }
  bool is_present(std::size_t node) const { return present_[node] != 0; }
  void remove(std::size_t node) {
    if (previous_[node] != kNone) next_[previous_[node]] = next_[node];
    if (next_[node] != kNone) previous_[next_[node]] = previous_[node];
    present_[node] = 0;
  }

 private:
  std::vector<std::uint32_t> order_;
  Scores scores_;  ///< scores by which distances are measured; row i belongs to node i
  std::vector<std::size_t> previous_, next_;
  std::vector<std::uint8_t> present_;
};

/// Exclusive hypervolume contribution of a node for 2 scores: the area that no other design dominates.
double exclusive_area(const LinkedFront& front, std::size_t node) {
  const std::size_t b = front.previous(node), a = front.next(node);
  if (b == LinkedFront::kNone || a == LinkedFront::kNone) return kInfinite;
  const double* p = front.score(node);
  return (front.score(a)[0] - p[0]) * (front.score(b)[1] - p[1]);
}

/// Cached nearest neighbours of every node, by Euclidean distance between normalised scores.
class NearestNeighbours {
 public:
  /// @param capacity  number of neighbours that one search finds and caches
  NearestNeighbours(const LinkedFront& front, std::size_t capacity)
      : front_(front), capacity_(capacity), nearest_(front.size() * capacity), count_(front.size()) {
    for (std::size_t node = 0; node < front.size(); ++node) search(node);
  }

  /// Product of the squared distances from a node to its `wanted` nearest neighbours that have not been removed.
  /// Repeats the search if too many of the cached neighbours have been removed.
  double product(std::size_t node, std::size_t wanted) {
    for (const bool again : {false, true}) {
      double product = 1;
      std::size_t found = 0;
      for (std::size_t i = 0; i < count_[node] && found < wanted; ++i) {
        const Neighbour& near = nearest_[node * capacity_ + i];
        if (!front_.is_present(near.node)) continue;
        product *= near.squared_distance;
        ++found;
      }
      if (found == wanted || again) return product;
      search(node);
    }
    return 0;
  }

 private:
  struct Neighbour {
    std::size_t node;
    double squared_distance;
  };

  double squared_distance(std::size_t a, std::size_t b) const {
    double sum = 0;
    for (std::size_t k = 0; k < front_.objectives(); ++k) {
      const double d = front_.score(a)[k] - front_.score(b)[k];
      sum += d * d;
    }
    return sum;
  }

  /// Scans the sorted order outwards from the node, until the difference of the first scores alone exceeds the distance
  /// to the farthest cached neighbour.
  void search(std::size_t node) {
    Neighbour* near = &nearest_[node * capacity_];
    std::size_t found = 0, left = front_.previous(node), right = front_.next(node);
    const auto squared_gap = [&](std::size_t other) {
      if (other == LinkedFront::kNone) return kInfinite;
      const double d = front_.score(other)[0] - front_.score(node)[0];
      return d * d;
    };
    double left_gap = squared_gap(left), right_gap = squared_gap(right), limit = kInfinite;
    while (std::min(left_gap, right_gap) < limit) {
      const bool go_left = left_gap <= right_gap;
      const std::size_t other = go_left ? left : right;
      if (go_left)
        left_gap = squared_gap(left = front_.previous(left));
      else
        right_gap = squared_gap(right = front_.next(right));
      const double distance = squared_distance(node, other);
      if (distance >= limit) continue;
      if (found < capacity_) ++found;
      std::size_t i = found - 1;
      for (; i > 0 && near[i - 1].squared_distance > distance; --i) near[i] = near[i - 1];
      near[i] = {other, distance};
      if (found == capacity_) limit = near[capacity_ - 1].squared_distance;
    }
    count_[node] = found;
  }

  const LinkedFront& front_;
  std::size_t capacity_;
  std::vector<Neighbour> nearest_;
  std::vector<std::size_t> count_;
};

/// Repeatedly removes the design with the smallest crowding distance until `keep` designs are left. Removals only
/// increase the distances of the others, so a priority queue with lazy updates returns the exact minimum.
/// @param distance  distance(node): crowding distance of a node among those that have not been removed
/// @return all designs: the survivors by descending crowding distance, then the removed ones, last removed first
template <class Distance>
std::vector<std::uint32_t> truncate_by_crowding(LinkedFront& front, std::size_t keep, const Distance& distance) {
  struct Entry {
    double distance;
    std::size_t node;
  };
  const auto less_crowded = [&](const Entry& a, const Entry& b) {
    return a.distance != b.distance ? a.distance > b.distance : front.index(a.node) < front.index(b.node);
  };
  std::vector<Entry> queue;
  queue.reserve(front.size());
  for (std::size_t node = 0; node < front.size(); ++node) queue.push_back({distance(node), node});
  std::vector<std::uint32_t> order;
  order.reserve(front.size());
  if (queue.size() > keep) std::make_heap(queue.begin(), queue.end(), less_crowded);
  while (queue.size() > keep) {
    std::pop_heap(queue.begin(), queue.end(), less_crowded);
    Entry& most_crowded = queue.back();
    const double updated = most_crowded.distance == kInfinite ? kInfinite : distance(most_crowded.node);
    if (updated > most_crowded.distance) {
      most_crowded.distance = updated;
      std::push_heap(queue.begin(), queue.end(), less_crowded);
      continue;
    }
    order.push_back(front.index(most_crowded.node));
    front.remove(most_crowded.node);
    queue.pop_back();
  }
  for (Entry& survivor : queue) survivor.distance = distance(survivor.node);
  std::sort(queue.begin(), queue.end(), [&](const Entry& a, const Entry& b) { return less_crowded(b, a); });
  for (const Entry& survivor : queue) order.push_back(front.index(survivor.node));
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

std::vector<std::uint32_t> order_by_crowding(const Scores& scores, std::size_t keep) {
  if (scores.size() == 0) return {};
  const std::size_t objectives = scores.objectives;
  LinkedFront front(scores, objectives == 2 ? scores : normalised(scores));
  if (objectives == 2)
    return truncate_by_crowding(front, keep, [&](std::size_t node) { return exclusive_area(front, node); });
  std::vector<std::uint8_t> is_extreme(front.size(), 0);
  for (const std::size_t end : ends_of(front.scores())) is_extreme[end] = 1;
  NearestNeighbours nearest(front, 3 * objectives);
  return truncate_by_crowding(
      front, keep, [&](std::size_t node) { return is_extreme[node] ? kInfinite : nearest.product(node, objectives); });
}

double spread(const Scores& scores) {
  if (scores.size() < 3) return std::numeric_limits<double>::quiet_NaN();
  const LinkedFront front(scores, normalised(scores));
  NearestNeighbours nearest(front, 1);
  std::vector<double> distances;
  double sum = 0, deviation = 0;
  for (std::size_t node = 0; node < front.size(); ++node)
    sum += distances.emplace_back(std::sqrt(nearest.product(node, 1)));
  const double mean = sum / static_cast<double>(distances.size());
  for (const double d : distances) deviation += std::fabs(d - mean);
  return mean > 0 ? deviation / sum : 0;
}

}  // namespace pkm
