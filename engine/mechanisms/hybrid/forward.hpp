// Hybrid robot: forward kinematics.
//
//   xA = a - b1 + s1,  xB = -a + b2 + s3,  D = xB - xA        circles of A' and B' about (xA, 0), (xB, 0), radii L1, L2
//   x = ((L1 - L2)(L1 + L2)/D + xA + xB)/2,   z = +-sqrt(h),   h = (L1 - (x - xA))(L1 + (x - xA))
//   w = d^2 + z^2 + e^2 + n3^2 - L3^2,   K = w/(2 e rho),   rho = hypot(d, z),   delta = atan2(z, d)
//   beta = +-xi - delta,   xi = acos K
//
// An assembly is named by the signs of z and of N2, which is the one before xi. Source: hybrid-robot document, section
// 3; the paper's (10) is one of the branches.
#pragma once

#include <vector>

#include "engine/mechanisms/hybrid/model.hpp"

namespace pkm::hybrid {

enum class Closure { ok, no_xz, degenerate_xz, no_beta, degenerate_beta };

struct Assembly {
  Pose<double> pose;
  int sign_z = 1, sign_N2 = 1;
  bool double_z = false;     ///< z = 0, where both signs of z meet
  bool double_beta = false;  ///< N2 = 0, where both signs of N2 meet
  WorkingMode mode{};        ///< signs of n1, n2, n3; 0 where it is 0
};

struct Forward {
  Closure status = Closure::ok;
  std::vector<Assembly> assemblies;  ///< (+,+), (+,-), (-,+), (-,-), as far as they are there and differ
};

/// Every assembly for drives s1, s2, s3, s4 [m].
Forward forward(const Geometry<double>& g, const AxisVector<double>& s);

}  // namespace pkm::hybrid
