#include "engine/optimisers/diversity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pkm {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Designs by their first score, linked to the next ones that are still there.
class Line {
 public:
  /// @param seen  the same scores in the units in which designs lie apart
  Line(const Scores& scores, const Scores& seen) : order_(in_order(scores)), scores_{scores.objectives} {
    const std::size_t n = order_.size();
    for (const std::uint32_t i : order_) scores_.add({seen[i], seen.objectives});
    before_.resize(n);
    after_.resize(n);
    for (std::size_t at = 0; at < n; ++at) {
      before_[at] = at - 1;  // wraps to kNone
      after_[at] = at + 1 < n ? at + 1 : kNone;
    }
    there_.assign(n, 1);
  }

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  std::size_t size() const { return order_.size(); }
  std::size_t objectives() const { return scores_.objectives; }
  const Scores& scores() const { return scores_; }
  std::uint32_t index(std::size_t at) const { return order_[at]; }
  const double* score(std::size_t at) const { return scores_[at]; }
  std::size_t before(std::size_t at) const { return before_[at]; }
  std::size_t after(std::size_t at) const { return after_[at]; }
  bool there(std::size_t at) const { return there_[at] != 0; }
  void remove(std::size_t at) {
    if (before_[at] != kNone) after_[before_[at]] = after_[at];
    if (after_[at] != kNone) before_[after_[at]] = before_[at];
    there_[at] = 0;
  }

 private:
  std::vector<std::uint32_t> order_;
  Scores scores_;  ///< in that order
  std::vector<std::size_t> before_, after_;
  std::vector<std::uint8_t> there_;
};

/// 2 scores: the area that only this design dominates.
double area_of(const Line& line, std::size_t at) {
  const std::size_t b = line.before(at), a = line.after(at);
  if (b == Line::kNone || a == Line::kNone) return kInfinite;
  const double* p = line.score(at);
  return (line.score(a)[0] - p[0]) * (line.score(b)[1] - p[1]);
}

/// The designs nearest to each, for normalised lines.
class Neighbours {
 public:
  /// @param remembered  how many are looked for at once
  Neighbours(const Line& line, std::size_t remembered)
      : line_(line), most_(remembered), near_(line.size() * remembered), count_(line.size()) {
    for (std::size_t at = 0; at < line.size(); ++at) search(at);
  }

  /// Product of the squared distances to the nearest `wanted` that are still there.
  double product(std::size_t at, std::size_t wanted) {
    for (const bool again : {false, true}) {
      double product = 1;
      std::size_t found = 0;
      for (std::size_t i = 0; i < count_[at] && found < wanted; ++i) {
        const Near& near = near_[at * most_ + i];
        if (!line_.there(near.at)) continue;
        product *= near.square;
        ++found;
      }
      if (found == wanted || again) return product;
      search(at);
    }
    return 0;
  }

 private:
  struct Near {
    std::size_t at;
    double square;
  };

  double square(std::size_t a, std::size_t b) const {
    double sum = 0;
    for (std::size_t k = 0; k < line_.objectives(); ++k) {
      const double d = line_.score(a)[k] - line_.score(b)[k];
      sum += d * d;
    }
    return sum;
  }

  /// Outwards along the first score, until that alone is farther than the farthest that is remembered.
  void search(std::size_t at) {
    Near* near = &near_[at * most_];
    std::size_t found = 0, left = line_.before(at), right = line_.after(at);
    const auto apart = [&](std::size_t other) {
      if (other == Line::kNone) return kInfinite;
      const double d = line_.score(other)[0] - line_.score(at)[0];
      return d * d;
    };
    double to_left = apart(left), to_right = apart(right), limit = kInfinite;
    while (std::min(to_left, to_right) < limit) {
      const bool leftwards = to_left <= to_right;
      const std::size_t other = leftwards ? left : right;
      if (leftwards)
        to_left = apart(left = line_.before(left));
      else
        to_right = apart(right = line_.after(right));
      const double distance = square(at, other);
      if (distance >= limit) continue;
      if (found < most_) ++found;
      std::size_t i = found - 1;
      for (; i > 0 && near[i - 1].square > distance; --i) near[i] = near[i - 1];
      near[i] = {other, distance};
      if (found == most_) limit = near[most_ - 1].square;
    }
    count_[at] = found;
  }

  const Line& line_;
  std::size_t most_;
  std::vector<Near> near_;
  std::vector<std::size_t> count_;
};

/// Removes the most crowded one again and again. Room only grows while others are removed, so a queue with outdated
/// entries is in order once the entry at its front has been brought up to date.
/// @param room  room(at) of a design, among those that are still there
template <class Room>
std::vector<std::uint32_t> by_room(Line& line, std::size_t keep, const Room& room) {
  struct Entry {
    double room;
    std::size_t at;
  };
  const auto later = [&](const Entry& a, const Entry& b) {
    return a.room != b.room ? a.room > b.room : line.index(a.at) < line.index(b.at);
  };
  std::vector<Entry> queue;
  queue.reserve(line.size());
  for (std::size_t at = 0; at < line.size(); ++at) queue.push_back({room(at), at});
  std::vector<std::uint32_t> order;
  order.reserve(line.size());
  if (queue.size() > keep) std::make_heap(queue.begin(), queue.end(), later);
  while (queue.size() > keep) {
    std::pop_heap(queue.begin(), queue.end(), later);
    Entry& last = queue.back();
    const double now = last.room == kInfinite ? kInfinite : room(last.at);
    if (now > last.room) {
      last.room = now;
      std::push_heap(queue.begin(), queue.end(), later);
      continue;
    }
    order.push_back(line.index(last.at));
    line.remove(last.at);
    queue.pop_back();
  }
  for (Entry& kept : queue) kept.room = room(kept.at);
  std::sort(queue.begin(), queue.end(), [&](const Entry& a, const Entry& b) { return later(b, a); });
  for (const Entry& kept : queue) order.push_back(line.index(kept.at));
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

std::vector<std::uint32_t> most_diverse(const Scores& scores, std::size_t keep) {
  if (scores.size() == 0) return {};
  const std::size_t objectives = scores.objectives;
  Line line(scores, objectives == 2 ? scores : normalised(scores));
  if (objectives == 2) return by_room(line, keep, [&](std::size_t at) { return area_of(line, at); });
  std::vector<std::uint8_t> best(line.size(), 0);
  for (const std::size_t end : ends_of(line.scores())) best[end] = 1;
  Neighbours nearest(line, 3 * objectives);
  return by_room(line, keep, [&](std::size_t at) { return best[at] ? kInfinite : nearest.product(at, objectives); });
}

double spread(const Scores& scores) {
  if (scores.size() < 3) return std::numeric_limits<double>::quiet_NaN();
  const Line line(scores, normalised(scores));
  Neighbours nearest(line, 1);
  std::vector<double> distances;
  double sum = 0, deviation = 0;
  for (std::size_t at = 0; at < line.size(); ++at) sum += distances.emplace_back(std::sqrt(nearest.product(at, 1)));
  const double mean = sum / static_cast<double>(distances.size());
  for (const double d : distances) deviation += std::fabs(d - mean);
  return mean > 0 ? deviation / sum : 0;
}

}  // namespace pkm
