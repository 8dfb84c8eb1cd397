#include "engine/export/slice_mesh.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/team.hpp"
#include "engine/math/roots.hpp"

namespace pkm {
namespace {

// Number of intervals, and of nodes, of the grid along each axis.
constexpr std::size_t kIntervals = 240, kNodesPerRow = kIntervals + 1;
constexpr double kEdgeFraction = 0x1p-20;  // accuracy of a boundary point, relative to the edge of a square
constexpr std::uint32_t kNone = ~std::uint32_t{0};

/// Feasibility of the nodes of a regular grid that covers the ranges of both coordinates.
class NodeGrid {
 public:
  NodeGrid(const WorkspaceFields& workspace, const PoseMargin& margin)
      : workspace_(workspace), margin_(margin), feasible_(kNodesPerRow * kNodesPerRow) {
    parallel_for(kNodesPerRow, [&](std::size_t row, std::size_t end) {
      for (; row < end; ++row)
        for (std::size_t i = 0; i < kNodesPerRow; ++i) feasible_[node(i, row)] = is_feasible(point(node(i, row)));
    });
  }

  static std::size_t node(std::size_t i, std::size_t j) { return j * kNodesPerRow + i; }
  std::size_t node_count() const { return feasible_.size(); }
  bool is_feasible(std::size_t node) const { return feasible_[node] != 0; }
  bool is_feasible(const PlanePoint& at) const {
    Scratch scratch;
    return margin_(workspace_.pose({at[0], at[1], 0}), scratch) >= 0;
  }
  PlanePoint point(std::size_t node) const {
    const auto coordinate = [](const WorkspaceAxis& axis, std::size_t k) {
      return axis.lower + static_cast<double>(k) / kIntervals * (axis.upper - axis.lower);
    };
    return {coordinate(workspace_.axes[0], node % kNodesPerRow), coordinate(workspace_.axes[1], node / kNodesPerRow)};
  }
  /// Locates, by bisection, the point between two nodes at which the margin changes sign.
  /// @return the end of the final bracket that is feasible
  PlanePoint crossing(std::size_t a, std::size_t b) const {
    const PlanePoint in = point(is_feasible(a) ? a : b), out = point(is_feasible(a) ? b : a);
    const auto at = [&](double t) { return PlanePoint{std::lerp(in[0], out[0], t), std::lerp(in[1], out[1], t)}; };
    return at(bisect([&](double t) { return is_feasible(at(t)); }, {.with = 0, .without = 1}, kEdgeFraction).with);
  }

 private:
  const WorkspaceFields& workspace_;
  const PoseMargin& margin_;
  std::vector<char> feasible_;
};

/// The vertices of the mesh: the feasible nodes, and the points where the margin changes sign on edges of the grid.
class MeshVertices {
 public:
  MeshVertices(const NodeGrid& grid, std::vector<PlanePoint>& points)
      : of_node_(grid.node_count(), kNone), of_edge_(2 * grid.node_count(), kNone) {
    for (std::size_t node = 0; node < grid.node_count(); ++node) {
      if (!grid.is_feasible(node)) continue;
      of_node_[node] = static_cast<std::uint32_t>(points.size());
      points.push_back(grid.point(node));
    }
    std::vector<std::pair<std::size_t, std::size_t>> crossed;
    const std::size_t first = points.size();
    for (std::size_t node = 0; node < grid.node_count(); ++node)
      for (const std::size_t step : {std::size_t{1}, kNodesPerRow}) {
        const bool ends = step == 1 ? node % kNodesPerRow == kIntervals : node + step >= grid.node_count();
        if (ends || grid.is_feasible(node) == grid.is_feasible(node + step)) continue;
        of_edge_[edge(node, node + step)] = static_cast<std::uint32_t>(first + crossed.size());
        crossed.emplace_back(node, node + step);
      }
    points.resize(first + crossed.size());
    parallel_for(crossed.size(), [&](std::size_t k, std::size_t end) {
      for (; k < end; ++k) points[first + k] = grid.crossing(crossed[k].first, crossed[k].second);
    });
  }

  std::uint32_t of_node(std::size_t node) const { return of_node_[node]; }
  std::uint32_t of_edge(std::size_t a, std::size_t b) const { return of_edge_[edge(a, b)]; }

