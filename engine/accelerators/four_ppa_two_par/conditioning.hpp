// 4PPa-2PaR: conditioning of a pose in the mode lower,lower, by a 3 x 3 block of the Jacobian.
//
// The orthogonal transformation of the joint velocities to (q1+q2+q3+q4)/2, (q3+q4-q1-q2)/2, (q2-q1)/sqrt2,
// (q4-q3)/sqrt2 preserves the singular values of J and separates y: the first row becomes (0, 2, 0, 0). The other rows
// are a 3 x 3 matrix in (x, z, theta L_c).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "engine/core/instruction_set.hpp"
#include "engine/geometry/conditioning.hpp"
#include "engine/math/lanes.hpp"

namespace pkm::four_ppa_two_par {

/// Quantities that are the same for all poses of one column.
template <class S>
struct ColumnPoses {
  S l_u, gamma;  ///< length of the upper bars [m]; gamma = a / (2 L_c), with the characteristic length L_c
  S sin_theta, cos_theta;
  std::array<S, 2> x, sigma;  ///< x_j and sigma_j of both limbs [m] in the mode lower,lower
};

/// Inverse condition number of J = J_q^-1 G with the theta column divided by a characteristic length; 0 if J_q or G is
/// singular. S can be Lanes.
template <class S, class T>
[[gnu::always_inline]] inline S conditioning(const ColumnPoses<T>& column, const std::array<S, 2>& z_c) {
  constexpr double kRoot2 = 1.41421356237309504880;
  Rows3<S> m;  // rows of J, with columns for x, z and theta
  m[0] = {S(0.0), S(0.0), S(column.gamma * column.cos_theta * 2.0)};
  for (std::size_t j = 0; j < 2; ++j) {
    const S h = sqrt_or_zero(S((column.l_u - z_c[j]) * (column.l_u + z_c[j])));
    const S below = h * column.sigma[j];  // k_j = h sigma / (-z_c l_d)
    const S hanging = select(value_of(z_c[j]) < 0.0, S(z_c[j] * -kRoot2 / below), S(0.0));  // (sqrt2 / k_j) / l_d
    const S scale = select(value_of(below) > 0.0, hanging, S(0.0));
    const double sign = j == 0 ? 1 : -1;
    m[j + 1] = {S(scale * column.x[j]), S(scale * column.sigma[j] * -sign),
                S(scale * column.x[j] * column.gamma * column.sin_theta * sign)};
  }
  // The complete J consists of this 3 x 3 block and a separate row and column for y, which add a singular value of 2.
  return inverse_condition(m, S(4.0));
}

/// Computes the conditioning of `count` poses in SIMD batches; the arrays are padded to a multiple of kLanes.
template <InstructionSet set>
void conditioning_of_poses(const ColumnPoses<double>& column, const double* z_c1, const double* z_c2, std::size_t count,
                           double* result);

/// z_c of both limbs at the poses of one column, and the conditioning of these poses
template <class S>
struct ColumnConditioning {
  std::array<std::vector<S>, 2> z_c;
  std::vector<S> index;

  void clear() { z_c[0].clear(), z_c[1].clear(); }
  void add(const S& z_c1, const S& z_c2) { z_c[0].push_back(z_c1), z_c[1].push_back(z_c2); }
  std::size_t size() const { return z_c[0].size(); }
  void compute(const ColumnPoses<S>& column) {
    const std::size_t count = size();
    index.resize(count);
    for (std::size_t i = 0; i < count; ++i) index[i] = conditioning<S>(column, {z_c[0][i], z_c[1][i]});
  }
};
template <>
inline void ColumnConditioning<double>::compute(const ColumnPoses<double>& column) {
  const std::size_t count = size(), padded = (count + kLanes - 1) / kLanes * kLanes;
  index.resize(padded);
  for (auto& list : z_c) list.resize(padded, list.empty() ? 0 : list.back());
  with_instruction_set([&]<InstructionSet set>() {
    conditioning_of_poses<set>(column, z_c[0].data(), z_c[1].data(), count, index.data());
  });
  for (auto& list : z_c) list.resize(count);
}

}  // namespace pkm::four_ppa_two_par
