#include "engine/core/parameter.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {

double DesignSpace::nearest(std::size_t i, double value) const {
  const Variable& v = variables_[i];
  if (v.step > 0) {
    // The tolerance keeps `upper` on the lattice if (upper - lower) / step is an integer up to rounding errors.
    const double last = std::floor((v.upper - v.lower) / v.step + 1e-9);
    const double k = std::clamp(std::nearbyint((value - v.lower) / v.step), 0.0, last);
    value = v.lower + k * v.step;
  }
  return std::clamp(value, v.lower, v.upper);
}

double DesignSpace::from_unit(std::size_t i, double u) const {
  const Variable& v = variables_[i];
  return nearest(i, v.lower + u * (v.upper - v.lower));
}

double DesignSpace::to_unit(std::size_t i, double value) const {
  const Variable& v = variables_[i];
  return v.upper > v.lower ? (value - v.lower) / (v.upper - v.lower) : 0.0;
}

}  // namespace pkm
