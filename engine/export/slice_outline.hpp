// Outline of a workspace over two coordinates: the boundary of its mesh.
#pragma once

#include <vector>

#include "engine/export/slice_mesh.hpp"

namespace pkm {

struct SliceOutline {
  using Loop = std::vector<PlanePoint>;
  std::array<WorkspaceAxis, 2> axes;  ///< the horizontal and the vertical axis
  std::vector<Loop> loops;  ///< closed polygons: counter-clockwise around feasible regions, clockwise around holes
  double area = 0;          ///< area within the outline, in the product of the units of both axes
};

SliceOutline trace_outline(const SliceMesh& mesh);

/// Twice the signed area of a polygon (shoelace formula); positive if it is counter-clockwise.
double twice_area(const SliceOutline::Loop& loop);

}  // namespace pkm
