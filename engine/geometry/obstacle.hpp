// Obstacles fixed in the base (boxes, capsules, spheres), and their distances from the links of a mechanism.
//
// Distance of a segment p + t u, 0 <= t <= 1, from a box centred at the origin with half sizes h: it is the minimum
// over t of |e(t)|, where e is the vector from the box to the point x = p + t u, e_i = x_i - clamp(x_i, -h_i, h_i).
// |e|^2 is convex in t, and half its derivative, u . e, is piecewise linear, with breakpoints at the at most six t
// where the segment crosses the planes of the box's faces. The interval in which it changes sign gives the closest
// point in closed form.
//
// If the segment intersects the box, the penetration depth is attained along a normal of a face or along the cross
// product of an edge and the segment: these are the face normals of the Minkowski difference of the two (separating
// axis theorem).
#pragma once

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "engine/geometry/capsule.hpp"

namespace pkm {

/// A box parallel to the axes of the base.
struct SolidBox {
  Point3<double> centre, half;  ///< centre of the box, and half of its length along each axis [m]

  Bounds<double> bounds() const {
    Bounds<double> box;
    for (std::size_t i = 0; i < 3; ++i) {
      box.lower[i] = centre[i] - half[i];
      box.upper[i] = centre[i] + half[i];
    }
    return box;
  }
};

struct Obstacle {
  std::string name;
  std::variant<SolidBox, Capsule<double>> shape;  ///< a sphere is a capsule whose axis is a point
};
using Obstacles = std::vector<Obstacle>;

/// The t in [0, 1] at which the point from + t way of a segment is closest to a box centred at the origin with half
/// sizes `half`.
inline double closest_to_box(const Point3<double>& from, const Point3<double>& way, const Point3<double>& half) {
  const auto derivative = [&](double t) {  // derivative of half the squared distance from the box
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = from[i] + t * way[i];
      sum += way[i] * (x - std::clamp(x, -half[i], half[i]));
    }
    return sum;
  };
  // Values of t at which the segment crosses planes of the box's faces, in ascending order.
  std::array<double, 7> breakpoints{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (const double face : {-half[i], half[i]})
      if (const double t = (face - from[i]) / way[i]; t > 0 && t < 1) {
        std::size_t k = count++;
        for (; k > 0 && breakpoints[k - 1] > t; --k) breakpoints[k] = breakpoints[k - 1];
        breakpoints[k] = t;
      }
  breakpoints[count++] = 1;
  double low = 0, at_low = derivative(0);
  if (!(at_low < 0)) return 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double high = breakpoints[k], at_high = derivative(high);
    if (at_high >= 0) return low - at_low * (high - low) / (at_high - at_low);
    low = high;
    at_low = at_high;
  }
  return 1;
}

/// Penetration depth of a segment that intersects a box centred at the origin: the smallest translation that separates
/// them [m].
template <class S>
S penetration_depth(const Point3<S>& from, const Point3<S>& to, const Point3<double>& half) {
  const Point3<S> way = difference(to, from);
  S depth(std::numeric_limits<double>::infinity());
  const auto test_axis = [&](const Point3<S>& normal) {
    const S square = dot(normal, normal);
    if (!(value_of(square) > 0)) return;
    S reach(0.0);
    for (std::size_t i = 0; i < 3; ++i) reach += half[i] * magnitude(normal[i]);
    const S a = dot(normal, from), b = dot(normal, to);
    depth = min(depth, S(min(S(reach - min(a, b)), S(reach + max(a, b))) / sqrt(square)));
  };
  for (std::size_t i = 0; i < 3; ++i) {
    Point3<S> axis = {S(0.0), S(0.0), S(0.0)};
    axis[i] = S(1.0);
    test_axis(axis);
    test_axis(cross(axis, way));
  }
  return depth;
}

/// Distance of a segment from a box [m]; minus the penetration depth if they intersect.
template <class S>
S box_distance(const Segment<S>& segment, const SolidBox& box) {
  Point3<S> from, to;
  Point3<double> start, way;
  for (std::size_t i = 0; i < 3; ++i) {
    from[i] = segment.from[i] - box.centre[i];
    to[i] = segment.to[i] - box.centre[i];
    start[i] = value_of(from[i]);
    way[i] = value_of(to[i]) - start[i];
  }
  // t is treated as a constant in derivatives, because the derivative of the distance with respect to t vanishes at the
  // closest point
  const double t = closest_to_box(start, way, box.half);
  S square(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const S x = from[i] * (1 - t) + to[i] * t;
    const double h = box.half[i];
    if (value_of(x) > h) square += (x - h) * (x - h);
    if (value_of(x) < -h) square += (x + h) * (x + h);
  }
  return value_of(square) > 0 ? S(sqrt(square)) : S(penetration_depth(from, to, box.half) * -1.0);
}

/// Distance of a link from an obstacle [m]; minus the penetration depth if they overlap.
template <class S>
S obstacle_distance(const Capsule<S>& link, const Obstacle& obstacle) {
  if (const auto* const box = std::get_if<SolidBox>(&obstacle.shape))
    return box_distance(link.axis, *box) - link.radius;
  const auto& [axis, radius] = std::get<Capsule<double>>(obstacle.shape);
  const auto lifted = [](const Point3<double>& p) { return Point3<S>{S(p[0]), S(p[1]), S(p[2])}; };
  return capsule_distance(link, Capsule<S>{{lifted(axis.from), lifted(axis.to)}, S(radius)});
}

/// The closest pair that consists of a moving link (`first`) and an obstacle (`second`).
/// @param moves  indices of the links that are tested; all other links may touch obstacles
template <class S, class Capsules, class Numbers>
ClosestPair<S> nearest_obstacle(const Capsules& all, const Numbers& moves, const Obstacles& obstacles) {
  ClosestPair<S> nearest{S(std::numeric_limits<double>::infinity())};
  for (const std::size_t link : moves)
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      const S found = obstacle_distance(all[link], obstacles[k]);
      if (value_of(found) < value_of(nearest.clearance)) nearest = {found, link, k};
    }
  return nearest;
}

/// True if the distance of each link in `moves` from each obstacle is at least `minimum` [m].
template <class Capsules, class Numbers>
bool respects_obstacle_clearance(const Obstacles& obstacles, const Capsules& all, const Numbers& moves,
                                 double minimum) {
  for (const std::size_t link : moves) {
    const Capsule<double>& body = all[link];
    const Bounds<double> bounds = bounds_of(body.axis);
    for (const Obstacle& obstacle : obstacles) {
      // Skip obstacles whose bounding box is far enough away. The tolerance kRounding [m] covers rounding errors.
      constexpr double kRounding = 1e-9;
      double apart;
      if (const auto* const box = std::get_if<SolidBox>(&obstacle.shape)) {
        apart = distance_of_bounds(bounds, box->bounds());
        if (apart > 0) apart -= body.radius;
      } else {
        const auto& capsule = std::get<Capsule<double>>(obstacle.shape);
        apart = distance_of_bounds(bounds, bounds_of(capsule.axis)) - (body.radius + capsule.radius);
      }
      if (apart > 0 && apart > minimum + kRounding) continue;
      if (obstacle_distance(body, obstacle) < minimum) return false;
    }
  }
  return true;
}

}  // namespace pkm
