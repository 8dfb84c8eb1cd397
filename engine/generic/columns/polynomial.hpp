// Real roots in [-1, 1] of polynomials of degree four or less, by their coefficients, the lowest first.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace pkm::generic {

inline constexpr double kNothing = 1e-14;  ///< of the greatest coefficient

struct Roots {
  std::array<double, 2> s{};  ///< the lower one first
  int count = 0;
};

/// Of c[0] + c[1] s + c[2] s^2. A root of a line is number 0; where all coefficients are 0 there are none.
Roots roots_of(const std::array<double, 3>& c);

/// Roots in [-1, 1], in order, of a polynomial of degree four or less, and places where it nearly has two; the number
/// of them.
std::size_t roots_between(std::span<const double> coefficients, std::array<double, 8>& roots);

/// Where in (-1, 1) such a polynomial changes its sign, in order; their number.
std::size_t sign_changes(std::span<const double> coefficients, std::array<double, 8>& places);

}  // namespace pkm::generic
