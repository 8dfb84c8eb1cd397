// What stands fixed in the base, and how far links are from it.
//
// The distance of a segment p + t u, 0 <= t <= 1, from a box about the origin with half sizes h is the least length of
// e(t), whose components are those of p + t u beyond the box: e_i = x_i - clamp(x_i, -h_i, h_i). |e|^2 is convex in t,
// and half its derivative, u . e, is made of straight pieces between the at most six t at which the segment crosses a
// plane of the box's faces: the piece on which it changes its sign has the nearest point in closed form. Where the
// segment passes through the box, the shortest way that frees it is along a normal of a face or along the product of an
// edge and the segment: these are the normals of the faces of all differences of the two (a convex polytope).
#pragma once

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "engine/model/capsule.hpp"

namespace pkm {

/// A box along the axes of the base.
struct SolidBox {
  Point3<double> centre, half;  ///< [m]; half: half of its sizes

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
  std::variant<SolidBox, Capsule<double>> shape;  ///< a sphere is a capsule whose segment is a point
};
using Obstacles = std::vector<Obstacle>;

/// Where on a segment the point is that is nearest to a box about the origin: in [0, 1].
inline double nearest_to_box(const Point3<double>& from, const Point3<double>& way, const Point3<double>& half) {
  const auto slope = [&](double t) {  // of |e|^2 / 2
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = from[i] + t * way[i];
      sum += way[i] * (x - std::clamp(x, -half[i], half[i]));
    }
    return sum;
  };
  std::array<double, 7> ends{};  // ascending
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (const double face : {-half[i], half[i]})
      if (const double t = (face - from[i]) / way[i]; t > 0 && t < 1) {
        std::size_t k = count++;
        for (; k > 0 && ends[k - 1] > t; --k) ends[k] = ends[k - 1];
        ends[k] = t;
      }
  ends[count++] = 1;
  double low = 0, slope_low = slope(0);
  if (!(slope_low < 0)) return 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double high = ends[k], slope_high = slope(high);
    if (slope_high >= 0) return low - slope_low * (high - low) / (slope_high - slope_low);
    low = high;
    slope_low = slope_high;
  }
  return 1;
}

/// How far a segment that passes through a box about the origin has to be moved to leave it.
template <class S>
S way_out_of_box(const Point3<S>& from, const Point3<S>& to, const Point3<double>& half) {
  const Point3<S> way = difference(to, from);
  S least(std::numeric_limits<double>::infinity());
  const auto look = [&](const Point3<S>& normal) {
    const S square = dot(normal, normal);
    if (!(value_of(square) > 0)) return;
    S reach(0.0);
    for (std::size_t i = 0; i < 3; ++i) reach += half[i] * magnitude(normal[i]);
    const S a = dot(normal, from), b = dot(normal, to);
    least = min(least, S(min(S(reach - min(a, b)), S(reach + max(a, b))) / sqrt(square)));
  };
  for (std::size_t i = 0; i < 3; ++i) {
    Point3<S> axis = {S(0.0), S(0.0), S(0.0)};
    axis[i] = S(1.0);
    look(axis);
    look(cross(axis, way));
  }
  return least;
}

/// Distance of a segment from a box; where it passes through, minus the length by which one has to be moved for the two
/// to touch only.
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
  // the nearest point's place on the segment may stand still in derivatives: there the distance does not depend on it
  const double t = nearest_to_box(start, way, box.half);
  S square(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const S x = from[i] * (1 - t) + to[i] * t;
    const double h = box.half[i];
    if (value_of(x) > h) square += (x - h) * (x - h);
    if (value_of(x) < -h) square += (x + h) * (x + h);
  }
  return value_of(square) > 0 ? S(sqrt(square)) : S(way_out_of_box(from, to, box.half) * -1.0);
}

/// Distance of a link from an obstacle; negative where they overlap, as capsule_distance has it.
template <class S>
S obstacle_distance(const Capsule<S>& link, const Obstacle& obstacle) {
  if (const auto* const box = std::get_if<SolidBox>(&obstacle.shape))
    return box_distance(link.axis, *box) - link.radius;
  const auto& [axis, radius] = std::get<Capsule<double>>(obstacle.shape);
  const auto lifted = [](const Point3<double>& p) { return Point3<S>{S(p[0]), S(p[1]), S(p[2])}; };
  return capsule_distance(link, Capsule<S>{{lifted(axis.from), lifted(axis.to)}, S(radius)});
}

/// What is nearest of several links and several obstacles: `first` is the link, `second` the obstacle.
/// @param moves  numbers of the links that move; others may touch what stands
template <class S, class Capsules, class Numbers>
Nearest<S> nearest_obstacle(const Capsules& all, const Numbers& moves, const Obstacles& obstacles) {
  Nearest<S> nearest{S(std::numeric_limits<double>::infinity())};
  for (const std::size_t link : moves)
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
      const S found = obstacle_distance(all[link], obstacles[k]);
      if (value_of(found) < value_of(nearest.clearance)) nearest = {found, link, k};
    }
  return nearest;
}

/// Whether no link is nearer to an obstacle than `least` [m].
template <class Capsules, class Numbers>
bool keep_clear_of(const Obstacles& obstacles, const Capsules& all, const Numbers& moves, double least) {
  for (const std::size_t link : moves) {
    const Capsule<double>& body = all[link];
    const Bounds<double> bounds = bounds_of(body.axis);
    for (const Obstacle& obstacle : obstacles) {
      // boxes that are apart by more than rounding could matter need no closer look
      constexpr double kRounding = 1e-9;
      double apart;
      if (const auto* const box = std::get_if<SolidBox>(&obstacle.shape)) {
        apart = distance_of_bounds(bounds, box->bounds());
        if (apart > 0) apart -= body.radius;
      } else {
        const auto& capsule = std::get<Capsule<double>>(obstacle.shape);
        apart = distance_of_bounds(bounds, bounds_of(capsule.axis)) - (body.radius + capsule.radius);
      }
      if (apart > 0 && apart > least + kRounding) continue;
      if (obstacle_distance(body, obstacle) < least) return false;
    }
  }
  return true;
}

}  // namespace pkm
