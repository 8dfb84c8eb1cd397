#include "engine/math/hypervolume.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

template <std::size_t N>
using Point = std::array<double, N>;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// The finite points that are better than the reference point, in lexicographic order: every point comes after all
/// points that dominate it, and duplicates are adjacent.
template <std::size_t N>
std::vector<Point<N>> sorted_points(std::span<const double> points, const Point<N>& reference) {
  std::vector<Point<N>> inside;
  inside.reserve(points.size() / N);
  for (std::size_t row = 0; row < points.size(); row += N) {
    Point<N> point;
    bool is_inside = true;
    for (std::size_t k = 0; k < N; ++k) {
      point[k] = points[row + k];
      is_inside = is_inside && std::isfinite(point[k]) && point[k] < reference[k];
    }
    if (is_inside) inside.push_back(point);
  }
  // The points of a study's archive are often sorted already; the test then saves the time for sorting.
  if (!std::is_sorted(inside.begin(), inside.end())) std::sort(inside.begin(), inside.end());
  return inside;
}

/// Area dominated by points in a plane that are sorted by x, as a sum of rectangles.
double area(const std::vector<Point<2>>& points, const Point<2>& reference) {
  double sum = 0, min_y = reference[1];
  for (const auto& [x, y] : points) {
    if (y >= min_y) continue;
    sum += (reference[0] - x) * (min_y - y);
    min_y = y;
  }
  return sum;
}

/// Area dominated by points in a plane, updated as points are added. The non-dominated points (steps) are stored in a
/// sorted vector rather than a tree, because slices of a front have few steps: 10000 points on a sphere take 1.3 ms in
/// total, and 8 ms in the worst case where every point is a step.
class Staircase {
 public:
  explicit Staircase(const Point<2>& reference) : steps_{{-kUnbounded, reference[1]}, {reference[0], -kUnbounded}} {}

  double area() const { return area_; }

  /// Adds a point. @return false if an earlier point equals it or dominates it; the area is then unchanged
  bool add(const Point<2>& point) {
    const auto [x, y] = point;
    const auto first =
        std::upper_bound(steps_.begin(), steps_.end(), x, [](double value, const Point<2>& s) { return value < s[0]; });
    double left = x, top = (*(first - 1))[1];
    if (top <= y) return false;
    auto last = first;  // [first, last): the steps that the new point dominates
    for (; (*last)[1] >= y; ++last) {
      area_ += ((*last)[0] - left) * (top - y);
      left = (*last)[0];
      top = (*last)[1];
    }
    area_ += ((*last)[0] - left) * (top - y);
    if (first == last) {
      steps_.insert(first, point);
    } else {
      *first = point;
      steps_.erase(first + 1, last);
    }
    return true;
  }

 private:
  /// The non-dominated points, with x non-decreasing and y decreasing; the first and the last element are sentinels on
  /// the lines through the reference point.
  std::vector<Point<2>> steps_;
  double area_ = 0;
};

/// Sweep along the first coordinate: between two consecutive points, the dominated area of the slice is constant and
/// given by the points already passed.
double volume(const std::vector<Point<3>>& points, const Point<3>& reference) {
  Staircase slice({reference[1], reference[2]});
  double sum = 0, last_x = 0;
  for (const auto& [x, y, z] : points) {
    const double slice_area = slice.area();
    if (!slice.add({y, z})) continue;
    sum += slice_area * (x - last_x);
    last_x = x;
  }
  return sum + slice.area() * (reference[0] - last_x);
}

}  // namespace

double hypervolume(std::span<const double> points, std::size_t objectives, std::span<const double> reference) {
  if (objectives != 2 && objectives != 3)
    throw std::invalid_argument("hypervolume: found " + std::to_string(objectives) + " objectives; expected 2 or 3");
  PKM_EXPECTS(reference.size() == objectives && points.size() % objectives == 0);
  for (const double value : reference)
    if (!std::isfinite(value)) throw std::invalid_argument("hypervolume: the reference point is not finite");
  if (objectives == 2) {
    const Point<2> upper = {reference[0], reference[1]};
    return area(sorted_points(points, upper), upper);
  }
  const Point<3> upper = {reference[0], reference[1], reference[2]};
  return volume(sorted_points(points, upper), upper);
}

}  // namespace pkm
