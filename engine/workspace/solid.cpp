#include "engine/workspace/solid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pkm {
namespace {

/// Points of a unit ball of one, two or three dimensions, on `density` concentric shells and at the centre.
std::vector<std::vector<double>> ball_samples(std::size_t dimension, int density) {
  std::vector<std::vector<double>> points;
  if (dimension == 1) {
    for (int k = -density; k <= density; ++k) points.push_back({static_cast<double>(k) / density});
    return points;
  }
  points.emplace_back(dimension, 0.0);
  for (int shell = 1; shell <= density; ++shell) {
    const double radius = static_cast<double>(shell) / density;
    // Number of intervals of latitude from pole to pole; in the plane, a shell is a single circle.
    const int parallels = dimension == 2 ? 1 : 3 * shell;
    for (int i = dimension == 2 ? 1 : 0; i <= parallels; ++i) {
      const double latitude = dimension == 2 ? 0 : std::numbers::pi * i / parallels - std::numbers::pi / 2;
      const int count = std::max(1, static_cast<int>(std::lround(6 * shell * std::cos(latitude))));
      for (int k = 0; k < count; ++k) {
        const double angle = 2 * std::numbers::pi * k / count;
        std::vector<double> point = {radius * std::cos(latitude) * std::cos(angle),
                                     radius * std::cos(latitude) * std::sin(angle)};
        if (dimension == 3) point.push_back(radius * std::sin(latitude));
        points.push_back(point);
      }
    }
  }
  return points;
}

}  // namespace

SolidShape::SolidShape(SolidKind kind, std::size_t axes, std::size_t cylinder_axis) : kind_(kind) {
  const auto add = [this](std::vector<std::size_t> of) { axes_of_ball_.push_back(std::move(of)); };
  if (kind == SolidKind::box) {
    for (std::size_t i = 0; i < axes; ++i) add({i});
  } else {
    std::vector<std::size_t> round;
    for (std::size_t i = 0; i < axes; ++i)
      if (kind == SolidKind::sphere || i != cylinder_axis) round.push_back(i);
    add(round);
    if (kind == SolidKind::cylinder) add({cylinder_axis});
  }
  ball_of_axis_.resize(axes);
  for (std::size_t ball = 0; ball < balls(); ++ball)
    for (const std::size_t axis : axes_of_ball_[ball]) ball_of_axis_[axis] = ball;
}

std::vector<std::string> SolidShape::dimension_names(const std::vector<std::string>& axis_names) const {
  if (kind_ == SolidKind::box) return axis_names;
  if (kind_ == SolidKind::sphere) return {"diameter"};
  return {"diameter", "height"};
}

std::string SolidShape::name() const {
  if (kind_ == SolidKind::box) return axes() == 2 ? "rectangle" : "box";
  if (kind_ == SolidKind::sphere) return axes() == 2 ? "circle" : "sphere";
  return "cylinder";
}

double SolidShape::volume(const std::vector<double>& dimensions) const {
  double volume = 1;
  for (std::size_t ball = 0; ball < balls(); ++ball) {
    const std::size_t n = axes_of_ball_[ball].size();
    volume *= std::pow(dimensions[ball], static_cast<double>(n)) * (n == 1   ? 1
                                                                    : n == 2 ? std::numbers::pi / 4
                                                                             : std::numbers::pi / 6);
  }
  return volume;
}

SolidSamples SolidShape::samples(int density) const {
  std::vector<UnitPoint> points = {{}};
  for (const std::vector<std::size_t>& of_ball : axes_of_ball_) {
    std::vector<UnitPoint> more;
    const auto in_ball = ball_samples(of_ball.size(), density);
    for (const UnitPoint& point : points)
      for (const std::vector<double>& part : in_ball) {
        more.push_back(point);
        for (std::size_t i = 0; i < of_ball.size(); ++i) more.back()[of_ball[i]] = part[i];
      }
    points = std::move(more);
  }
  // Points at a smaller distance are neighbours; the distance includes the diagonal neighbours of a square lattice.
  const double reach = 1.75 / density;
  std::vector<std::vector<std::size_t>> neighbours(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis)
        square += (points[i][axis] - points[k][axis]) * (points[i][axis] - points[k][axis]);
      if (square > reach * reach) continue;
      neighbours[i].push_back(k);
      neighbours[k].push_back(i);
    }
  return {std::move(points), std::move(neighbours)};
}

}  // namespace pkm
