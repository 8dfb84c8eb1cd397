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
  if (front.empty()) throw std::invalid_argument("IGD+: the front is empty; expected at least one point");
  double sum = 0;
  for (std::size_t z = 0; z < front.size(); z += objectives) {
    // Square of the minimum, over the points, of the modified distance from the point z of the front.
    double minimum = std::numeric_limits<double>::infinity();
    for (std::size_t a = 0; a < points.size(); a += objectives) {
      double square = 0;
      for (std::size_t k = 0; k < objectives; ++k) {
        // A NaN coordinate gives a NaN distance, so that the point is not the nearest one.
        const double excess = std::max(points[a + k] - front[z + k], 0.0) / extents[k];
        square += excess * excess;
      }
      if (square < minimum) minimum = square;
    }
    sum += std::sqrt(minimum);
  }
  return sum / static_cast<double>(front.size() / objectives);
}

}  // namespace pkm
