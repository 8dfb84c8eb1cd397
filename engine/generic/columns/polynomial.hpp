// Real roots in [-1, 1] of polynomials of degree at most four, given by their coefficients in ascending order.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace pkm::generic {

inline constexpr double kNegligibleCoefficient =
    1e-14;  ///< relative to the largest coefficient: smaller ones are neglected

struct Roots {
  std::array<double, 2> s{};  ///< the lower one first
  int count = 0;
};

/// Roots of c[0] + c[1] s + c[2] s^2. The root of a linear polynomial is number 0; the zero polynomial has none.
Roots roots_of(const std::array<double, 3>& c);

/// Finds the roots in [-1, 1] in ascending order, and points where the polynomial nearly has a double root. @return
/// their number
std::size_t roots_between(std::span<const double> coefficients, std::array<double, 8>& roots);

/// Finds the sign changes in (-1, 1) in ascending order. @return their number
std::size_t sign_changes(std::span<const double> coefficients, std::array<double, 8>& places);

}  // namespace pkm::generic
