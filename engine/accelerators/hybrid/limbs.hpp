// Hybrid robot: loop-closure equations of the limbs and their Jacobian. Frames, names and equations: README.md.
//
// Also used by kernels with Lanes as scalars, so it includes no headers of other folders.
#pragma once

#include <array>

namespace pkm::hybrid {

/// Relative rounding error: a radicand smaller than this counts as 0, and the limb is then normal to its rail.
inline constexpr double kRoundoff = 1e-12;

/// The product (a + a_z z) (b + b_z z) of two linear functions of z.
template <class S>
struct Product {
  S a, a_z, b, b_z;
};

template <class S>
struct Limbs {
  S n1, n2, n3;  ///< component of the link of each limb along its rail [m]
  S k, N1, N2;   ///< terms of the loop-closure equations (README.md); k and N1 in m, N2 in m^2
};

/// Solves the loop-closure equations of the limbs at a pose.
/// @param g     lengths L1, L2, L3, d, e [m]
/// @param root  root(n_i^2, L_i, i) returns n_i in the working mode, and any number for a limb out of reach
template <class S, class Lengths, class Root>
[[gnu::always_inline]] inline Limbs<S> limbs(const Lengths& g, const S& z, const S& sin_b, const S& cos_b,
                                             const Root& root) {
  Limbs<S> j;
  j.n1 = root(S((g.L1 - z) * (g.L1 + z)), g.L1, 0);
  j.n2 = root(S((g.L2 - z) * (g.L2 + z)), g.L2, 1);
  j.k = g.e * cos_b - g.d;
  j.N1 = z + g.e * sin_b;
  j.n3 = root(S(g.L3 * g.L3 - j.k * j.k - j.N1 * j.N1), g.L3, 2);
  j.N2 = g.e * (z * cos_b + g.d * sin_b);
  return j;
}

/// Jacobian of (s1, s3, s4) with respect to (x, z, beta * length). The coordinate y is separate: its drive has the gain
/// 1.
template <class S>
[[gnu::always_inline]] inline std::array<std::array<S, 3>, 3> homogeneous_jacobian(const S& z, const Limbs<S>& j,
                                                                                   const S& length) {
  const S zero(0.0), one(1.0);
  return {{{one, z / j.n1, zero}, {one, z / j.n2, zero}, {one, j.N1 / j.n3, j.N2 / j.n3 / length}}};
}

}  // namespace pkm::hybrid
