// Random designs of 4PPa-2PaR in motion.
#pragma once

#include <cmath>
#include <vector>

#include "engine/accelerators/four_ppa_two_par/masses.hpp"
#include "engine/dynamics/pose_dynamics.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/limbs_at.hpp"

namespace pkm::testing {

using namespace four_ppa_two_par;

using Vector4 = Vector<double, 4>;

inline pkm::PoseDynamics<double> dynamics(const std::vector<double>& p, const Vector4& X, const Vector4& V, int mode) {
  const pkm::MotionState<double> state{X, V};
  pkm::PoseDynamics<double> d;
  four_ppa().dynamics()->equations(std::span<const double>(p), kModes[mode], {&state, 1}, {&d, 1});
  return d;
}

/// A random design with every mass changed, a payload off the centre, and a pose away from singularities.
struct Drawn {
  std::vector<double> p;
  Vector4 X, V;
  int mode;
};

inline bool regular(const Geometry<double>& g, const Vector4& X, int mode) {
  const auto limb = limbs_at(g, {X[0], X[1], X[2], X[3]}, working_mode(mode));
  if (!limb) return false;
  for (std::size_t j = 0; j < 2; ++j)
    if (!(limb->sigma[j] > 0.2 * g.l_d && limb->h[j] > 0.2 * g.l_u && std::fabs(limb->z_c[j]) > 0.1 * g.l_u))
      return false;
  const double first = limb->x[0] * limb->sigma[1], second = limb->x[1] * limb->sigma[0];
  const double sine = mode == 0 || mode == 3 ? first + second : first - second;  // l_d^2 sin(beta_1 + beta_2)
  return std::fabs(sine) > 0.1 * g.l_d * g.l_d && std::fabs(std::cos(X[3])) > 0.2;
}

inline std::vector<Drawn> random_states(int count, unsigned seed) {
  Uniform uniform(seed);
  std::vector<Drawn> all;
  while (static_cast<int>(all.size()) < count) {
    Drawn s{nominal(), {}, {}, static_cast<int>(all.size() % 4)};
    for (double& value : s.p) value *= uniform(0.7, 1.4);
    s.p[kKappa] = uniform(0.6, 1.2);
    s.p[kPayload] = uniform(0, 2);
    s.p[kPayloadOffset] = uniform(-0.2, 0.2);
    const auto g = geometry(std::span<const double>(s.p));
    s.X = {{uniform(0, g.b), uniform(0.5, 1.5), uniform(-1.4, 0.9), uniform(-1.3, 1.3)}};
    s.V = {{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-3, 3)}};
    if (regular(g, s.X, s.mode)) all.push_back(s);
  }
  return all;
}

}  // namespace pkm::testing
