// 4PPa-2PaR: conditioning of a pose of the lower mode, without forming the 4 x 4 Jacobian.
//
// Turning the joint speeds by the orthogonal map (q1+q2+q3+q4)/2, (q3+q4-q1-q2)/2, (q2-q1)/sqrt2, (q4-q3)/sqrt2 keeps
// the singular values of J and splits off y: the first row becomes (0, 2, 0, 0). What is left is 3 x 3 in (x, z, theta
// L_c).
#pragma once

#include "engine/mechanisms/four_ppa_two_par.hpp"
#include "engine/model/conditioning.hpp"

namespace pkm::four_ppa_two_par {

/// Inverse condition number of J = J_q^-1 G with the theta column divided by a characteristic length.
/// @param x, sigma, z_c  of the two limbs [m], lower branch
/// @param gamma          a / (2 L_c)
template <class S>
S conditioning(const Geometry<S>& g, const S& sin_theta, const S& cos_theta, const std::array<S, 2>& x,
               const std::array<S, 2>& sigma, const std::array<S, 2>& z_c, const S& gamma) {
  constexpr double kRoot2 = 1.41421356237309504880;
  Rows3<S> m;  // columns x, z, theta
  m[0] = {S(0.0), S(0.0), gamma * cos_theta * 2.0};
  for (std::size_t j = 0; j < 2; ++j) {
    const S h = root_or_zero(S((g.l_u - z_c[j]) * (g.l_u + z_c[j])));
    const S below = h * sigma[j];  // k_j = h sigma / (-z_c l_d)
    if (!(value_of(below) > 0) || !(value_of(z_c[j]) < 0)) return S(0.0);
    const S scale = z_c[j] * -kRoot2 / below;  // (sqrt2 / k_j) / l_d
    const double sign = j == 0 ? 1 : -1;
    m[j + 1] = {scale * x[j], scale * sigma[j] * -sign, scale * x[j] * gamma * sin_theta * sign};
  }
  return inverse_condition(m, S(4.0));  // the whole matrix is diag(2) and this 3 x 3
}

}  // namespace pkm::four_ppa_two_par
