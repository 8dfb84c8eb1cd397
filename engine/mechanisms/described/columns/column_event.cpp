#include "engine/mechanisms/described/columns/column_event.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace pkm::described {

ColumnEvent::ColumnEvent(std::vector<EndLabel> below, std::vector<EndLabel> above) {
  std::ranges::sort(below);
  std::ranges::sort(above);
  std::vector<EndLabel> different;
  std::ranges::set_symmetric_difference(below, above, std::back_inserter(different));
  if (different.size() != 2 || different[0] == different[1]) return;
  is_known_ = true;
  p_ = different[0];
  q_ = different[1];
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
