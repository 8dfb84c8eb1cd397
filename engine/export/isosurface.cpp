#include "engine/export/isosurface.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/team.hpp"
#include "engine/math/roots.hpp"

namespace pkm {
namespace {

using Point = std::array<double, 3>;
using Index = std::array<std::size_t, 3>;

/// Grid of the nodes of marching tetrahedra. Along each axis, there is one node at the centre of each cell. On each
/// face of the box there are two additional, coincident layers of nodes, the outer of which is infeasible.
class Nodes {
 public:
  explicit Nodes(const WorkspaceFields& workspace)
      : margin_(workspace.field("margin").values), grid_(workspace.grid()) {
    for (std::size_t i = 0; i < 3; ++i) {
      cells_[i] = static_cast<std::size_t>(grid_.cells[i]);
      size[i] = cells_[i] + 2 * kLayers;
    }
  }

  Index size{};  ///< number of nodes along each axis

  std::size_t number(const Index& n) const { return (n[0] * size[1] + n[1]) * size[2] + n[2]; }
  /// Index of the cell whose margin is that of a node.
  std::size_t cell(const Index& n) const {
    return (nearest(n, 0) * cells_[1] + nearest(n, 1)) * cells_[2] + nearest(n, 2);
  }
  /// Returns true if the node is in the outer of the two layers on a face of the box.
  bool is_outer(const Index& n) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (n[i] == 0 || n[i] == size[i] - 1) return true;
    return false;
  }
  double margin(const Index& n) const { return is_outer(n) ? -1 : margin_[cell(n)]; }
  /// Centre of the cell whose margin is that of a node.
  Point centre(const Index& n) const {
    Point at;
    for (std::size_t i = 0; i < 3; ++i) at[i] = grid_.centre(i, static_cast<std::int64_t>(nearest(n, i)));
    return at;
  }
  Point position(const Index& n) const {
    Point at;
    for (std::size_t i = 0; i < 3; ++i)
      at[i] = n[i] < kLayers              ? grid_.lower[i]
              : n[i] >= size[i] - kLayers ? grid_.upper[i]
                                          : grid_.centre(i, static_cast<std::int64_t>(n[i] - kLayers));
    return at;
  }

 private:
  static constexpr std::size_t kLayers = 2;  ///< number of layers on each face of the box

  /// Index, along an axis, of the cell that is nearest to a node.
  std::size_t nearest(const Index& n, std::size_t axis) const {
    return std::clamp(n[axis], kLayers, size[axis] - kLayers - 1) - kLayers;
  }

  const std::vector<double>& margin_;
  VoxelGrid grid_;
  Index cells_{};
};

/// A vertex of a cube, or of a tetrahedron, of the grid.
struct Corner {
  Index node;
  std::size_t direction;  ///< bit i is set if the node is one step along axis i from the cube's first corner
  double margin;
};

/// Builds the surface by marching tetrahedra.
class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(const Nodes& nodes)
      : nodes_(nodes), vertex_of_edge_(8 * nodes.size[0] * nodes.size[1] * nodes.size[2], kNoVertex) {}

  void cut_cube(const Index& first) {
    std::array<Corner, 8> corner;
    std::size_t inside = 0;
    for (std::size_t direction = 0; direction < 8; ++direction) {
      const Index node = {first[0] + (direction & 1), first[1] + (direction >> 1 & 1), first[2] + (direction >> 2)};
      corner[direction] = {node, direction, nodes_.margin(node)};
      inside += corner[direction].margin > 0;
    }
    if (inside == 0 || inside == 8) return;
    // Each tetrahedron follows a path along three edges from the first corner to the last, one for each order of the
    // three axes. The last three tetrahedra are left-handed.
    static constexpr std::array<std::array<std::size_t, 2>, 6> kPaths = {
        {{1, 3}, {2, 6}, {4, 5}, {1, 5}, {2, 3}, {4, 6}}};
    for (std::size_t path = 0; path < 6; ++path)
      cut({&corner[0], &corner[kPaths[path][0]], &corner[kPaths[path][1]], &corner[7]}, path >= 3);
  }

  /// Moves the vertices, except those on the faces of the box, to the sign change of the margin of the pose by
  /// bisection.
  void refine(const WorkspaceFields& workspace, const PoseMargin& margin) {
    constexpr std::size_t kBlock = 256;  // number of vertices of a work item
    // Accuracy of the position of a vertex, relative to the length of its edge.
    constexpr double kEdgeFraction = 1.0 / 128;
    const std::size_t count = edges_.size();
    std::vector<Scratch> scratch(workers());
    parallel_for((count + kBlock - 1) / kBlock, [&](std::size_t block, std::size_t end, std::size_t worker) {
      for (std::size_t k = block * kBlock; k < std::min(end * kBlock, count); ++k) {
        if (edges_[k].on_box) continue;
        const auto is_inside = [&](double fraction) {
          return margin(workspace.pose(edges_[k].at(fraction)), scratch[worker]) >= 0;
        };
        // The margin does not change its sign here: the surface is a singularity, beyond which another component lies
        // that is not part of the workspace.
        if (is_inside(1)) continue;
        const Bracket bracket = bisect(is_inside, {.with = 0, .without = 1}, kEdgeFraction);
        surface_.vertices[k] = edges_[k].at(bracket.middle());
        if (bracket.with > 0) surface_.inside[k] = edges_[k].at(bracket.with);
      }
    });
  }

