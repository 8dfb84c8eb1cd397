// Halton sequence: points that fill the unit cube evenly (Halton 1960).
#pragma once

#include <array>
#include <cstddef>

namespace pkm {

/// Coordinate of a point of the sequence, in [0, 1): the radical inverse of its index in a prime base.
/// @param index      number of the point in the sequence, from 1
/// @param dimension  number of the coordinate of the point, from 0; dimension k + 12 repeats dimension k
inline double halton(std::size_t index, std::size_t dimension) {
  constexpr std::array<std::size_t, 12> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  const std::size_t base = kPrimes[dimension % kPrimes.size()];
  double value = 0, weight = 1;
  for (; index > 0; index /= base) {
    weight /= static_cast<double>(base);
    value += weight * static_cast<double>(index % base);
  }
  return value;
}

}  // namespace pkm
