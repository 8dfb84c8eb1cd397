// Random points with a fixed seed, for tests of performance indicators.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "engine/math/random.hpp"

namespace pkm::test {

/// Random points, row-major, `objectives` numbers in [0, 1] each; bit-identical on every machine.
/// @param shape  "sphere": on the unit sphere, "plane": on the plane with sum 1, "cloud": in the unit cube,
///               so that most are dominated
inline std::vector<double> random_front(const std::string& shape, std::size_t count, std::size_t objectives,
                                        std::uint64_t seed = 1) {
  std::vector<double> points;
  for (std::size_t row = 0; row < count; ++row) {
    Stream stream(seed, 0, static_cast<std::uint32_t>(row), Stream::Use::start);
    double sum = 0, square = 0;
    for (std::size_t k = 0; k < objectives; ++k) {
      const double value = points.emplace_back(stream.u01());
      sum += value;
      square += value * value;
    }
    const double size = shape == "sphere" ? std::sqrt(square) : shape == "plane" ? sum : 1.0;
    for (std::size_t k = 1; k <= objectives; ++k) points[points.size() - k] /= size;
  }
  return points;
}

/// A reference point that every point of a random front dominates.
inline std::vector<double> front_reference(std::size_t objectives) { return std::vector<double>(objectives, 1.1); }

}  // namespace pkm::test
