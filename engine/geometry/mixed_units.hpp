// Check for mixed units: a Jacobian or inertia matrix over both lengths and angles has entries of different units.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/geometry/pose.hpp"

namespace pkm {

/// True if at least one coordinate or joint is an angle and at least one is a length.
inline bool mixes_units(const std::vector<AxisInfo>& axes) {
  const auto angles = std::ranges::count_if(axes, &AxisInfo::turns);
  return angles > 0 && angles < std::ssize(axes);
}

}  // namespace pkm
