// Hybrid robot: forward kinematics. Equations: README.md.
#pragma once

#include <vector>

#include "engine/accelerators/hybrid/model.hpp"

namespace pkm::hybrid {

struct Forward {
  ForwardStatus status;
  /// Named by the signs of z and N2: (+,+), (+,-), (-,+), (-,-); only modes that exist and differ from each other. The
  /// signs of n1, n2, n3 are the working mode, with "0" for a sign that is 0.
  std::vector<AssemblyMode> modes;
};

/// All assembly modes for drives s1, s2, s3, s4 [m].
Forward forward(const Geometry<double>& g, const AxisVector<double>& s);

}  // namespace pkm::hybrid
