// A section of a workspace over two coordinates: its outline.
//
// Nodes on a grid are feasible or not; marching squares walk between them, and each point of the outline lies where the
// least margin of the pose changes its sign, found by halving the step between two nodes.
#pragma once

#include <array>
#include <vector>

#include "engine/report/workspace_fields.hpp"

namespace pkm {

struct Section {
  using Loop = std::vector<std::array<double, 2>>;
  std::array<WorkspaceAxis, 2> axes;  ///< across and up
  std::vector<Loop> loops;            ///< closed: counter-clockwise around what is feasible, clockwise around holes
  double area = 0;                    ///< in the product of the axes' units
};

/// @param workspace  of two swept coordinates, whose ranges and held values are taken
Section section_of(const WorkspaceFields& workspace, const PoseMargin& margin);

}  // namespace pkm
