// Real roots in [-1, 1] of polynomials of degree at most four, given by their coefficients in ascending order.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace pkm::generic {

/// Leading coefficients whose ratio to the largest coefficient is smaller are neglected.
inline constexpr double kNegligibleCoefficient = 1e-14;

struct Roots {
  std::array<double, 2> s{};  ///< the roots, in ascending order; the first `count` are in use
  int count = 0;
};

/// Real roots of c[0] + c[1] s + c[2] s^2. A linear polynomial has one root, with index 0; a constant one has none.
Roots roots_of(const std::array<double, 3>& c);

/// Finds the roots in [-1, 1], and points where the polynomial nearly has a double root, in ascending order.
/// @return number of values stored in `roots`
std::size_t roots_between(std::span<const double> coefficients, std::array<double, 8>& roots);

/// Finds the points in (-1, 1) at which the polynomial changes its sign, in ascending order.
/// @return number of values stored in `places`
std::size_t sign_changes(std::span<const double> coefficients, std::array<double, 8>& places);

}  // namespace pkm::generic
