#include "engine/accelerators/hybrid/forward.hpp"

#include <cmath>

namespace pkm::hybrid {

Forward forward(const Geometry<double>& g, const AxisVector<double>& s) {
  Forward found;
  const auto none = [&](Closure status) {
    found.status = status;
    return found;
  };
  const double xA = g.a - g.b1 + s[0], xB = -g.a + g.b2 + s[2], D = xB - xA;
  const double sum = g.L1 + g.L2, same = kRoundoff * sum;
  if (std::fabs(D) <= same) return none(std::fabs(g.L1 - g.L2) <= same ? Closure::degenerate_xz : Closure::no_xz);
  const double x = ((g.L1 - g.L2) * sum / D + xA + xB) / 2;
  const double h = (g.L1 - (x - xA)) * (g.L1 + (x - xA)), h_zero = kRoundoff * g.L1 * g.L1;
  if (h < -h_zero) return none(Closure::no_xz);
  const bool flat = h <= h_zero;
  const double height = flat ? 0 : std::sqrt(h);

  const double n3 = x - g.c - s[3], rho = std::sqrt(g.d * g.d + height * height);
  const double w = g.d * g.d + height * height + g.e * g.e + n3 * n3 - g.L3 * g.L3;
  const double w_zero = kRoundoff * g.L3 * g.L3;
  if (g.e * rho <= w_zero) return none(std::fabs(w) <= w_zero ? Closure::degenerate_beta : Closure::no_beta);
  const double K = w / (2 * g.e * rho);
  if (std::fabs(K) > 1 + kRoundoff) return none(Closure::no_beta);
  const bool one_beta = std::fabs(std::fabs(K) - 1) <= kRoundoff;
  const double xi = one_beta ? (K > 0 ? 0 : kPi) : atan2(std::sqrt((1 - K) * (1 + K)), K);

  const auto sign = [](double n, double L) { return std::fabs(n) <= kRoundoff * L ? 0 : n < 0 ? -1 : 1; };
  for (const int sign_z : {1, -1})
    for (const int sign_N2 : {1, -1}) {
      if ((flat && sign_z < 0) || (one_beta && sign_N2 < 0)) continue;
      const double z = sign_z * height, beta = wrapped(sign_N2 * xi - atan2(z, g.d));
      found.assemblies.push_back({.pose = {x, s[1], z, beta},
                                  .sign_z = sign_z,
                                  .sign_N2 = sign_N2,
                                  .double_z = flat,
                                  .double_beta = one_beta,
                                  .mode = {sign(x - xA, g.L1), sign(x - xB, g.L2), sign(n3, g.L3)}});
    }
  return found;
}

}  // namespace pkm::hybrid
