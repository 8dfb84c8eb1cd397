#include "engine/export/simplify_line.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

double distance_from_segment(const PlanePoint& p, const PlanePoint& a, const PlanePoint& b) {
  const double x = b[0] - a[0], y = b[1] - a[1], square = x * x + y * y;
  const double t = square > 0 ? std::clamp(((p[0] - a[0]) * x + (p[1] - a[1]) * y) / square, 0.0, 1.0) : 0;
  return std::hypot(p[0] - a[0] - t * x, p[1] - a[1] - t * y);
}

}  // namespace

std::vector<PlanePoint> simplify_line(const std::vector<PlanePoint>& points, double tolerance) {
  if (points.size() < 3) return points;
  std::vector<char> kept(points.size());
  kept.front() = kept.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> open = {{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = tolerance;
    std::size_t at = first;
    for (std::size_t k = first + 1; k < last; ++k)
      if (const double distance = distance_from_segment(points[k], points[first], points[last]); distance > farthest) {
        farthest = distance;
        at = k;
      }
    if (at == first) continue;
    kept[at] = 1;
    open.insert(open.end(), {{first, at}, {at, last}});
  }
  std::vector<PlanePoint> simplified;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (kept[k]) simplified.push_back(points[k]);
  return simplified;
}

std::vector<SliceOutline::Loop> simplify_loops(std::vector<SliceOutline::Loop> loops, double tolerance) {
  for (SliceOutline::Loop& loop : loops) {
    loop.push_back(loop.front());
    loop = simplify_line(loop, tolerance);
    loop.pop_back();
  }
  return loops;
}

}  // namespace pkm
