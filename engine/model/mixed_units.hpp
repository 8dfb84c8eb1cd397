// Coordinates or drives some of which are lengths and some angles: a matrix over them has entries of different units.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/model/pose.hpp"

namespace pkm {

inline bool mixes_units(const std::vector<AxisInfo>& axes) {
  const auto angles = std::ranges::count_if(axes, &AxisInfo::turns);
  return angles > 0 && angles < std::ssize(axes);
}

}  // namespace pkm
