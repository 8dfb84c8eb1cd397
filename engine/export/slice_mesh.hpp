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
using PointPath = std::vector<std::uint64_t>;              ///< indices of points; closed if first and last are equal
using PathEdge = std::pair<std::uint64_t, std::uint64_t>;  ///< directed, between two indices of points
using MeshPolygon = std::vector<std::uint32_t>;            ///< indices of vertices, counter-clockwise

struct SliceMesh {
  std::array<WorkspaceAxis, 2> axes;  ///< horizontal and vertical
  std::vector<PlanePoint> points;     ///< vertices, all of them feasible
  std::vector<MeshPolygon> polygons;  ///< convex, apart from bisection errors; neighbours share vertices
};

/// Evaluates the margins in parallel on the caller's threads; the result does not depend on their number.
/// @param workspace  has two swept coordinates; gives their ranges and the values of the fixed coordinates
SliceMesh slice_mesh(const WorkspaceFields& workspace, const PoseMargin& margin);

/// The edges that belong to exactly one polygon, directed so that the mesh is on their left.
std::vector<PathEdge> boundary_edges(const std::vector<MeshPolygon>& polygons);

/// Joins directed edges to paths: first the open paths, then the closed ones.
std::vector<PointPath> join_edges(std::vector<PathEdge> edges);

}  // namespace pkm
