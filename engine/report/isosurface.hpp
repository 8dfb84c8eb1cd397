// The surface of a workspace as triangles: where the field `margin` passes through 0.
//
// Marching tetrahedra: nodes are the centres of the cells, cubes of eight nodes are cut into six tetrahedra around
// their diagonal, and in each tetrahedron the surface is a triangle or a quadrilateral between the edges on which the
// margin changes its sign. Neighbouring tetrahedra share edges, so the surface is closed and every edge belongs to
// two triangles. So that it is closed on the box, too, a layer of nodes on the box's faces repeats the margins of the
// outer cells, and a second one at the same place is outside; there the surface goes through the nodes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/report/workspace_fields.hpp"

namespace pkm {

struct Isosurface {
  std::vector<std::array<double, 3>> vertices;  ///< in the order of WorkspaceFields::axes
  std::vector<std::array<double, 3>> inside;    ///< per vertex: a feasible place near it, whose fields it may show
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
};

/// Why a workspace has no surface: it takes three swept coordinates.
/// @param swept  their names
Refusal refuse_surface(const std::vector<std::string>& swept);

/// Empty where no cell is feasible. Throws std::invalid_argument with that sentence.
/// @param margin  of the same design. Without it vertices lie where the margins of two cells, taken as linear between
///                them, have their zero; with it where the pose's own margin changes its sign, to a 128th of a cell,
///                which takes some time and is shared among the team lent to the caller
Isosurface isosurface(const WorkspaceFields& workspace, const PoseMargin* margin = nullptr);

}  // namespace pkm
