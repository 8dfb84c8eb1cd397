#include "engine/export/field_map.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

// Maximum share of the values that may lie beyond the end of the scale, if this end is open.
constexpr double kTail = 0.02;
// A field whose range is smaller than this, relative to its values, counts as constant.
constexpr double kConstant = 1e-9;
constexpr double kMinIntervals = 7;  // minimum number of intervals of a scale

/// Divides polygons into triangles around their centres. A point on an edge of a triangle is identified by the indices
/// of both ends of the edge, a vertex by its index, twice.
class TriangleField {
 public:
  TriangleField(const SliceMesh& mesh, std::span<const double> values)
      : points_(mesh.points), values_(values.begin(), values.end()) {
    for (const MeshPolygon& polygon : mesh.polygons) {
      PlanePoint centre = {0, 0};
      double sum = 0;
      const auto count = static_cast<double>(polygon.size());
      for (const std::uint32_t vertex : polygon) {
        for (std::size_t i = 0; i < 2; ++i) centre[i] += points_[vertex][i] / count;
        sum += values_[vertex] / count;
      }
      if (!std::isfinite(sum)) {
        undefined_.push_back(polygon);
        continue;
      }
      defined_.push_back(polygon);
      const auto middle = static_cast<std::uint32_t>(points_.size());
      points_.push_back(centre);
      values_.push_back(sum);
      for (std::size_t k = 0; k < polygon.size(); ++k)
        triangles_.push_back({polygon[k], polygon[(k + 1) % polygon.size()], middle});
    }
    boundary_ = boundary_edges(defined_);
  }

  FieldRegion defined() const { return region_within(boundary_); }
  FieldRegion undefined() const { return region_within(boundary_edges(undefined_)); }

  FieldRegion region_above(double level) const {
    std::vector<PathEdge> edges, contours;
    const auto above = [&](std::uint64_t vertex) { return values_[vertex] >= level; };
    for (const PathEdge& edge : boundary_) {
      const auto [a, b] = edge;
      if (above(a) || above(b))
        edges.emplace_back(above(a) ? label(a, a) : label(a, b), above(b) ? label(b, b) : label(a, b));
    }
    for (const auto& triangle : triangles_) {
      std::uint64_t from = 0, to = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = triangle[k], b = triangle[(k + 1) % 3];
        if (above(a) && !above(b)) from = label(a, b);
        if (!above(a) && above(b)) to = label(a, b);
      }
      if (from != to) contours.emplace_back(from, to);
    }
    edges.insert(edges.end(), contours.begin(), contours.end());
    FieldRegion region = region_of(join_edges(std::move(edges)), level);
    for (const PointPath& path : join_edges(std::move(contours))) region.contours.push_back(points_of(path, level));
    return region;
  }

 private:
  static std::uint64_t label(std::uint64_t a, std::uint64_t b) { return std::min(a, b) << 32U | std::max(a, b); }

  PlanePoint position(std::uint64_t label, double level) const {
    const std::uint64_t a = label >> 32U, b = label & 0xffffffffU;
    if (a == b) return points_[a];
    const double t = std::clamp((level - values_[a]) / (values_[b] - values_[a]), 0.0, 1.0);
    return {std::lerp(points_[a][0], points_[b][0], t), std::lerp(points_[a][1], points_[b][1], t)};
  }
  std::vector<PlanePoint> points_of(const PointPath& path, double level) const {
    std::vector<PlanePoint> points;
    for (const std::uint64_t at : path) points.push_back(position(at, level));
    return points;
  }
  FieldRegion region_of(const std::vector<PointPath>& paths, double level) const {
    FieldRegion region;
    for (const PointPath& path : paths) {
      region.loops.push_back(points_of(path, level));
      region.loops.back().pop_back();
      region.area += twice_area(region.loops.back()) / 2;
    }
    return region;
  }
  FieldRegion region_within(const std::vector<PathEdge>& boundary) const {
    std::vector<PathEdge> edges;
    for (const PathEdge& edge : boundary)
      edges.emplace_back(label(edge.first, edge.first), label(edge.second, edge.second));
    return region_of(join_edges(std::move(edges)), 0);
  }

  std::vector<PlanePoint> points_;  ///< vertices of the mesh, followed by the centres of the polygons
  std::vector<double> values_;      ///< value of the field at each of the points
  std::vector<MeshPolygon> defined_, undefined_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<PathEdge> boundary_;  ///< boundary edges of the polygons in which the field is defined
};

/// The largest number that is 1, 2 or 5 times a power of ten and divides a length into at least kMinIntervals
/// intervals.
double round_step(double length) {
  const double most = length / kMinIntervals, power = std::pow(10, std::floor(std::log10(most)));
  return power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
}

}  // namespace

std::vector<double> ContourLevels::thresholds() const {
  if (values.size() < 2) return {};
  return {values.begin() + (open_below ? 0 : 1), values.end() - (open_above ? 0 : 1)};
}

ContourLevels contour_levels(std::span<const double> values) {
  std::vector<double> sorted;
  for (const double value : values)
    if (std::isfinite(value)) sorted.push_back(value);
  if (sorted.empty()) return {};
  std::ranges::sort(sorted);
  ContourLevels levels{.values = {}, .minimum = sorted.front(), .maximum = sorted.back()};
  double lower = levels.minimum, upper = levels.maximum;
  if (upper - lower <= kConstant * std::max(std::fabs(lower), std::fabs(upper))) {
    levels.values = {lower};
    return levels;
  }
  const auto last = static_cast<double>(sorted.size() - 1);
  const double low = sorted[static_cast<std::size_t>(kTail * last)],
               high = sorted[static_cast<std::size_t>((1 - kTail) * last)];
  if (high > low) {
    levels.open_below = low - lower > high - low;
    levels.open_above = upper - high > high - low;
    if (levels.open_below) lower = low;
    if (levels.open_above) upper = high;
  }
  const double step = round_step(upper - lower), slack = 1e-9;  // slack: allowance for rounding errors, in steps
  const double first = levels.open_below ? std::ceil(lower / step - slack) : std::floor(lower / step + slack),
               end = levels.open_above ? std::floor(upper / step + slack) : std::ceil(upper / step - slack);
  for (double k = first; k <= end; ++k) levels.values.push_back(step < 1 ? k / std::round(1 / step) : k * step);
  return levels;
}

FieldMap map_field(const SliceMesh& mesh, std::span<const double> values, std::span<const double> thresholds) {
  const TriangleField field(mesh, values);
  FieldMap map{field.defined(), field.undefined(), {}};
  for (const double level : thresholds) map.regions.push_back(field.region_above(level));
  return map;
}

}  // namespace pkm