 private:
  /// Index of the grid edge between two neighbouring nodes.
  static std::size_t edge(std::size_t a, std::size_t b) {
    const auto [first, second] = std::minmax(a, b);
    return 2 * first + (second - first == 1 ? 0 : 1);
  }

  std::vector<std::uint32_t> of_node_, of_edge_;
};

}  // namespace

SliceMesh slice_mesh(const WorkspaceFields& workspace, const PoseMargin& margin) {
  const NodeGrid grid(workspace, margin);
  SliceMesh mesh{{workspace.axes[0], workspace.axes[1]}, {}, {}};
  const MeshVertices vertices(grid, mesh.points);
  for (std::size_t j = 0; j < kIntervals; ++j)
    for (std::size_t i = 0; i < kIntervals; ++i) {
      const std::array corners = {NodeGrid::node(i, j), NodeGrid::node(i + 1, j), NodeGrid::node(i + 1, j + 1),
                                  NodeGrid::node(i, j + 1)};  // the nodes of the square, counter-clockwise
      MeshPolygon polygon;
      std::vector<std::size_t> feasible;
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t corner = corners[k], next = corners[(k + 1) % 4];
        if (grid.is_feasible(corner)) {
          polygon.push_back(vertices.of_node(corner));
          feasible.push_back(k);
        }
        if (grid.is_feasible(corner) != grid.is_feasible(next)) polygon.push_back(vertices.of_edge(corner, next));
      }
      if (polygon.empty()) continue;
      // True if the square has two feasible nodes at opposite corners.
      const bool ambiguous = feasible.size() == 2 && polygon.size() == 6;
      const PlanePoint a = grid.point(corners[0]), b = grid.point(corners[2]);
      if (!ambiguous || grid.is_feasible(PlanePoint{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2})) {
        mesh.polygons.push_back(std::move(polygon));
        continue;
      }
      for (const std::size_t k : feasible)
        mesh.polygons.push_back({vertices.of_edge(corners[(k + 3) % 4], corners[k]), vertices.of_node(corners[k]),
                                 vertices.of_edge(corners[k], corners[(k + 1) % 4])});
    }
  return mesh;
}

std::vector<PathEdge> boundary_edges(const std::vector<MeshPolygon>& polygons) {
  std::vector<PathEdge> edges, boundary;
  for (const MeshPolygon& polygon : polygons)
    for (std::size_t k = 0; k < polygon.size(); ++k) edges.emplace_back(polygon[k], polygon[(k + 1) % polygon.size()]);
  const auto key = [](const PathEdge& edge) -> PathEdge { return std::minmax(edge.first, edge.second); };
  std::ranges::sort(edges, {}, key);
  for (std::size_t k = 0; k < edges.size(); ++k)
    if (k + 1 < edges.size() && key(edges[k]) == key(edges[k + 1]))
      ++k;  // skip an edge and its reverse, which cancel because the edge is between two polygons
    else
      boundary.push_back(edges[k]);
  return boundary;
}

std::vector<PointPath> join_edges(std::vector<PathEdge> edges) {
  std::ranges::sort(edges);
  std::vector<std::uint64_t> ends;
  for (const PathEdge& edge : edges) ends.push_back(edge.second);
  std::ranges::sort(ends);
  std::vector<char> used(edges.size());
  std::vector<PointPath> paths;
  const auto follow = [&](std::size_t first) {
    PointPath path = {edges[first].first};
    for (std::size_t k = first; k < edges.size() && edges[k].first == path.back();) {
      if (used[k]) {
        ++k;  // another edge can begin at the same point
        continue;
      }
      used[k] = 1;
      path.push_back(edges[k].second);
      if (path.back() == path.front()) break;
      k = static_cast<std::size_t>(std::ranges::lower_bound(edges, PathEdge{path.back(), 0}) - edges.begin());
    }
    paths.push_back(std::move(path));
  };
  for (const bool open : {true, false})
    for (std::size_t k = 0; k < edges.size(); ++k)
      if (!used[k] && (!open || !std::ranges::binary_search(ends, edges[k].first))) follow(k);
  return paths;
}

}  // namespace pkm