  Isosurface take() { return std::move(surface_); }

 private:
  static constexpr std::uint32_t kNoVertex = ~std::uint32_t{0};
  using Tetrahedron = std::array<const Corner*, 4>;

  void cut(Tetrahedron t, bool left_handed) {
    // Sort the feasible corners of the tetrahedron to the front; each swap of two corners changes its handedness.
    std::size_t inside = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (!(t[i]->margin > 0)) continue;
      if (i != inside) {
        std::swap(t[i], t[inside]);
        left_handed = !left_handed;
      }
      ++inside;
    }
    const auto v = [&](std::size_t in, std::size_t out) { return vertex(*t[in], *t[out]); };
    if (inside == 1) add({v(0, 1), v(0, 2), v(0, 3)}, left_handed);
    if (inside == 3) add({v(0, 3), v(1, 3), v(2, 3)}, left_handed);
    if (inside != 2) return;
    add({v(0, 2), v(0, 3), v(1, 3)}, left_handed);
    add({v(0, 2), v(1, 3), v(1, 2)}, left_handed);
  }

  /// The vertex on an edge between a feasible and an infeasible corner: at the zero of the linearly interpolated
  /// margin, or, if the infeasible corner is an outer node, at the feasible corner (one vertex for all such edges).
  std::uint32_t vertex(const Corner& in, const Corner& out) {
    const bool on_box = nodes_.is_outer(out.node);
    const Corner &low = in.direction < out.direction ? in : out, &high = in.direction < out.direction ? out : in;
    std::uint32_t& number = vertex_of_edge_[on_box ? 8 * nodes_.number(in.node)
                                                   : 8 * nodes_.number(low.node) + (high.direction ^ low.direction)];
    if (number != kNoVertex) return number;
    number = static_cast<std::uint32_t>(surface_.vertices.size());
    edges_.push_back({nodes_.position(in.node), nodes_.position(out.node), on_box});
    surface_.vertices.push_back(edges_.back().at(on_box ? 0 : in.margin / (in.margin - out.margin)));
    surface_.inside.push_back(nodes_.centre(in.node));
    return number;
  }

  void add(std::array<std::uint32_t, 3> triangle, bool left_handed) {
    const auto [a, b, c] = triangle;
    // Omits degenerate triangles between the coincident layers on a face of the box.
    if (a == b || b == c || c == a) return;
    if (left_handed) std::swap(triangle[1], triangle[2]);
    surface_.triangles.push_back(triangle);
  }

  /// The edge on which a vertex lies, from its feasible to its infeasible node.
  struct Edge {
    Point from, to;
    bool on_box;  ///< true if the infeasible node is in an outer layer on a face of the box

    Point at(double fraction) const {
      Point point;
      for (std::size_t i = 0; i < 3; ++i) point[i] = from[i] + fraction * (to[i] - from[i]);
      return point;
    }
  };

  const Nodes& nodes_;
  std::vector<Edge> edges_;  ///< the edge on which each vertex lies
  /// Index of the vertex on each edge. The key of an edge is 8 * (number of its first node) + direction; with direction
  /// 0, the vertex is at the node itself.
  std::vector<std::uint32_t> vertex_of_edge_;
  Isosurface surface_;
};

}  // namespace

Unsupported surface_unsupported(const std::vector<std::string>& swept) {
  if (swept.size() == 3) return {};
  return "a surface needs three swept coordinates; this workspace sweeps " + join(swept);
}

Isosurface isosurface(const WorkspaceFields& workspace, const PoseMargin* margin) {
  if (const Unsupported reason = surface_unsupported(names_of(workspace.axes))) throw std::invalid_argument(*reason);
  const Nodes nodes(workspace);
  SurfaceBuilder builder(nodes);
  for (std::size_t i = 0; i + 1 < nodes.size[0]; ++i)
    for (std::size_t j = 0; j + 1 < nodes.size[1]; ++j)
      for (std::size_t k = 0; k + 1 < nodes.size[2]; ++k) builder.cut_cube({i, j, k});
  if (margin) builder.refine(workspace, *margin);
  return builder.take();
}

}  // namespace pkm
