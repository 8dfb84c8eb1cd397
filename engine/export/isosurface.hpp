// Triangulates the boundary of a workspace, the zero isosurface of the field `margin`, by marching tetrahedra (Doi and
// Koide 1991).
//
// The nodes are the centres of the cells. Each cube of eight nodes is divided into six tetrahedra around its diagonal;
// in each tetrahedron the surface is a triangle or a quadrilateral between the edges on which the margin changes sign.
// Neighbouring tetrahedra share edges, so the surface is closed and every edge belongs to two triangles. Two additional
// layers of nodes on the faces of the box close the surface there: both have the coordinates of the faces; the inner
// layer repeats the margins of the outer cells, the outer layer is infeasible.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

struct Isosurface {
  std::vector<std::array<double, 3>> vertices;  ///< coordinates of each vertex, in the order of WorkspaceFields::axes
  std::vector<std::array<double, 3>> inside;  ///< for each vertex, a feasible point nearby, at which fields have values
  /// Indices of three vertices, counter-clockwise seen from outside.
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The reason why a workspace has no surface, unless three coordinates are swept; empty if it has one.
/// @param swept  names of the swept coordinates
Unsupported surface_unsupported(const std::vector<std::string>& swept);

/// Computes the surface; it is empty if no cell is feasible. Throws std::invalid_argument if surface_unsupported()
/// gives a reason.
/// @param margin  margin function of the same design, or null. If given, each vertex is located on its edge by
/// bisection of the margin to 1/128 of a cell, in parallel on the caller's threads; if null, by linear interpolation of
/// the margins of the two cells
Isosurface isosurface(const WorkspaceFields& workspace, const PoseMargin* margin = nullptr);

}  // namespace pkm
