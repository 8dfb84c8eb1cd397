// 4PPa-2PaR: the report on one pose, and the plain test of one.
#pragma once

#include "engine/mechanisms/four_ppa_two_par/model.hpp"

namespace pkm::four_ppa_two_par {

PoseReport inspect(const Geometry<double>& g, const Limits<double>& l, const Pose<double>& pose, WorkingMode mode);

/// Whether a pose of the lower mode is feasible, margin by margin.
/// @param y  the plane as given, not mirrored
bool feasible(const Geometry<double>& g, const Limits<double>& l, double x, double y, double z, double sin_theta,
              double cos_theta);

}  // namespace pkm::four_ppa_two_par
