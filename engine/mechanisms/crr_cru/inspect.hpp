// (3CRR/R)&CRU and Quadrupteron: the report on one pose.
#pragma once

#include "engine/mechanisms/crr_cru/links.hpp"

namespace pkm::crr_cru {

PoseReport inspect(const Geometry<double>& g, const LinkRadii<double>& radii, const Limits& l, const Pose<double>& pose,
                   const WorkingMode& mode);

}  // namespace pkm::crr_cru
