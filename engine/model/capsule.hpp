// Capsules and their distances: what links look like to the clearance of a pose.
//
// A capsule is all that lies within a radius of a segment. The closest points of two segments p + s u and q + t v with
// r = q - p minimise a convex quadratic of (s, t) over the unit square. Its free minimum is, with n = u x v,
//
//   s = (r x v) . n / |n|^2
//
// and where that leaves the square, clamping s, then the best t, then the best s for that t if t was clamped, ends in
// the minimum over the square. The cross products keep s good to the rounding over the sine of the angle of the two
// segments (the textbook's a c - b^2 loses twice the digits); since the distance hardly depends on s where that angle
// is small, it is good to a few roundings of the coordinates for every pair: crossing, parallel, collinear, or points.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "engine/math/scalar.hpp"

namespace pkm {

template <class S>
using Point3 = std::array<S, 3>;  ///< [m]

template <class S>
struct Segment {
  Point3<S> from, to;
};

/// All points within `radius` of a segment.
template <class S>
struct Capsule {
  Segment<S> axis;
  S radius;  ///< [m]
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

/// Least distance of two segments, either of which may be a point.
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
    if (value_of(nn) > 0) s = ratio(dot(cross(r, v), n), nn);  // parallel: any s will do to begin with
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
  return root_or_zero(dot(between, between));
}

/// Distance of two capsules; negative where they overlap, and then minus the length by which one has to be moved for
/// the two to touch only.
template <class S>
S capsule_distance(const Capsule<S>& a, const Capsule<S>& b) {
  return segment_distance(a.axis, b.axis) - (a.radius + b.radius);
}

/// The two of several capsules that are nearest to each other.
template <class S>
struct Nearest {
  S clearance;  ///< [m], negative where they overlap
  std::size_t first = 0, second = 0;
};

/// Of the pairs for which visit_pairs(visit) calls visit(first, second); the first of those that are as near.
template <class S, std::size_t N, class VisitPairs>
Nearest<S> nearest_of(const std::array<Capsule<S>, N>& all, const VisitPairs& visit_pairs) {
  Nearest<S> nearest{S(std::numeric_limits<double>::infinity())};
  visit_pairs([&](std::size_t first, std::size_t second) {
    const S found = capsule_distance(all[first], all[second]);
    if (value_of(found) < value_of(nearest.clearance)) nearest = {found, first, second};
  });
  return nearest;
}

/// A box along the coordinate axes.
template <class S>
struct Bounds {
  Point3<S> lower, upper;
};

/// The least box around a segment, or around a box and a segment.
template <class S>
Bounds<S> bounds_of(const Segment<S>& segment) {
  Bounds<S> box;
  for (std::size_t i = 0; i < 3; ++i) {
    box.lower[i] = min(segment.from[i], segment.to[i]);
    box.upper[i] = max(segment.from[i], segment.to[i]);
  }
  return box;
}
template <class S>
Bounds<S> joined(const Bounds<S>& box, const Segment<S>& segment) {
  Bounds<S> both = bounds_of(segment);
  for (std::size_t i = 0; i < 3; ++i) {
    both.lower[i] = min(both.lower[i], box.lower[i]);
    both.upper[i] = max(both.upper[i], box.upper[i]);
  }
  return both;
}

/// Distance of two boxes: no two points of theirs are nearer.
template <class S>
S distance_of_bounds(const Bounds<S>& a, const Bounds<S>& b) {
  S sum(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const S gap = max(S(a.lower[i] - b.upper[i]), S(b.lower[i] - a.upper[i]));
    if (value_of(gap) > 0) sum += gap * gap;
  }
  return root_or_zero(sum);
}

/// Two of several links, which have to keep clear of each other.
struct LinkPair {
  std::size_t first, second;

  bool operator==(const LinkPair&) const = default;
};

/// Whether no pair is nearer than `least` [m]: it stops at the first that is.
/// @param box  room for as many as there are capsules
template <class Capsules, class Pairs, class Boxes>
bool keep_clear(const Capsules& all, const Pairs& pairs, double least, Boxes& box) {
  for (std::size_t i = 0; i < all.size(); ++i) box[i] = bounds_of(all[i].axis);
  for (const LinkPair& pair : pairs) {
    const Capsule<double>&a = all[pair.first], &b = all[pair.second];
    // boxes of axes that are farther apart than rounding could matter need no closer look
    constexpr double kRounding = 1e-9;
    if (distance_of_bounds(box[pair.first], box[pair.second]) - (a.radius + b.radius) > least + kRounding) continue;
    if (capsule_distance(a, b) < least) return false;
  }
  return true;
}

}  // namespace pkm
