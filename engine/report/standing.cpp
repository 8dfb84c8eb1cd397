#include "engine/report/standing.hpp"

#include <cmath>

namespace pkm {

std::optional<Gain> gain_over(double baseline, double value, Direction direction) {
  if (!(std::fabs(baseline) > 0) || std::isnan(value)) return {};
  const double percent = 100 * (value - baseline) / std::fabs(baseline);
  return Gain{percent, percent != 0 && (direction == Direction::maximise) != (percent > 0)};
}

std::optional<std::size_t> most_broken(std::span<const double> margins) {
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < margins.size(); ++i)
    if (margins[i] < 0 && (!worst || margins[i] < margins[*worst])) worst = i;
  return worst;
}

}  // namespace pkm
