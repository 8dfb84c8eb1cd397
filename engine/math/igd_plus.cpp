#include "engine/math/igd_plus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "engine/core/error.hpp"

namespace pkm {

double igd_plus(std::span<const double> points, std::size_t objectives, std::span<const double> front,
                std::span<const double> extents) {
  PKM_EXPECTS(objectives > 0 && points.size() % objectives == 0 && front.size() % objectives == 0);
  PKM_EXPECTS(extents.size() == objectives);
  if (front.empty()) throw std::invalid_argument("IGD+ takes a front of at least one point");
  double sum = 0;
  for (std::size_t z = 0; z < front.size(); z += objectives) {
    double least = std::numeric_limits<double>::infinity();  // squared
    for (std::size_t a = 0; a < points.size(); a += objectives) {
      double square = 0;
      for (std::size_t k = 0; k < objectives; ++k) {
        const double worse = std::max(points[a + k] - front[z + k], 0.0) / extents[k];  // a NaN stays one
        square += worse * worse;
      }
      if (square < least) least = square;
    }
    sum += std::sqrt(least);
  }
  return sum / static_cast<double>(front.size() / objectives);
}

}  // namespace pkm
