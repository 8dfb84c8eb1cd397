#include "engine/generic/columns/critical_value_solver.hpp"

#include <algorithm>
#include <cmath>

namespace pkm::generic {
namespace {

constexpr int kMaxExtrapolations = 18;  // after this many extrapolations, bisection only
// Maximum number of feature keys that occur in different numbers in the slices below and above the critical value, and
// of boundary features with these keys in a slice. If there are more, there are so many pairs that bisection is as
// fast.
constexpr std::size_t kMaxFeatures = 100;

}  // namespace

void CriticalValueSolver::reset(bool features_persist) {
  features_persist_ = features_persist;
  for (Side& side : sides_) {
    side.is_known = false;
    side.count = 0;
  }
  is_root_ = is_signed_ = false;
  last_.reset();
  offset_ = 0;
  extrapolations_ = 0;
}

/// Finds the keys of boundary features that occur in different numbers in the slices below and above the critical value
/// (changed_).
void CriticalValueSolver::compare() {
  for (std::size_t i = 0; i < 2; ++i) {
    keys_[i].clear();
    for (const BoundaryFeature& feature : sides_[i].features)
      if (feature.bounds) keys_[i].push_back(feature.key);
    std::ranges::sort(keys_[i]);
  }
  const auto count = [&](std::size_t side, std::uint64_t key) {
    const auto [first, last] = std::equal_range(keys_[side].begin(), keys_[side].end(), key);
    return last - first;
  };
  changed_.clear();
  for (const Side& side : sides_)
    for (const BoundaryFeature& feature : side.features)
      if (feature.bounds && count(0, feature.key) != count(1, feature.key) && !has_changed(feature)) {
        changed_.push_back(feature.key);
        if (changed_.size() > kMaxFeatures) return;
      }
}

bool CriticalValueSolver::has_changed(const BoundaryFeature& feature) const {
  return std::ranges::find(changed_, feature.key) != changed_.end();
}

/// Stores the boundary features of a slice below or above the critical value.
/// @return true if slices on both sides have been stored and few features differ, so that distances between them can be
///         computed
bool CriticalValueSolver::record(bool is_upper, SliceType type, const BoundaryFeatures& features) {
  Side& side = sides_[is_upper];
  const bool is_other = !side.is_known || side.type != type;
  side.type = type;
  side.is_known = true;
  side.features = features;
  is_upper_ = is_upper;
  if (!sides_[!is_upper].is_known) return false;
  if (is_other) {
    compare();
    for (Side& each : sides_) each.count = 0;
  }
  if (changed_.size() > kMaxFeatures) return false;
  for (std::size_t i = 0; i < 2; ++i) {
    changed_features_[i].clear();
    for (const BoundaryFeature& feature : sides_[i].features)
      if (has_changed(feature)) changed_features_[i].push_back(feature);
    if (changed_features_[i].size() > kMaxFeatures) return false;
  }
  return true;
}

void CriticalValueSolver::add_size(double at, bool is_upper, double size) {
  is_signed_ = true;
  is_upper_ = is_upper;
  add(sides_[0], {at, size});
}

/// In the last sample, the minimum distance of two features among those whose keys occur in different numbers below and
/// above the critical value; infinity if there are no such pairs. It has a sign if exactly two keys differ and the
/// features still exist beyond the critical value.
double CriticalValueSolver::distance_of_two() {
  const BoundaryFeatures& features = changed_features_[is_upper_];
  const bool are_two = changed_.size() == 2;
  double least = kUnknown, size = least;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const BoundaryFeature& x = features[i];
    for (std::size_t j = i + 1; j < features.size(); ++j) {
      const BoundaryFeature& y = features[j];
      const bool bound = x.bounds && y.bounds, like_root = x.of == y.of;
      const bool may_meet =
          features_persist_ ? like_root ? bound : x.key != y.key && (bound || are_two) : !like_root || x.key == y.key;
      if (!may_meet) continue;
      const double distance = std::hypot(x.t - y.t, x.s - y.s);
      if (!(distance > 0 && distance < least)) continue;
      least = distance;
      is_root_ = like_root;
      is_signed_ = features_persist_ && are_two && !like_root;
      size = is_signed_ ? (x.key == changed_[0] ? 1 : -1) * (x.t - y.t) : distance;
    }
  }
  return size;
}

double CriticalValueSolver::nearer(double size, double other) {
  if (!(other < size)) return size;
  is_root_ = false;
  return other;
}

void CriticalValueSolver::add(Side& side, Point point) {
  Side& to = is_signed_ ? sides_[0] : side;
  if (to.count == 3) std::shift_left(to.points.begin(), to.points.end(), 1);
  to.points[static_cast<std::size_t>(std::min(to.count, 2))] = point;
  to.count = std::min(to.count + 1, 3);
}

/// Extrapolates the size of the degenerating feature from the samples on one side.
/// @return value of the coordinate in (low, high) at which it is zero; std::nullopt if there is none
std::optional<double> CriticalValueSolver::zero_between(double low, double high, bool is_upper) {
  const Side& side = sides_[is_signed_ ? 0 : is_upper];
  if (side.count < 2) return {};
  const auto through = [](const Point& p, const Point& q, bool is_root) {
    const double at_p = is_root ? p.size * p.size : p.size, at_q = is_root ? q.size * q.size : q.size;
    return q.at - at_q * (q.at - p.at) / (at_q - at_p);
  };
  const Point* const last = &side.points[static_cast<std::size_t>(side.count - 1)];
  if (side.count == 3 && !is_signed_) {
    // Choose the model, linear or square root, that predicts the last of three samples better from the first two.
    const auto off = [&](bool is_root) {
      const double at = through(last[-2], last[-1], is_root), whole = at - last[-1].at, rest = at - last->at;
      const double ratio = last->size / last[-1].size;
      return std::fabs((is_root ? ratio * ratio : ratio) - rest / whole);
    };
    is_root_ = off(true) < off(false);
  }
  const double at = through(last[-1], *last, is_root_);
  if (!(at > low && at < high)) return {};
  return at;
}

double CriticalValueSolver::next_sample(double low, double high, double tolerance) {
  const double middle = 0.5 * (low + high);
  if (extrapolations_ >= kMaxExtrapolations) return middle;
  bool is_upper = is_upper_;
  std::optional<double> at = zero_between(low, high, is_upper);
  if (!at) at = zero_between(low, high, is_upper = !is_upper);
  if (++extrapolations_ % 6 == 0) return middle;
  if (!at) {
    // The extrapolated value was close to one end of the bracket, but the slice there had another type: move away from
    // this end in increasing steps.
    if (!last_ || offset_ == 0) return middle;
    offset_ = std::fmax(16 * offset_, tolerance);
    const double beyond = *last_ - low < high - *last_ ? low + offset_ : high - offset_;
    return beyond > low && beyond < high ? beyond : middle;
  }
  // Take the next sample on the side of the extrapolated value on which the feature exists, at a distance equal to the
  // estimated error. Once the bracket is as small as this distance, take it on the opposite side.
  const double from = is_upper ? high : low, there = std::fabs(*at - from);
  const double off = std::fmax(last_ ? std::fmin(std::fabs(*at - *last_), 0.1 * there) : 0.1 * there, 0.5 * tolerance);
  last_ = at;
  offset_ = off;
  const double back = is_upper == (there > 2 * off) ? off : -off;
  return std::fmax(low + 0.25 * tolerance, std::fmin(high - 0.25 * tolerance, *at + back));
}

}  // namespace pkm::generic
