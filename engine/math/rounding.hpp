// What a difference of rounded numbers says: nothing below their roundings.
#pragma once

#include <cmath>

namespace pkm {

/// The difference, or 0 where it is within the roundings of what it is a difference of: some hundred of them, 1e-13
/// of `size`, the magnitude of those numbers. The ends of a range are known to that of its greater end, a sum to that
/// of its greatest term, a slope to that of the greatest in the same unit.
inline double beyond_rounding(double difference, double size) {
  return std::fabs(difference) <= 1e-13 * size ? 0 : difference;
}

}  // namespace pkm
