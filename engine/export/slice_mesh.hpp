// Polygon mesh of the feasible set of a workspace over two coordinates, by marching squares.
//
// Every grid node is classified as feasible or infeasible. A square with four feasible nodes is a polygon of the mesh.
// A square on the boundary contributes the polygon of its feasible nodes and of the points on its edges at which the
// minimum margin of the pose changes sign; these points are located by bisection. Features smaller than a grid square
// can be missed.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/workspace/workspace_fields.hpp"

namespace pkm {

using PlanePoint = std::array<double, 2>;
/// A path of the mesh, given by the indices of its points; it is closed if the first and the last index are equal.
using PointPath = std::vector<std::uint64_t>;
/// Directed edge from one point to another, as indices of points.
using PathEdge = std::pair<std::uint64_t, std::uint64_t>;
using MeshPolygon = std::vector<std::uint32_t>;  ///< indices of the vertices of a polygon, counter-clockwise

struct SliceMesh {
  std::array<WorkspaceAxis, 2> axes;  ///< the horizontal and the vertical axis
  std::vector<PlanePoint> points;     ///< coordinates of the vertices, all of which are feasible
  /// Polygons of the mesh, convex apart from bisection errors; neighbouring polygons share vertices.
  std::vector<MeshPolygon> polygons;
};

/// Computes the mesh. The margins are evaluated in parallel on the caller's threads; the result does not depend on the
/// number of threads.
/// @param workspace  workspace over two swept coordinates; gives their ranges and the values of the fixed coordinates
SliceMesh slice_mesh(const WorkspaceFields& workspace, const PoseMargin& margin);

/// The edges that belong to exactly one polygon of a mesh, directed so that the mesh is on their left.
std::vector<PathEdge> boundary_edges(const std::vector<MeshPolygon>& polygons);

/// Joins directed edges to paths. Open paths come first in the result, closed ones last.
std::vector<PointPath> join_edges(std::vector<PathEdge> edges);

}  // namespace pkm
