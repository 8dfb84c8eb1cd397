// Suppresses differences that are within the rounding errors of their operands.
#pragma once

#include <cmath>

namespace pkm {

/// The difference, or 0 if its magnitude is at most 1e-13 `size`, several hundred rounding errors of the operands.
/// @param size  magnitude of the operands: the larger endpoint of a range, the largest term of a sum, or the largest
///              of the derivatives with the same unit
inline double zero_if_rounding_error(double difference, double size) {
  return std::fabs(difference) <= 1e-13 * size ? 0 : difference;
}

}  // namespace pkm
