// Hybrid robot: forward kinematics. Equations: README.md.
#pragma once

#include <vector>

#include "engine/accelerators/hybrid/model.hpp"

namespace pkm::hybrid {

struct Forward {
  ForwardStatus status;
  /// Assembly modes that exist and differ from each other, named by the signs of z and N2: (+,+), (+,-), (-,+), (-,-).
  /// The working mode of each is given by the signs of n1, n2, n3, with "0" for a sign that is 0.
  std::vector<AssemblyMode> modes;
};

/// Finds all assembly modes for given positions of the drives s1, s2, s3, s4 [m].
Forward forward(const Geometry<double>& g, const AxisVector<double>& s);

}  // namespace pkm::hybrid
