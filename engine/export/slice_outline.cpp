#include "engine/export/slice_outline.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/team.hpp"
#include "engine/math/roots.hpp"

namespace pkm {
namespace {

using PlanePoint = std::array<double, 2>;

constexpr std::size_t kIntervals = 240;    // of the grid, along each axis
constexpr double kEdgeFraction = 0x1p-20;  // accuracy of an outline, relative to the edge of a cell

/// Feasibility of the nodes of a grid. The grid is surrounded by a ring of infeasible nodes at the positions of its
/// border nodes, so that outlines are closed along the border.
class NodeGrid {
 public:
  static constexpr std::size_t kNodesPerRow = kIntervals + 3;

  NodeGrid(const WorkspaceFields& workspace, const PoseMargin& margin)
      : workspace_(workspace), margin_(margin), feasible_(kNodesPerRow * kNodesPerRow) {
    parallel_for(kIntervals + 1, [&](std::size_t row, std::size_t end) {
      for (; row < end; ++row)
        for (std::size_t i = 1; i <= kIntervals + 1; ++i) feasible_[node(i, row + 1)] = is_feasible(point(i, row + 1));
    });
  }

  static std::size_t node(std::size_t i, std::size_t j) { return j * kNodesPerRow + i; }
  bool is_feasible(std::size_t node) const { return feasible_[node] != 0; }
  PlanePoint point(std::size_t node) const { return point(node % kNodesPerRow, node / kNodesPerRow); }
  bool is_feasible(const PlanePoint& at) const {
    Scratch scratch;
    return margin_(workspace_.pose({at[0], at[1], 0}), scratch) >= 0;
  }

  /// Locates the sign change of the margin between two nodes by bisection.
  /// @return the feasible end of the bracket
  PlanePoint crossing(std::size_t a, std::size_t b) const {
    const PlanePoint in = point(is_feasible(a) ? a : b), out = point(is_feasible(a) ? b : a);
    if (in == out) return in;
    const auto at = [&](double t) { return PlanePoint{std::lerp(in[0], out[0], t), std::lerp(in[1], out[1], t)}; };
    return at(bisect([&](double t) { return is_feasible(at(t)); }, {.with = 0, .without = 1}, kEdgeFraction).with);
  }

 private:
  PlanePoint point(std::size_t i, std::size_t j) const {
    const auto coordinate = [](const WorkspaceAxis& axis, std::size_t k) {
      const double fraction = static_cast<double>(std::clamp<std::size_t>(k, 1, kIntervals + 1) - 1) / kIntervals;
      return axis.lower + fraction * (axis.upper - axis.lower);
    };
    return {coordinate(workspace_.axes[0], i), coordinate(workspace_.axes[1], j)};
  }

  const WorkspaceFields& workspace_;
  const PoseMargin& margin_;
  std::vector<char> feasible_;
};

/// Edge of the grid: two neighbouring nodes, the smaller index first.
using Edge = std::pair<std::size_t, std::size_t>;

/// Marching squares: maps each edge that the outline crosses to the edge that it crosses next. The feasible side is on
/// the left of the outline.
std::map<Edge, Edge> outline_steps(const NodeGrid& grid) {
  std::map<Edge, Edge> steps;
  for (std::size_t j = 0; j + 1 < NodeGrid::kNodesPerRow; ++j)
    for (std::size_t i = 0; i + 1 < NodeGrid::kNodesPerRow; ++i) {
      const std::array corners = {NodeGrid::node(i, j), NodeGrid::node(i + 1, j), NodeGrid::node(i + 1, j + 1),
                                  NodeGrid::node(i, j + 1)};  // counter-clockwise
      const auto edge = [&](std::size_t k) -> Edge { return std::minmax(corners[k % 4], corners[(k + 1) % 4]); };
      // Edges where a walk around the square enters and leaves the feasible set.
      std::vector<std::size_t> entries, exits;
      for (std::size_t k = 0; k < 4; ++k) {
        const bool before = grid.is_feasible(corners[k]), after = grid.is_feasible(corners[(k + 1) % 4]);
        if (!before && after) entries.push_back(k);
        if (before && !after) exits.push_back(k);
      }
      bool connected = false;  // ambiguous square: whether the centre connects the two feasible, opposite corners
      if (entries.size() == 2) {
        const PlanePoint a = grid.point(corners[0]), b = grid.point(corners[2]);
        connected = grid.is_feasible({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2});
      }
      for (const std::size_t exit : exits) {
        // The outline turns around the corner between this exit and the entry just before it, unless the corners are
        // connected.
        const bool second = entries.size() == 2 && ((exit + 4 - entries[0]) % 4 == 1) == connected;
        steps[edge(exit)] = edge(entries[second ? 1 : 0]);
      }
    }
  return steps;
}

/// Twice the signed area of a polygon (shoelace formula); positive if it is counter-clockwise.
double twice_area(const SliceOutline::Loop& loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const PlanePoint &a = loop[k], &b = loop[(k + 1) % loop.size()];
    sum += (a[0] - loop[0][0]) * (b[1] - loop[0][1]) - (b[0] - loop[0][0]) * (a[1] - loop[0][1]);
  }
  return sum;
}

}  // namespace

SliceOutline trace_outline(const WorkspaceFields& workspace, const PoseMargin& margin) {
  const NodeGrid grid(workspace, margin);
  SliceOutline outline{{workspace.axes[0], workspace.axes[1]}, {}, 0};
  auto steps = outline_steps(grid);
  while (!steps.empty()) {
    SliceOutline::Loop loop;
    for (auto step = steps.begin(); step != steps.end();) {
      const PlanePoint point = grid.crossing(step->first.first, step->first.second);
      if (loop.empty() || loop.back() != point) loop.push_back(point);
      const Edge next = step->second;
      steps.erase(step);
      step = steps.find(next);
    }
    outline.area += twice_area(loop) / 2;
    outline.loops.push_back(std::move(loop));
  }
  return outline;
}

}  // namespace pkm
