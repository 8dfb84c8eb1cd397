// Hybrid robot: forward kinematics. An assembly is named by the signs of z and of N2. Equations: README.md.
#pragma once

#include <vector>

#include "engine/accelerators/hybrid/model.hpp"

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
