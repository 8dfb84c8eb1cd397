// Errors of the platform's pose caused by bounded joint errors: to first order, dX = E e with |e_i| <= errors[i], where
// E is the inverse of the Jacobian, and exactly, from the poses of the vertices of the box of joint errors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
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

/// Calls visit(e) for every vertex e of the box |e_i| <= errors[i], until it returns false.
/// @return false if a call has returned false
template <class Visit>
bool visit_vertices(std::span<const double> errors, const Visit& visit) {
  for (unsigned vertex = 0; vertex < 1U << errors.size(); ++vertex) {
    AxisVector<double> e(errors.size());
    for (std::size_t i = 0; i < errors.size(); ++i) e[i] = vertex >> i & 1U ? errors[i] : -errors[i];
    if (!visit(e)) return false;
  }
  return true;
}

/// Finds a pose with given joint positions by Newton's method.
/// @param correction  correction(pose) returns the step J^-1 (joints - joints of the pose), std::nullopt where it is
///                    undefined
/// @return std::nullopt if the method does not converge
template <class Correction>
std::optional<Pose<double>> refine_pose(Pose<double> pose, const Correction& correction) {
  constexpr int kMaxSteps = 100;
  // Convergence criterion [m, rad]: once the steps are smaller than this, the method ends as soon as they do not become
  // smaller any more.
  constexpr double kConverged = 1e-9;
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMaxSteps; ++step) {
    const std::optional<AxisVector<double>> change = correction(pose);
    if (!change) return {};
    double size = 0;
    for (std::size_t i = 0; i < pose.size(); ++i) {
      pose[i] += (*change)[i];
      size += std::fabs((*change)[i]);
    }
    if (!(size < last)) return last < kConverged ? std::optional(pose) : std::nullopt;
    last = size;
  }
  return {};
}

}  // namespace pkm
