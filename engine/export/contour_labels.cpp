#include "engine/export/contour_labels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pkm {
namespace {

// Minimum distance of a label from other labels, and from the outline [pixel].
constexpr double kLabelDistance = 44, kOutlineDistance = 9;
constexpr double kMinStraight = 0.97;  // minimum ratio of the distance of a label's ends to the arc length between them
constexpr double kClearance = 8;       // minimum distance between a label and the ends of its line [pixel]
constexpr double kGap = 3;             // gap between a label and the rest of its line [pixel]
constexpr double kStep = 6;            // distance between candidate positions [pixel]

double distance(const PlanePoint& a, const PlanePoint& b) { return std::hypot(b[0] - a[0], b[1] - a[1]); }

bool is_near(const PlanePoint& at, const std::vector<PlanePoint>& others, double limit) {
  return std::ranges::any_of(others, [&](const PlanePoint& other) { return distance(at, other) < limit; });
}

/// A polyline, with the arc length from its beginning to each of its points.
class MeasuredLine {
 public:
  explicit MeasuredLine(const std::vector<PlanePoint>& points) : points_(points), along_({0}) {
    for (std::size_t k = 1; k < points.size(); ++k)
      along_.push_back(along_.back() + distance(points[k - 1], points[k]));
  }
  double length() const { return along_.back(); }
  PlanePoint point(double s) const {
    const std::size_t k = std::clamp<std::size_t>(first_beyond(s), 1, points_.size() - 1);
    const double step = along_[k] - along_[k - 1], t = step > 0 ? (s - along_[k - 1]) / step : 0;
    return {std::lerp(points_[k - 1][0], points_[k][0], t), std::lerp(points_[k - 1][1], points_[k][1], t)};
  }
  std::vector<PlanePoint> until(double s) const {
    std::vector<PlanePoint> part(points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(first_beyond(s)));
    part.push_back(point(s));
    return part;
  }
  std::vector<PlanePoint> from(double s) const {
    std::vector<PlanePoint> part = {point(s)};
    part.insert(part.end(), points_.begin() + static_cast<std::ptrdiff_t>(first_beyond(s)), points_.end());
    return part;
  }

 private:
  std::size_t first_beyond(double s) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(along_, s) - along_.begin());
  }

  const std::vector<PlanePoint>& points_;
  std::vector<double> along_;
};

}  // namespace

std::optional<LabelPlace> place_label(const std::vector<PlanePoint>& line, double length,
                                      const std::vector<PlanePoint>& labels, const std::vector<PlanePoint>& outline) {
  const MeasuredLine measured(line);
  const double middle = measured.length() / 2, half = length / 2;
  for (double offset = 0; offset <= middle - half - kClearance; offset += kStep)
    for (const double s : {middle - offset, middle + offset}) {
      const PlanePoint from = measured.point(s - half), to = measured.point(s + half),
                       at = {(from[0] + to[0]) / 2, (from[1] + to[1]) / 2};
      if (distance(from, to) < kMinStraight * length || is_near(at, labels, kLabelDistance)) continue;
      const std::array places = {from, at, to};
      if (std::ranges::any_of(places, [&](const auto& place) { return is_near(place, outline, kOutlineDistance); }))
        continue;
      double angle = std::atan2(from[1] - to[1], to[0] - from[0]) * 180 / std::numbers::pi;
      if (angle > 90) angle -= 180;
      if (angle <= -90) angle += 180;
      return LabelPlace{at, angle, measured.until(s - half - kGap), measured.from(s + half + kGap)};
    }
  return std::nullopt;
}

}  // namespace pkm
