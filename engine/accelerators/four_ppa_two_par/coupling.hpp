// 4PPa-2PaR: joint-space inertia at a pose of the mode lower,lower, without the Jacobian J and the inertia matrix M_X
// of the platform coordinates: twice the kinetic energy is a sum of squares of velocities that are linear in the
// velocities of the sliders. Derivation: README.md, Motion.
#pragma once

#include "engine/accelerators/four_ppa_two_par/masses.hpp"
#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm::four_ppa_two_par {

/// Computes the joint-space inertia M_q [kg]. It is finite inside the workspace, where 0 < sigma_j, 0 < h_j, z_cj < 0,
/// 0 < cos theta and 0 < sin(beta_1 + beta_2). It is NaN if cos theta or sin(beta_1 + beta_2) vanishes to working
/// precision, because J is then singular.
/// @param x, sigma, z_c  values of both limbs [m], in the lower branch
template <class S>
Matrix<S, 4, 4> joint_inertia(const Geometry<S>& g, const Masses<S>& b, const S& sin_theta, const S& cos_theta,
                              const std::array<S, 2>& x, const std::array<S, 2>& sigma, const std::array<S, 2>& z_c) {
  using Row = Vector<S, 4>;  // a velocity as a linear form of the four slider velocities, given by its coefficients
  std::array<Row, 2> y, h, z_cj, x_j;
  std::array<S, 2> t, h2;
  for (std::size_t j = 0; j < 2; ++j) {
    h2[j] = (g.l_u - z_c[j]) * (g.l_u + z_c[j]);
    t[j] = x[j] / sigma[j];
    y[j][2 * j] = y[j][2 * j + 1] = h[j][2 * j + 1] = S(0.5);
    h[j][2 * j] = S(-0.5);
    z_cj[j] = h[j] * S(sqrt_or_zero(h2[j]) / z_c[j] * -1.0);
  }
  const S half_a_s = g.a * sin_theta * 0.5;
  const Row theta = (y[1] - y[0]) * S(S(1.0) / (g.a * cos_theta));
  const Row middle_y = (y[0] + y[1]) * S(0.5);
  const Row middle_x = (z_cj[1] - z_cj[0] - theta * S((t[0] - t[1]) * half_a_s)) * S(S(1.0) / (t[0] + t[1]));
  x_j[0] = theta * half_a_s + middle_x;
  x_j[1] = theta * half_a_s - middle_x;
  const Row z = z_cj[0] + x_j[0] * t[0];

  Matrix<S, 4, 4> M;
  if (std::fabs(value_of(cos_theta)) < kSingularRcond || std::fabs(value_of(t[0] + t[1])) < kSingularRcond)
    return undetermined(M);
  const auto add = [&](const S& coefficient, const Row& speed) {
    const Row scaled = speed * coefficient;
    for (std::size_t r = 0; r < 4; ++r)
      for (std::size_t c = r; c < 4; ++c) M(r, c) += scaled[r] * speed[c];
  };
  for (std::size_t j = 0; j < 2; ++j) {
    add(b.slider * 2.0 + b.upper_bar * 4.0 + b.upper_connector + b.lower_bar * 2.0 + b.lower_connector, y[j]);
    add(b.slider * 2.0 + b.upper_bar, h[j]);
    add(b.upper_connector + b.upper_bar + b.I_upper * 4.0 / h2[j], z_cj[j]);
    add(b.lower_bar * 0.5 + b.lower_connector + b.I_lower * 2.0 / (sigma[j] * sigma[j]), x_j[j]);
    add(b.lower_bar * 0.5, z_cj[j] + z);
  }
  add(b.lower_connector * 2.0 + b.platform + b.payload, z);
  add(b.platform, middle_x);
  add(b.platform, middle_y);
  add(b.I_platform, theta);
  add(b.payload, middle_x - theta * S(b.c_payload * sin_theta));
  add(b.payload, middle_y + theta * S(b.c_payload * cos_theta));
  for (std::size_t r = 1; r < 4; ++r)
    for (std::size_t c = 0; c < r; ++c) M(r, c) = M(c, r);
  for (std::size_t r = 0; r < 4; ++r) M(r, r) = M(r, r) + b.rotors[r];
  return M;
}

/// Computes the values of all requested fields of the inertia at a pose, in the order in which the fields were
/// requested.
template <class S>
void inertia_values(const Matrix<S, 4, 4>& M_q, WorkspaceResult<S>& workspace, std::vector<S>& values) {
  values.clear();
  evaluate_inertia(M_q, workspace, nullptr,
                   [&](auto&, std::span<const S> of) { values.insert(values.end(), of.begin(), of.end()); });
}

/// Appends the values computed by inertia_values() to the fields of the inertia.
/// @param mirrored  true: for the mirror image of the pose (theta -> -theta), in which the two sliders of each rail are
/// exchanged
template <class S>
void add_inertia(const std::vector<S>& values, bool mirrored, WorkspaceResult<S>& workspace) {
  auto value = values.begin();
  for (auto& [quantity, field] : workspace.fields) {
    if (!quantity->needs_inertia()) continue;
    const std::size_t count = quantity->per_joint ? 4 : 1;
    for (std::size_t i = 0; i < count; ++i) field[mirrored && count > 1 ? i ^ 1 : i].push_back(value[i]);
    value += static_cast<std::ptrdiff_t>(count);
  }
}

}  // namespace pkm::four_ppa_two_par
