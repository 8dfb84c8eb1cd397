#include "engine/workspace/bounds/violation_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "engine/core/team.hpp"

namespace pkm::bounds {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kSamples = 1000;  // approximate number of sampled poses
constexpr std::size_t kStarts = 16;     // number of pattern searches, in addition to one for each constraint
constexpr double kFinalStep = 1e-4;  // step at which a pattern search ends, relative to the ranges of the coordinates
constexpr double kScaleAccuracy = 1e-7;     // relative accuracy of the scale of a violation along a ray
constexpr double kGradientDistance = 1e-3;  // relative distance from a violation at which its gradient is computed
// A violation is not searched for at a pose if the first-order estimate of its scale exceeds the limit by more than
// this factor.
constexpr double kSearchedBeyondLimit = 1.5;

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// The vertex s of the cube |s_i| <= 1 at which a linear function with this gradient has its minimum.
std::vector<double> worst_corner(std::span<const double> gradient) {
  std::vector<double> s;
  for (const double g : gradient) s.push_back(g > 0 ? -1 : g < 0 ? 1 : 0);
  return s;
}

}  // namespace

double ViolationSearch::first_order(std::size_t k, std::span<const double> point, std::vector<double>& gradient,
                                    ParametricConstraints::Scratch& scratch) const {
  const double value = constraints_.gradient(k, point, gradient, scratch);
  if (constraints_.is_violated(k, value)) return 0;
  double slope = 0;
  for (std::size_t i = ranges_.size(); i < gradient.size(); ++i) slope += std::fabs(gradient[i]);
  return slope > 0 ? value / slope : kInfinity;
}

std::optional<Violation> ViolationSearch::along(std::size_t k, std::span<const double> pose, std::span<const double> s,
                                                double scale, double limit,
                                                ParametricConstraints::Scratch& scratch) const {
  constexpr int kMaxSteps = 40;
  std::vector<double> point(pose.begin(), pose.end()), gradient;
  point.resize(constraints_.axes());
  const auto place = [&](double t) {
    for (std::size_t i = 0; i < s.size(); ++i) point[pose.size() + i] = t * s[i];
  };
  double satisfied = 0, violated = kInfinity, t = scale;  // Newton's method, safeguarded by bisection
  for (int step = 0; step < kMaxSteps && !(violated - satisfied <= kScaleAccuracy * violated && violated < kInfinity);
       ++step) {
    place(t);
    const double value = constraints_.gradient(k, point, gradient, scratch);
    (constraints_.is_violated(k, value) ? violated : satisfied) = t;
    const double slope = dot(std::span(gradient).subspan(pose.size()), s);
    double next = slope < 0 ? (t - value / slope) * (1 + kScaleAccuracy / 4) : kInfinity;
    if (!(next > satisfied && next < violated)) next = violated < kInfinity ? (satisfied + violated) / 2 : 2 * t;
    if (satisfied > limit || (violated == kInfinity && next > 2 * limit)) return {};
    t = next;
  }
  if (violated == kInfinity) return {};
  for (const double margin : {0.0, 1e-9, 1e-6, 1e-4}) {
    const double further = violated * (1 + margin);
    if (further > limit) return {};
    place(further);
    const std::vector<Interval> exact(point.begin(), point.end());
    if (constraints_.is_violated(k, constraints_.value(k, exact, scratch)))
      return Violation{.scale = further, .constraint = k, .point = point, .gradient = {}};
  }
  return {};
}

std::optional<Violation> ViolationSearch::at_pose(std::size_t k, std::span<const double> pose, double limit,
                                                  ParametricConstraints::Scratch& scratch) const {
  std::vector<double> point(pose.begin(), pose.end()), gradient;
  point.resize(constraints_.axes());
  double scale = first_order(k, point, gradient, scratch);
  if (scale == 0) {
    const std::vector<Interval> exact(point.begin(), point.end());
    if (!constraints_.is_violated(k, constraints_.value(k, exact, scratch))) return {};
    return Violation{.scale = 0, .constraint = k, .point = point, .gradient = {}};
  }
  if (!(scale < kSearchedBeyondLimit * limit)) return {};
  std::optional<Violation> best;
  std::vector<double> s = worst_corner(std::span(gradient).subspan(pose.size()));
  // The search along a ray is repeated, because the gradient at the violation may indicate another vertex of the box of
  // deviations.
  for (int corner = 0; corner < 3; ++corner) {
    const auto found = along(k, pose, s, scale, best ? best->scale : limit, scratch);
    if (!found) break;
    best = found;
    scale = best->scale;
    constraints_.gradient(k, best->point, gradient, scratch);
    const std::vector<double> there = worst_corner(std::span(gradient).subspan(pose.size()));
    if (there == s) break;
    s = there;
  }
  if (!best) return {};
  // The gradient is computed at slightly smaller deviations, because a square root may have no derivatives at the
  // violation.
  point = best->point;
  for (std::size_t i = pose.size(); i < point.size(); ++i) point[i] *= 1 - kGradientDistance;
  constraints_.gradient(k, point, best->gradient, scratch);
  return best;
}

