#include "engine/mechanisms/described/columns/column_event.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace pkm::described {

void ColumnEvent::set_below(const std::vector<EndLabel>& corners) {
  below_ = corners;
  std::ranges::sort(below_);
  known_.clear();
  guesses_ = 0;
}

void ColumnEvent::set_above(const std::vector<EndLabel>& corners) {
  above_ = corners;
  std::ranges::sort(above_);
  different_.clear();
  std::ranges::set_symmetric_difference(below_, above_, std::back_inserter(different_));
  is_known_ = different_.size() == 2 && different_[0] != different_[1];
  if (!is_known_) return;
  p_ = different_[0];
  q_ = different_[1];
  is_square_ = p_ >> 1U == q_ >> 1U;
}

void ColumnEvent::take(double at, const Ends& ends, const std::vector<EndLabel>& corners) {
  if (!is_known_) return;
  const auto has = [&](EndLabel label) { return std::ranges::find(corners, label) != corners.end(); };
  if (is_square_ && !(has(p_) && has(q_))) return;
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [s, p] : ends)
    for (const auto& [r, q] : ends)
      if (p == p_ && q == q_ && std::fabs(r - s) < std::fabs(nearest)) nearest = r - s;
  if (std::isfinite(nearest)) known_.push_back({at, is_square_ ? nearest * nearest : nearest});
}

double ColumnEvent::guess(double low, double high, double near) {
  const double middle = 0.5 * (low + high);
  if (known_.size() < 2 || ++guesses_ % 6 == 0) return middle;
  const Known &x = known_[known_.size() - 2], &y = known_.back();
  const double at = y.at - y.distance * (y.at - x.at) / (y.distance - x.distance);
  if (!(at >= low && at <= high)) return middle;
  return std::fmax(low + 0.5 * near, std::fmin(high - 0.5 * near, at));
}

}  // namespace pkm::described
