#include "engine/report/isosurface.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "engine/core/catalogue.hpp"
#include "engine/core/error.hpp"
#include "engine/core/team.hpp"

namespace pkm {
namespace {

using Point = std::array<double, 3>;
using Index = std::array<std::size_t, 3>;

/// The nodes: along each axis the cells' centres between two layers on either face of the box, the outer one of which
/// is outside.
class Nodes {
 public:
  explicit Nodes(const WorkspaceFields& workspace)
      : margin_(workspace.field("margin").values), grid_(workspace.grid()) {
    for (std::size_t i = 0; i < 3; ++i) {
      cells_[i] = static_cast<std::size_t>(grid_.cells[i]);
      size[i] = cells_[i] + 2 * kLayers;
    }
  }

  Index size{};  ///< nodes along each axis

  std::size_t number(const Index& n) const { return (n[0] * size[1] + n[1]) * size[2] + n[2]; }
  std::size_t cell(const Index& n) const {
    return (nearest(n, 0) * cells_[1] + nearest(n, 1)) * cells_[2] + nearest(n, 2);
  }
  /// In the outer of the two layers.
  bool beyond(const Index& n) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (n[i] == 0 || n[i] == size[i] - 1) return true;
    return false;
  }
  double margin(const Index& n) const { return beyond(n) ? -1 : margin_[cell(n)]; }
  /// Of the cell whose margin the node has.
  Point centre(const Index& n) const {
    Point at;
    for (std::size_t i = 0; i < 3; ++i) at[i] = grid_.centre(i, static_cast<std::int64_t>(nearest(n, i)));
    return at;
  }
  Point place(const Index& n) const {
    Point at;
    for (std::size_t i = 0; i < 3; ++i)
      at[i] = n[i] < kLayers              ? grid_.lower[i]
              : n[i] >= size[i] - kLayers ? grid_.upper[i]
                                          : grid_.centre(i, static_cast<std::int64_t>(n[i] - kLayers));
    return at;
  }

 private:
  static constexpr std::size_t kLayers = 2;

  std::size_t nearest(const Index& n, std::size_t axis) const {
    return std::clamp(n[axis], kLayers, size[axis] - kLayers - 1) - kLayers;
  }

  const std::vector<double>& margin_;
  VoxelGrid grid_;
  Index cells_{};
};

/// One corner of a cube or tetrahedron.
struct Corner {
  Index node;
  std::size_t direction;  ///< from the cube's first corner: bit i is set where the node is one further along axis i
  double margin;
};

class Builder {
 public:
  explicit Builder(const Nodes& nodes)
      : nodes_(nodes), known_(8 * nodes.size[0] * nodes.size[1] * nodes.size[2], kNew) {}

  void cut_cube(const Index& first) {
    std::array<Corner, 8> corner;
    std::size_t inside = 0;
    for (std::size_t direction = 0; direction < 8; ++direction) {
      const Index node = {first[0] + (direction & 1), first[1] + (direction >> 1 & 1), first[2] + (direction >> 2)};
      corner[direction] = {node, direction, nodes_.margin(node)};
      inside += corner[direction].margin > 0;
    }
    if (inside == 0 || inside == 8) return;
    // Along the axes in each of their six orders from the first corner to the last; the last three are left-handed.
    static constexpr std::array<std::array<std::size_t, 2>, 6> kPaths = {
        {{1, 3}, {2, 6}, {4, 5}, {1, 5}, {2, 3}, {4, 6}}};
    for (std::size_t path = 0; path < 6; ++path)
      cut({&corner[0], &corner[kPaths[path][0]], &corner[kPaths[path][1]], &corner[7]}, path >= 3);
  }

  /// Moves vertices to where the pose's margin changes its sign, but for those on the box.
  void refine(const WorkspaceFields& workspace, const PoseMargin& margin) {
    constexpr std::size_t kBlock = 256;
    const std::size_t count = edges_.size();
    std::vector<std::vector<double>> scratch(workers());
    share_pieces((count + kBlock - 1) / kBlock, [&](std::size_t block, std::size_t end, std::size_t worker) {
      for (std::size_t k = block * kBlock; k < std::min(end * kBlock, count); ++k) {
        if (edges_[k].ends) continue;
        double inside = 0, outside = 1;
        for (int step = 0; step < 7; ++step) {
          const double middle = (inside + outside) / 2;
          (margin(workspace.pose(edges_[k].at(middle)), scratch[worker]) >= 0 ? inside : outside) = middle;
        }
        surface_.vertices[k] = edges_[k].at((inside + outside) / 2);
        if (inside > 0) surface_.inside[k] = edges_[k].at(inside);
      }
    });
  }

  Isosurface take() { return std::move(surface_); }

 private:
  static constexpr std::uint32_t kNew = ~std::uint32_t{0};
  using Tetrahedron = std::array<const Corner*, 4>;

  void cut(Tetrahedron t, bool left_handed) {
    // Bring the inner corners to the front; each exchange of two mirrors the tetrahedron.
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

  /// Where the margin is 0 between two corners; where the box ends, at the inner one, whichever edge leads there.
  std::uint32_t vertex(const Corner& in, const Corner& out) {
    const bool ends = nodes_.beyond(out.node);
    const Corner &low = in.direction < out.direction ? in : out, &high = in.direction < out.direction ? out : in;
    std::uint32_t& number =
        known_[ends ? 8 * nodes_.number(in.node) : 8 * nodes_.number(low.node) + (high.direction ^ low.direction)];
    if (number != kNew) return number;
    number = static_cast<std::uint32_t>(surface_.vertices.size());
    edges_.push_back({nodes_.place(in.node), nodes_.place(out.node), ends});
    surface_.vertices.push_back(edges_.back().at(ends ? 0 : in.margin / (in.margin - out.margin)));
    surface_.inside.push_back(nodes_.centre(in.node));
    return number;
  }

  void add(std::array<std::uint32_t, 3> triangle, bool left_handed) {
    const auto [a, b, c] = triangle;
    if (a == b || b == c || c == a) return;  // between the two layers on the box, which lie at the same place
    if (left_handed) std::swap(triangle[1], triangle[2]);
    surface_.triangles.push_back(triangle);
  }

  /// That a vertex lies on, from the feasible node.
  struct Edge {
    Point from, to;
    bool ends;  ///< at the box

    Point at(double share) const {
      Point point;
      for (std::size_t i = 0; i < 3; ++i) point[i] = from[i] + share * (to[i] - from[i]);
      return point;
    }
  };

  const Nodes& nodes_;
  std::vector<Edge> edges_;  ///< one per vertex
  /// The vertex on every edge, named by its first node and its direction; of a node itself direction 0.
  std::vector<std::uint32_t> known_;
  Isosurface surface_;
};

}  // namespace

Refusal refuse_surface(const std::vector<std::string>& swept) {
  if (swept.size() == 3) return {};
  return "a surface needs three swept coordinates, and this workspace sweeps " + join(swept);
}

Isosurface isosurface(const WorkspaceFields& workspace, const PoseMargin* margin) {
  if (const Refusal reason = refuse_surface(names_of(workspace.axes))) throw std::invalid_argument(*reason);
  const Nodes nodes(workspace);
  Builder builder(nodes);
  for (std::size_t i = 0; i + 1 < nodes.size[0]; ++i)
    for (std::size_t j = 0; j + 1 < nodes.size[1]; ++j)
      for (std::size_t k = 0; k + 1 < nodes.size[2]; ++k) builder.cut_cube({i, j, k});
  if (margin) builder.refine(workspace, *margin);
  return builder.take();
}

}  // namespace pkm