std::vector<double> ViolationSearch::minimise(std::size_t k, std::vector<double> point,
                                              ParametricConstraints::Scratch& scratch) const {
  std::vector<double> gradient;
  double best = first_order(k, point, gradient, scratch);
  for (double step = 0.1; step > kFinalStep && best > 0;) {
    bool improved = false;
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis)
      for (const double sign : {-1.0, 1.0}) {
        const double here = point[axis];
        point[axis] =
            std::clamp(here + sign * step * (ranges_[axis][1] - ranges_[axis][0]), ranges_[axis][0], ranges_[axis][1]);
        const double there = first_order(k, point, gradient, scratch);
        improved = improved || there < best;
        if (there < best)
          best = there;
        else
          point[axis] = here;
      }
    if (!improved) step /= 2;
  }
  point.resize(ranges_.size());
  return point;
}

std::optional<Violation> ViolationSearch::search(double limit, const std::function<bool()>& stop) const {
  // The samples are a regular grid that includes the ends of all ranges.
  std::size_t levels = 3, count = 1, free = 0;
  for (const auto& range : ranges_) free += range[0] < range[1];
  if (free > 0)
    levels =
        std::max<std::size_t>(3, static_cast<std::size_t>(std::pow(kSamples, 1.0 / static_cast<double>(free)) + 1e-9));
  for (std::size_t i = 0; i < free; ++i) count *= levels;
  const auto sample = [&](std::size_t index) {
    std::vector<double> point(constraints_.axes());
    for (std::size_t axis = 0; axis < ranges_.size(); ++axis) {
      const auto [from, to] = std::pair(ranges_[axis][0], ranges_[axis][1]);
      point[axis] = from;
      if (!(from < to)) continue;
      const std::size_t level = index % levels;
      index /= levels;
      point[axis] = level + 1 == levels ? to : from + (to - from) * static_cast<double>(level) / double(levels - 1);
    }
    return point;
  };
  const std::size_t all = constraints_.size();
  std::vector<double> scales(count * all, kInfinity);  // first-order estimates, by sample and constraint
  std::vector<ParametricConstraints::Scratch> scratch(workers(), constraints_.make_scratch());
  parallel_for(count, [&](std::size_t begin, std::size_t end, std::size_t worker) {
    std::vector<double> gradient;
    for (std::size_t i = begin; i < end && !stop(); ++i)
      for (std::size_t k = 0; k < all; ++k) scales[i * all + k] = first_order(k, sample(i), gradient, scratch[worker]);
  });
  // The pattern searches start from the best sample of each constraint, and from the kStarts best samples of all
  // constraints.
  std::vector<std::size_t> order(scales.size()), starts;
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::tuple(scales[i], i); });
  std::vector<bool> seen(all);
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    const std::size_t k = order[rank] % all;
    if (scales[order[rank]] == kInfinity || (rank >= kStarts && seen[k])) continue;
    seen[k] = true;
    starts.push_back(order[rank]);
  }
  std::vector<std::optional<Violation>> found(starts.size());
  parallel_for(starts.size(), [&](std::size_t begin, std::size_t end, std::size_t worker) {
    for (std::size_t i = begin; i < end && !stop(); ++i) {
      const std::size_t k = starts[i] % all;
      const std::vector<double> pose = minimise(k, sample(starts[i] / all), scratch[worker]);
      found[i] = at_pose(k, pose, limit, scratch[worker]);
    }
  });
  std::optional<Violation> best;
  for (const auto& one : found)
    if (one && (!best || one->scale < best->scale)) best = one;
  return best;
}

}  // namespace pkm::bounds
