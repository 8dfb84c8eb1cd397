#include "engine/report/base_and_motors.hpp"

#include <algorithm>
#include <cmath>

namespace pkm {
namespace {

constexpr double kMotorRadius = 2.2;  // radius of a motor, relative to the largest radius of the links
constexpr double kMotorLength = 3;    // half of the length of a motor, relative to its radius
constexpr double kSamePlace = 1e-9;   // ends whose distance is smaller [m] have the same position

Point3<double> moved(Point3<double> point, const Point3<double>& direction, double distance) {
  for (std::size_t i = 0; i < 3; ++i) point[i] += distance * direction[i];
  return point;
}

double distance(const Point3<double>& a, const Point3<double>& b) {
  const Point3<double> d = difference(a, b);
  return std::sqrt(dot(d, d));
}

/// Sorts points by the angle about their mean, in their plane.
void sort_around_mean(std::vector<Point3<double>>& points) {
  Point3<double> mean{}, normal{};
  for (const auto& p : points) mean = moved(mean, p, 1.0 / static_cast<double>(points.size()));
  const Point3<double> u = difference(points.front(), mean);
  for (const auto& p : points) {
    const Point3<double> n = cross(u, difference(p, mean));
    if (dot(n, n) > dot(normal, normal)) normal = n;
  }
  const Point3<double> v = cross(normal, u);
  const double scale = std::sqrt(dot(v, v) / dot(u, u));
  if (!(scale > 0)) return;  // the points are on one line
  const auto angle = [&](const Point3<double>& p) {
    const Point3<double> d = difference(p, mean);
    return std::atan2(dot(d, v) / scale, dot(d, u));
  };
  std::ranges::stable_sort(points, {}, angle);
}

}  // namespace

DrawnMotors::DrawnMotors(const Mechanism& mechanism, std::span<const double> parameters, const std::string& mode)
    : joints_(mechanism.info().joints) {
  const DesignFacts* const facts = find_design_facts(mechanism);
  if (!facts) return;
  drives_ = facts->drives(parameters, mode);
  ranges_ = facts->joint_ranges(parameters);
}

void DrawnMotors::append(const Pose<double>& pose, std::vector<PlacedLink>& links) const {
  if (!drives_) return;
  double radius = 0;
  for (const PlacedLink& link : links) radius = std::max(radius, kMotorRadius * link.body.radius);
  for (const PlacedDrive& drive : drives_(pose)) {
    double from = -kMotorLength * radius, to = -from;
    if (!drive.rotates && drive.on_base) {
      if (!ranges_[drive.joint]) continue;  // a rail without ends
      to = (*ranges_[drive.joint])[0] - drive.position;
      from = to - kMotorLength * radius;
    }
    links.push_back({"motor of " + joints_[drive.joint].name,
                     kMotorPart,
                     {{moved(drive.point, drive.axis, from), moved(drive.point, drive.axis, to)}, radius}});
  }
}

void append_base(const std::vector<std::vector<PlacedLink>*>& poses) {
  if (poses.empty()) return;
  const std::vector<PlacedLink>& first = *poses.front();
  if (std::ranges::count(first, kFramePart, &PlacedLink::part) > 0) return;
  std::vector<Point3<double>> fixed;
  double radius = 0;
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k].part == kMotorPart || first[k].part == kObstaclePart) continue;
    radius = std::max(radius, first[k].body.radius);
    for (const auto end : {&Segment<double>::from, &Segment<double>::to}) {
      const Point3<double>& at = first[k].body.axis.*end;
      const auto is_here = [&](const Point3<double>& other) { return distance(at, other) < kSamePlace; };
      if (std::ranges::none_of(fixed, is_here) &&
          std::ranges::all_of(poses, [&](const auto* links) { return is_here((*links)[k].body.axis.*end); }))
        fixed.push_back(at);
    }
  }
  if (poses.size() < 2 || fixed.size() < 2) return;
  sort_around_mean(fixed);
  const std::size_t sides = fixed.size() == 2 ? 1 : fixed.size();
  for (std::size_t i = 0; i < sides; ++i)
    for (std::vector<PlacedLink>* const links : poses)
      links->push_back({"base", kFramePart, {{fixed[i], fixed[(i + 1) % fixed.size()]}, radius}});
}

}  // namespace pkm
