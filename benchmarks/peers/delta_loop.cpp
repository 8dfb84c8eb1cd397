#include "benchmarks/peers/delta_loop.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace pkm::peers {

std::int64_t feasible_cells(const Delta& delta, int n) {
  const auto [R, r, l_a, l_b, q_min, q_max] = delta;
  const double reach = l_a + l_b, step = 2 * reach / n, length_difference = l_a * l_a - l_b * l_b;
  std::array<double, 3> cosine, sine;
  for (int arm = 0; arm < 3; ++arm) {
    cosine[arm] = std::cos(2 * std::numbers::pi * arm / 3);
    sine[arm] = std::sin(2 * std::numbers::pi * arm / 3);
  }
  std::int64_t feasible = 0;
  for (int i = 0; i < n; ++i) {
    const double x = -reach + (i + 0.5) * step;
    for (int j = 0; j < n; ++j) {
      const double y = -reach + (j + 0.5) * step;
      // for each crank: outward distance u from its pivot, and the terms that do not depend on z
      std::array<double, 3> u, u_2, c;
      for (int arm = 0; arm < 3; ++arm) {
        u[arm] = x * cosine[arm] + y * sine[arm] + r - R;
        const double lateral = y * cosine[arm] - x * sine[arm];
        u_2[arm] = u[arm] * u[arm];
        c[arm] = u_2[arm] + lateral * lateral + length_difference;
      }
      for (int k = 0; k < n; ++k) {
        const double w = reach - (k + 0.5) * step / 2, w_2 = w * w;  // downwards
        bool all = true;
        for (int arm = 0; arm < 3 && all; ++arm) {
          const double h = std::sqrt(u_2[arm] + w_2), cosine_of = (c[arm] + w_2) / (2 * l_a * h);
          all = std::fabs(cosine_of) <= 1;
          if (!all) continue;
          const double q = std::atan2(w, u[arm]) - std::acos(cosine_of);
          all = q >= q_min && q <= q_max;
        }
        feasible += all;
      }
    }
  }
  return feasible;
}

}  // namespace pkm::peers
