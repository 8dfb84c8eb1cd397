// Real roots in [-1, 1] of polynomials of degree at most four, given by their coefficients in ascending order.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace pkm::generic {

/// Relative to the largest coefficient: smaller leading coefficients are neglected.
inline constexpr double kNegligibleCoefficient = 1e-14;

struct Roots {
  std::array<double, 2> s{};  ///< the roots, in ascending order; the first `count` are in use
  int count = 0;
};

/// Roots of c[0] + c[1] s + c[2] s^2. A linear polynomial has one root, with index 0; the zero polynomial has none.
Roots roots_of(const std::array<double, 3>& c);

/// Finds the roots in [-1, 1] in ascending order, and points where the polynomial nearly has a double root. @return
/// their number
std::size_t roots_between(std::span<const double> coefficients, std::array<double, 8>& roots);

/// Finds the sign changes in (-1, 1) in ascending order. @return their number
std::size_t sign_changes(std::span<const double> coefficients, std::array<double, 8>& places);

}  // namespace pkm::generic
