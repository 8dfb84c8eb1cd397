// (3CRR/R)&CRU and Quadrupteron: forward kinematics.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/accelerators/crr_cru/yaw.hpp"

namespace pkm::crr_cru {

/// Finds the assembly modes for given slide positions: "+" with cos(phi + delta) > 0, and "-" with cos(phi + delta) <
/// 0. There is only one mode if both coincide, and none if |sin(phi + delta)| would exceed 1. phi is in (-pi, pi].
inline std::vector<AssemblyMode> forward(const Geometry<double>& g, const AxisVector<double>& rho) {
  const Yaw<double> y = yaw(g);
  const double kappa = (rho[3] - rho[1] - y.a_0) / y.R;
  constexpr double kRoundoff = 1e-12;
  if (!(std::fabs(kappa) <= 1 + kRoundoff)) return {};
  const double angle = asin(std::clamp(kappa, -1.0, 1.0)), delta = offset(y);
  std::vector<AssemblyMode> modes;
  const auto add = [&](double phi, const char* branch) {
    phi = wrapped(phi);
    const auto [s, c] = sincos(phi);
    const auto arm = arms(g, s, c);
    modes.push_back(
        {{rho[0] - arm[0].to_joint[0], rho[1] - arm[1].to_joint[1], rho[2] - arm[2].to_joint[2], phi}, branch});
  };
  // sin(phi + delta) = kappa has the solutions phi + delta = angle and pi - angle.
  add(angle - delta, "+");
  if (kPi - angle != angle) add(kPi - angle - delta, "-");
  return modes;
}

}  // namespace pkm::crr_cru
