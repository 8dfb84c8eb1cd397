#include "engine/motion/path.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/roots.hpp"

namespace pkm {
namespace {

// Number of intervals of the composite quadrature of the speed over the time; a multiple of 3, for motions whose speed
// has kinks at thirds.
constexpr std::size_t kPanels = 480;
// Minimum distance from the ends of the path, relative to its length, at which derivatives are computed.
constexpr double kFromStop = 1e-7;
constexpr double kTimeAccuracy = 1e-15;  // accuracy of times, relative to the duration of the move

}  // namespace

GeometricPath::GeometricPath(std::shared_ptr<const Motion> motion, const MovePeriod& move)
    : motion_(std::move(motion)) {
  for (std::size_t k = 0; k <= kPanels; ++k) {
    const double fraction = static_cast<double>(k) / kPanels;
    times_.push_back(k == kPanels ? move.end : move.begin + (move.end - move.begin) * fraction);
    lengths_.push_back(k == 0 ? 0 : lengths_.back() + integral(times_[k - 1], times_[k]));
  }
}

double GeometricPath::speed(double time) const {
  const AxisVector<double> velocity = motion_->at(time).velocity;
  return std::sqrt(dot(velocity, velocity));
}

double GeometricPath::integral(double from, double to) const {
  // The following is a Gauss-Legendre rule with four nodes.
  constexpr double kNodes[] = {0.3399810435848563, 0.8611363115940526};
  constexpr double kWeights[] = {0.6521451548625461, 0.3478548451374538};
  const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
  double sum = 0;
  for (int i = 0; i < 2; ++i)
    sum += kWeights[i] * (speed(middle - half * kNodes[i]) + speed(middle + half * kNodes[i]));
  return half * sum;
}

double GeometricPath::length_until(double time) const {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
  const auto k = static_cast<std::size_t>(after - times_.begin()) - 1;
  return lengths_[k] + integral(times_[k], time);
}

double GeometricPath::time_at(double s) const {
  if (s <= 0) return times_.front();
  if (s >= length()) return times_.back();
  const auto after = std::upper_bound(lengths_.begin(), lengths_.end(), s);
  const auto k = static_cast<std::size_t>(after - lengths_.begin());
  const auto excess = [&](double time) { return lengths_[k - 1] + integral(times_[k - 1], time) - s; };
  return refine_root(excess, times_[k - 1], lengths_[k - 1] - s, times_[k], lengths_[k] - s,
                     kTimeAccuracy * (times_.back() - times_.front()));
}

double GeometricPath::node(std::size_t i, std::size_t n) const {
  if (i == 0) return 0;
  if (i == n) return length();
  const double fraction = static_cast<double>(i) / static_cast<double>(n);
  const double begin = times_.front(), duration = times_.back() - begin;
  const auto excess = [&](double time) {
    return 0.5 * (length_until(time) / length() + (time - begin) / duration) - fraction;
  };
  return length_until(refine_root(excess, begin, -fraction, times_.back(), 1 - fraction, kTimeAccuracy * duration));
}

MotionSample GeometricPath::at(double s) const {
  const double margin = kFromStop * length();
  MotionSample found = motion_->at(time_at(std::clamp(s, margin, length() - margin)));
  const double square = dot(found.velocity, found.velocity);
  found.velocity = found.velocity * (1 / std::sqrt(square));
  found.acceleration = (found.acceleration - found.velocity * dot(found.velocity, found.acceleration)) * (1 / square);
  if (s < margin || s > length() - margin) {
    found.time = time_at(s);
    found.pose = motion_->at(found.time).pose;
  }
  return found;
}

}  // namespace pkm
