#include "engine/accelerators/hybrid/forward.hpp"

#include <cmath>

namespace pkm::hybrid {

Forward forward(const Geometry<double>& g, const AxisVector<double>& s) {
  const double xA = g.a - g.b1 + s[0], xB = -g.a + g.b2 + s[2], D = xB - xA;
  const double sum = g.L1 + g.L2, same = kRoundoff * sum;
  const auto no_pose = [](const char* word, const char* reason) { return Forward{{word, reason}, {}}; };
  const char* const no_xz =
      "A'' and B'' are too far apart, or as far apart as A' and B' although links A and B differ in length";
  if (std::fabs(D) <= same && std::fabs(g.L1 - g.L2) <= same)
    return no_pose("DEGENERATE_XZ",
                   "A'' and B'' are as far apart as A' and B', so that the parallelogram moves freely");
  if (std::fabs(D) <= same) return no_pose("NO_XZ", no_xz);
  const double x = ((g.L1 - g.L2) * sum / D + xA + xB) / 2;
  const double h = (g.L1 - (x - xA)) * (g.L1 + (x - xA)), h_zero = kRoundoff * g.L1 * g.L1;
  if (h < -h_zero) return no_pose("NO_XZ", no_xz);
  const bool flat = h <= h_zero;
  const double height = flat ? 0 : std::sqrt(h);

  const double n3 = x - g.c - s[3], rho = std::sqrt(g.d * g.d + height * height);
  const double w = g.d * g.d + height * height + g.e * g.e + n3 * n3 - g.L3 * g.L3;
  const double w_zero = kRoundoff * g.L3 * g.L3;
  if (g.e * rho <= w_zero && std::fabs(w) <= w_zero)
    return no_pose("DEGENERATE_BETA", "C' rotates about the foot of link C, so that every beta assembles");
  const double K = w / (2 * g.e * rho);
  if (g.e * rho <= w_zero || std::fabs(K) > 1 + kRoundoff)
    return no_pose("NO_BETA", "link C does not reach the platform's joint C' for any beta");
  const bool one_beta = std::fabs(std::fabs(K) - 1) <= kRoundoff;
  const double xi = one_beta ? (K > 0 ? 0 : kPi) : atan2(std::sqrt((1 - K) * (1 + K)), K);

  Forward found;
  const auto sign = [](double n, double L) { return std::fabs(n) <= kRoundoff * L ? "0" : n < 0 ? "-" : "+"; };
  const std::string working_mode = std::string(sign(x - xA, g.L1)) + "," + sign(x - xB, g.L2) + "," + sign(n3, g.L3);
  for (const int sign_z : {1, -1})
    for (const int sign_N2 : {1, -1}) {
      if ((flat && sign_z < 0) || (one_beta && sign_N2 < 0)) continue;
      const double z = sign_z * height, beta = wrapped(sign_N2 * xi - atan2(z, g.d));
      AssemblyMode& mode = found.modes.emplace_back();
      mode.pose = {x, s[1], z, beta};
      mode.mode = std::string(sign_z > 0 ? "+," : "-,") + (sign_N2 > 0 ? "+" : "-");
      mode.working_mode = working_mode;
      if (flat) mode.double_roots.push_back("z");
      if (one_beta) mode.double_roots.push_back("beta");
    }
  return found;
}

}  // namespace pkm::hybrid
