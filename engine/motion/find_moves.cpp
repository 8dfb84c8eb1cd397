#include "engine/motion/find_moves.hpp"

#include <algorithm>
#include <cmath>

#include "engine/math/minimum.hpp"
#include "engine/math/roots.hpp"

namespace pkm {
namespace {

constexpr std::size_t kSpeedSamples = 10'000;
constexpr double kAtRest = 1e-6;   // speed, relative to the maximum speed, below which the platform counts as at rest
constexpr double kInstant = 1e-6;  // pauses that are shorter, relative to the duration of the motion, are ignored
constexpr double kStopAccuracy = 1e-15;  // accuracy of the times of stops, relative to the duration of the motion

}  // namespace

std::vector<MovePeriod> find_moves(const Motion& motion) {
  const double duration = motion.duration(), accuracy = kStopAccuracy * duration;
  const auto time = [&](std::size_t k) { return duration * (static_cast<double>(k) / kSpeedSamples); };
  const auto speed_at = [&](double t) {
    const AxisVector<double> velocity = motion.at(t).velocity;
    return std::sqrt(dot(velocity, velocity));
  };
  const auto is_at_rest = [&](double t) { return std::optional(speed_at(t) == 0); };
  std::vector<double> speeds;
  for (std::size_t k = 0; k <= kSpeedSamples; ++k) speeds.push_back(speed_at(time(k)));
  const double at_rest = kAtRest * *std::ranges::max_element(speeds);
  std::vector<MovePeriod> moves;
  double begin = 0;
  const auto end_move = [&](double t) {
    if (t > begin) moves.push_back({begin, t});
  };
  for (std::size_t k = 0; k <= kSpeedSamples; ++k) {
    if (speeds[k] == 0) {
      if (k > 0 && speeds[k - 1] != 0) end_move(bisect(is_at_rest, {time(k), time(k - 1)}, accuracy).with);
      begin = time(k);
      if (k < kSpeedSamples && speeds[k + 1] != 0) begin = bisect(is_at_rest, {time(k), time(k + 1)}, accuracy).with;
    } else if (k == kSpeedSamples) {
      end_move(duration);
    } else if (k > 0 && speeds[k] < speeds[k - 1] && speeds[k] <= speeds[k + 1]) {
      const double stop = golden_section(speed_at, time(k - 1), time(k + 1), accuracy);
      if (speed_at(stop) > at_rest) continue;
      end_move(stop);
      begin = stop;
    }
  }
  // Near an instantaneous stop, rounding can make the speed 0 at several times: replace the resulting short pause by
  // its middle.
  const double instant = kInstant * duration;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    if (k == 0 && moves[k].begin < instant) moves[k].begin = 0;
    if (k > 0 && moves[k].begin - moves[k - 1].end < instant)
      moves[k].begin = moves[k - 1].end = 0.5 * (moves[k].begin + moves[k - 1].end);
  }
  if (!moves.empty() && duration - moves.back().end < instant) moves.back().end = duration;
  return moves;
}

}  // namespace pkm
