#include "experiments/app/section.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/team.hpp"

namespace pkm {
namespace {

using Point = std::array<double, 2>;

constexpr std::size_t kSteps = 240;  // between nodes, along each axis
constexpr int kHalvings = 20;

/// Nodes of the grid, and around them a ring of others at the same places, which are outside: outlines close there.
class Nodes {
 public:
  static constexpr std::size_t kAcross = kSteps + 3;

  Nodes(const WorkspaceFields& workspace, const PoseMargin& margin)
      : workspace_(workspace), margin_(margin), inside_(kAcross * kAcross) {
    share_pieces(kSteps + 1, [&](std::size_t row, std::size_t end) {
      for (; row < end; ++row)
        for (std::size_t i = 1; i <= kSteps + 1; ++i) inside_[node(i, row + 1)] = feasible(place(i, row + 1));
    });
  }

  static std::size_t node(std::size_t i, std::size_t j) { return j * kAcross + i; }
  bool inside(std::size_t node) const { return inside_[node] != 0; }
  Point place(std::size_t node) const { return place(node % kAcross, node / kAcross); }
  bool feasible(const Point& at) const {
    std::vector<double> scratch;
    return margin_(workspace_.pose({at[0], at[1], 0}), scratch) >= 0;
  }

  /// Where the margin changes its sign between two nodes.
  Point crossing(std::size_t a, std::size_t b) const {
    Point in = place(inside(a) ? a : b), out = place(inside(a) ? b : a);
    for (int k = 0; k < kHalvings && in != out; ++k) {
      const Point middle = {(in[0] + out[0]) / 2, (in[1] + out[1]) / 2};
      (feasible(middle) ? in : out) = middle;
    }
    return in;
  }

 private:
  Point place(std::size_t i, std::size_t j) const {
    const auto along = [](const WorkspaceAxis& axis, std::size_t k) {
      const double share = static_cast<double>(std::clamp<std::size_t>(k, 1, kSteps + 1) - 1) / kSteps;
      return axis.lower + share * (axis.upper - axis.lower);
    };
    return {along(workspace_.axes[0], i), along(workspace_.axes[1], j)};
  }

  const WorkspaceFields& workspace_;
  const PoseMargin& margin_;
  std::vector<char> inside_;
};

/// Two neighbouring nodes, the lower number first.
using Edge = std::pair<std::size_t, std::size_t>;

/// The outline's steps from edge to edge of the squares, what is feasible being on the left.
std::map<Edge, Edge> steps_of(const Nodes& nodes) {
  std::map<Edge, Edge> steps;
  for (std::size_t j = 0; j + 1 < Nodes::kAcross; ++j)
    for (std::size_t i = 0; i + 1 < Nodes::kAcross; ++i) {
      const std::array corners = {Nodes::node(i, j), Nodes::node(i + 1, j), Nodes::node(i + 1, j + 1),
                                  Nodes::node(i, j + 1)};  // counter-clockwise
      const auto edge = [&](std::size_t k) -> Edge { return std::minmax(corners[k % 4], corners[(k + 1) % 4]); };
      std::vector<std::size_t> ways_in, ways_out;  // of who walks around the square
      for (std::size_t k = 0; k < 4; ++k) {
        const bool before = nodes.inside(corners[k]), after = nodes.inside(corners[(k + 1) % 4]);
        if (!before && after) ways_in.push_back(k);
        if (before && !after) ways_out.push_back(k);
      }
      bool joined = false;  // two opposite corners, through the middle
      if (ways_in.size() == 2) {
        const Point a = nodes.place(corners[0]), b = nodes.place(corners[2]);
        joined = nodes.feasible({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2});
      }
      for (const std::size_t out : ways_out) {
        // The way in that came last before this way out belongs to the same corner, the other one to that opposite.
        const bool other = ways_in.size() == 2 && ((out + 4 - ways_in[0]) % 4 == 1) == joined;
        steps[edge(out)] = edge(ways_in[other ? 1 : 0]);
      }
    }
  return steps;
}

/// Twice the area that a loop goes around counter-clockwise.
double twice_area(const Section::Loop& loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const Point &a = loop[k], &b = loop[(k + 1) % loop.size()];
    sum += (a[0] - loop[0][0]) * (b[1] - loop[0][1]) - (b[0] - loop[0][0]) * (a[1] - loop[0][1]);
  }
  return sum;
}

}  // namespace

Section section_of(const WorkspaceFields& workspace, const PoseMargin& margin) {
  const Nodes nodes(workspace, margin);
  Section section{{workspace.axes[0], workspace.axes[1]}, {}, 0};
  auto steps = steps_of(nodes);
  while (!steps.empty()) {
    Section::Loop loop;
    for (auto step = steps.begin(); step != steps.end();) {
      const Point point = nodes.crossing(step->first.first, step->first.second);
      if (loop.empty() || loop.back() != point) loop.push_back(point);
      const Edge next = step->second;
      steps.erase(step);
      step = steps.find(next);
    }
    section.area += twice_area(loop) / 2;
    section.loops.push_back(std::move(loop));
  }
  return section;
}

}  // namespace pkm
