// Outline of a workspace over two coordinates, by marching squares.
//
// Every grid node is classified as feasible or infeasible. Each vertex of the outline lies on an edge between a
// feasible and an infeasible node, where the minimum margin of the pose changes sign; it is located by bisection.
// Features smaller than a grid square can be missed.
#pragma once

#include <array>
#include <vector>

#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

struct SliceOutline {
  using Loop = std::vector<std::array<double, 2>>;
  std::array<WorkspaceAxis, 2> axes;  ///< horizontal and vertical
  std::vector<Loop> loops;  ///< closed polygons: counter-clockwise around feasible regions, clockwise around holes
  double area = 0;          ///< of the polygons, in the product of the axes' units
};

/// @param workspace  over two swept coordinates; gives their ranges and the values of the fixed coordinates
SliceOutline trace_outline(const WorkspaceFields& workspace, const PoseMargin& margin);

}  // namespace pkm
