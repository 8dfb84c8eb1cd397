#include "engine/accelerators/four_ppa_two_par/model.hpp"

#include <algorithm>

namespace pkm::four_ppa_two_par {

std::vector<AssemblyMode> forward(const Geometry<double>& g, const AxisVector<double>& q) {
  std::vector<AssemblyMode> modes;
  const double y = (q[0] + q[1] + q[2] + q[3]) / 4;
  const double h[2] = {(q[1] - q[0]) / 2, (q[3] - q[2]) / 2};
  const double sine = (q[2] + q[3] - q[0] - q[1]) / (2 * g.a);
  constexpr double kRoundoff = 1e-12;
  if (!(std::fabs(sine) <= 1 + kRoundoff) || h[0] < 0 || h[1] < 0)
    return modes;  // the list contains all modes in which the two sliders of a rail keep their order
  double z_c[2];
  for (int j = 0; j < 2; ++j) {
    const double under = (g.l_u - h[j]) * (g.l_u + h[j]);
    if (under < -kRoundoff * g.l_u * g.l_u) return modes;
    z_c[j] = -std::sqrt(std::fmax(0.0, under));
  }
  const double theta = asin(std::clamp(sine, -1.0, 1.0));

  const auto intersect = [&](double angle, double z1, double z2, const char* above) {
    // The point (x, z) of the platform is an intersection of two circles of radius l_d with the centres (x1, z1 - d)
    // and (x2, z2 - d).
    const double c = sincos(angle).cos;
    const double x1 = g.a * c / 2, x2 = g.b - g.a * c / 2, w = x2 - x1, rise = z2 - z1;
    const double distance2 = w * w + rise * rise;
    const double under = g.l_d * g.l_d - distance2 / 4;
    // The circles are concentric or do not intersect: there is no isolated solution.
    if (!(distance2 > 0) || under < -kRoundoff * g.l_d * g.l_d) return;
    const double t = std::sqrt(std::fmax(0.0, under) / distance2);
    for (const int side : {-1, 1}) {
      const double x = 0.5 * (x1 + x2) - side * t * rise, z = 0.5 * (z1 + z2) - g.d + side * t * w;
      const auto branch = [&](double z_cj) { return z_cj < z + g.d ? "upper" : "lower"; };
      modes.push_back({{x, y, z, angle}, above});
      modes.back().working_mode = std::string(branch(z1)) + "," + branch(z2);
      if (t == 0) break;
    }
  };
  static constexpr const char* kNames[2][2] = {{"below,below", "below,above"}, {"above,below", "above,above"}};
  for (int up1 = 0; up1 < 2; ++up1)
    for (int up2 = 0; up2 < 2; ++up2) {
      // C_j is on its rail: the solutions above and below coincide.
      if ((up1 && z_c[0] == 0) || (up2 && z_c[1] == 0)) continue;
      for (const double angle : {theta, kPi - theta}) {
        intersect(angle, up1 ? -z_c[0] : z_c[0], up2 ? -z_c[1] : z_c[1], kNames[up1][up2]);
        if (kPi - theta == theta) break;
      }
    }
  for (auto& mode : modes) mode.usual = mode.mode == kNames[0][0];
  std::stable_partition(modes.begin(), modes.end(), [](const AssemblyMode& m) { return m.usual; });
  return modes;
}

}  // namespace pkm::four_ppa_two_par
