// First-order error of the platform's pose caused by bounded joint errors: dX = E e with |e_i| <= errors[i], where E is
// the inverse of the Jacobian.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "engine/geometry/pose.hpp"

namespace pkm {

/// The maximum of |(E e)_i| over the box |e_j| <= errors[j], for each component i.
inline std::vector<double> max_components(const AxisMatrix<double>& E, std::span<const double> errors) {
  std::vector<double> max(E.rows(), 0);
  for (std::size_t i = 0; i < max.size(); ++i)
    for (std::size_t j = 0; j < errors.size(); ++j) max[i] += std::fabs(E(i, j)) * errors[j];
  return max;
}

/// Map from coordinate rates to the twist, for a mechanism that does not provide this map: coordinates that are lengths
/// are interpreted as components of the position, and rotations are unknown and set to 0.
inline AxisMatrix<double> translation_map(const std::vector<AxisInfo>& coordinates) {
  auto T = AxisMatrix<double>::zero(6, coordinates.size());
  for (std::size_t j = 0, row = 0; j < coordinates.size() && row < 3; ++j)
    if (!coordinates[j].turns()) T(row++, j) = 1;
  return T;
}

/// Maximum norms of the translation and of the rotation of the twists E e over the box |e_i| <= errors[i]. A norm is
/// convex, so its maximum is attained at a vertex of the box.
inline std::array<double, 2> max_twist(const AxisMatrix<double>& E, std::span<const double> errors) {
  std::array<double, 2> max{};
  for (unsigned corner = 0; corner < 1U << errors.size(); ++corner) {
    std::array<double, 2> squares{};
    for (std::size_t i = 0; i < E.rows(); ++i) {
      double component = 0;
      for (std::size_t j = 0; j < errors.size(); ++j) component += (corner >> j & 1 ? 1 : -1) * E(i, j) * errors[j];
      squares[i / 3] += component * component;
    }
    for (std::size_t part = 0; part < 2; ++part) max[part] = std::max(max[part], std::sqrt(squares[part]));
  }
  return max;
}

}  // namespace pkm
