// Simplification of polylines by the algorithm of Ramer, Douglas and Peucker.
#pragma once

#include <vector>

#include "engine/export/slice_mesh.hpp"

namespace pkm {

/// Removes points so that all of them are within `tolerance` of the remaining polyline; its ends remain.
std::vector<PlanePoint> simplify_line(const std::vector<PlanePoint>& points, double tolerance);

}  // namespace pkm
