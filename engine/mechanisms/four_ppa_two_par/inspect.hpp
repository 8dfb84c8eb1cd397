// 4PPa-2PaR: the report on one pose.
#pragma once

#include "engine/mechanisms/four_ppa_two_par/model.hpp"

namespace pkm::four_ppa_two_par {

PoseReport inspect(const Geometry<double>& g, const Limits<double>& l, const Obstacles& obstacles,
                   const Pose<double>& pose, WorkingMode mode);

}  // namespace pkm::four_ppa_two_par
