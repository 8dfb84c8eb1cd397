// Distance between two segments and between two capsules (sphere-swept segments); capsules model the links of a
// mechanism in clearance checks.
//
// The closest points of two segments p + s u and q + t v with r = q - p minimise a convex quadratic function of (s, t)
// over the unit square. With n = u x v, its unconstrained minimum is at
//
//   s = (r x v) . n / |n|^2
//
// If it lies outside the square, three steps give the constrained minimum: clamp s, compute the best t for that s, and
// if t has to be clamped, compute the best s for the clamped t and clamp it.
//
// Accuracy: with the cross products, the error of s is the rounding error divided by the sine of the angle between the
// segments, whereas with the usual determinant |u|^2 |v|^2 - (u . v)^2 it is divided by the square of the sine. If the
// angle is small, the distance hardly depends on s. The distance is therefore accurate to a few rounding errors of the
// coordinates for every pair: crossing, parallel, collinear segments, and points.
//
// Reference: Ericson, "Real-Time Collision Detection", 2005, section 5.1.9.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "engine/math/scalar.hpp"

namespace pkm {

/// A point or a vector, by coordinate x, y, z [m].
template <class S>
using Point3 = std::array<S, 3>;

template <class S>
struct Segment {
  Point3<S> from, to;
};

/// Capsule: all points whose distance from the segment `axis` is at most `radius`.
template <class S>
struct Capsule {
  Segment<S> axis;
  S radius;  ///< distance of the surface from the axis [m]
};

template <class S>
Point3<S> difference(const Point3<S>& a, const Point3<S>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class S>
S dot(const Point3<S>& a, const Point3<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class S>
Point3<S> cross(const Point3<S>& a, const Point3<S>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Minimum distance between two segments; either may be a point (from == to).
template <class S>
S segment_distance(const Segment<S>& a, const Segment<S>& b) {
  const S zero(0.0), one(1.0);
  const Point3<S> u = difference(a.to, a.from), v = difference(b.to, b.from), r = difference(b.from, a.from);
  const S uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), ur = dot(u, r), vr = dot(v, r);
  const auto ratio = [&](const S& x, const S& y) { return clamp(S(x / y), zero, one); };
  const bool a_is_point = !(value_of(uu) > 0), b_is_point = !(value_of(vv) > 0);
  S s = zero, t = zero;
  if (b_is_point) {
    if (!a_is_point) s = ratio(ur, uu);
  } else if (a_is_point) {
    t = ratio(S(-vr), vv);
  } else {
    const Point3<S> n = cross(u, v);
    const S nn = dot(n, n);
    // If nn = 0, the segments are parallel, and any s in [0, 1] is a valid start.
    if (value_of(nn) > 0) s = ratio(dot(cross(r, v), n), nn);
    t = (uv * s - vr) / vv;
    if (!(value_of(t) >= 0)) {
      t = zero;
      s = ratio(ur, uu);
    } else if (value_of(t) > 1) {
      t = one;
      s = ratio(S(ur + uv), uu);
    }
  }
  const auto gap = [&](std::size_t i) { return r[i] + v[i] * t - u[i] * s; };
  const Point3<S> between = {gap(0), gap(1), gap(2)};
  return sqrt_or_zero(dot(between, between));
}

/// Distance between two capsules. If they overlap, the result is minus the penetration depth, i.e. the length of the
/// smallest translation of one of them after which they only touch.
template <class S>
S capsule_distance(const Capsule<S>& a, const Capsule<S>& b) {
  return segment_distance(a.axis, b.axis) - (a.radius + b.radius);
}

/// The pair of bodies that have the minimum distance, by their indices.
template <class S>
struct ClosestPair {
  S clearance;  ///< distance of the two bodies [m], negative if they overlap; infinite if there is no pair
  std::size_t first = 0, second = 0;
};

/// The closest pair among those for which visit_pairs(visit) calls visit(first, second); ties go to the first pair.
template <class S, std::size_t N, class VisitPairs>
ClosestPair<S> closest_pair(const std::array<Capsule<S>, N>& all, const VisitPairs& visit_pairs) {
  ClosestPair<S> nearest{S(std::numeric_limits<double>::infinity())};
  visit_pairs([&](std::size_t first, std::size_t second) {
    const S found = capsule_distance(all[first], all[second]);
    if (value_of(found) < value_of(nearest.clearance)) nearest = {found, first, second};
  });
  return nearest;
}

/// Axis-aligned bounding box.
template <class S>
struct Bounds {
  Point3<S> lower, upper;
};

/// The bounding box of a segment.
template <class S>
Bounds<S> bounds_of(const Segment<S>& segment) {
  Bounds<S> box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.lower[i] = min(segment.from[i], segment.to[i]);
    box.upper[i] = max(segment.from[i], segment.to[i]);
  }
  return box;
}
/// The smallest box that contains a box and a segment.
template <class S>
Bounds<S> joined(const Bounds<S>& box, const Segment<S>& segment) {
  Bounds<S> both = bounds_of(segment);
  for (std::size_t i = 0; i < 3; ++i) {
    both.lower[i] = min(both.lower[i], box.lower[i]);
    both.upper[i] = max(both.upper[i], box.upper[i]);
  }
  return both;
}

/// Distance between two boxes: a lower bound of the distance between their contents.
template <class S>
S distance_of_bounds(const Bounds<S>& a, const Bounds<S>& b) {
  S sum(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const S gap = max(S(a.lower[i] - b.upper[i]), S(b.lower[i] - a.upper[i]));
    if (value_of(gap) > 0) sum += gap * gap;
  }
  return sqrt_or_zero(sum);
}

/// Indices of two links between which clearance is required.
struct LinkPair {
  std::size_t first, second;

  bool operator==(const LinkPair&) const = default;
};

/// True if the distance between the links of every pair is at least `minimum` [m]. Stops at the first pair that is
/// closer.
/// @param box  scratch memory: one bounding box per capsule
template <class Capsules, class Pairs, class Boxes>
bool respects_clearance(const Capsules& all, const Pairs& pairs, double minimum, Boxes& box) {
  for (std::size_t i = 0; i < all.size(); ++i) box[i] = bounds_of(all[i].axis);
  for (const LinkPair& pair : pairs) {
    const Capsule<double>&a = all[pair.first], &b = all[pair.second];
    // Skip pairs whose bounding boxes are far enough apart. The tolerance kRounding [m] covers rounding errors.
    constexpr double kRounding = 1e-9;
    if (distance_of_bounds(box[pair.first], box[pair.second]) - (a.radius + b.radius) > minimum + kRounding) continue;
    if (capsule_distance(a, b) < minimum) return false;
  }
  return true;
}

}  // namespace pkm
