// Simplification of polylines by the algorithm of Ramer, Douglas and Peucker.
#pragma once

#include <vector>

#include "engine/export/slice_outline.hpp"

namespace pkm {

/// Removes points so that all of them are within `tolerance` of the remaining polyline; its ends remain.
std::vector<PlanePoint> simplify_line(const std::vector<PlanePoint>& points, double tolerance);
/// Removes points of closed polygons so that all of them are within `tolerance` of the remaining polygon; each polygon
/// keeps its first point.
std::vector<SliceOutline::Loop> simplify_loops(std::vector<SliceOutline::Loop> loops, double tolerance);

}  // namespace pkm
