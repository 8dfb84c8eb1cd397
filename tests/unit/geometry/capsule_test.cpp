// Distances of segments and capsules against known cases, a numerical search, and FCL.
#include "engine/geometry/capsule.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <fcl/geometry/shape/capsule.h>
#include <fcl/narrowphase/distance.h>

#include "engine/math/dual.hpp"
#include "tests/unit/math/uniform.hpp"

namespace pkm {
namespace {

using Point = Point3<double>;

constexpr double kRoundoff = 1e-14;  // for coordinates of order 1

using testing::Uniform;

Point random_point(Uniform& uniform, double size) {
  return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
}

Point along(const Point& from, const Point& direction, double t) {
  return {from[0] + t * direction[0], from[1] + t * direction[1], from[2] + t * direction[2]};
}

double point_to_segment(const Point& p, const Segment<double>& s) {
  const Point u = difference(s.to, s.from);
  const double uu = dot(u, u), t = uu > 0 ? std::clamp(dot(difference(p, s.from), u) / uu, 0.0, 1.0) : 0.0;
  const Point gap = difference(p, along(s.from, u, t));
  return std::sqrt(dot(gap, gap));
}

/// Distance of two segments by ternary search: the distance of a point on `a` from `b` is convex along `a`.
double searched_distance(const Segment<double>& a, const Segment<double>& b) {
  double low = 0, high = 1;
  const Point u = difference(a.to, a.from);
  const auto at = [&](double t) { return point_to_segment(along(a.from, u, t), b); };
  for (int i = 0; i < 200; ++i) {
    const double third = (high - low) / 3;
    (at(low + third) < at(high - third) ? high : low) += at(low + third) < at(high - third) ? -third : third;
  }
  return std::fmin(at(0.5 * (low + high)), std::fmin(at(0), at(1)));
}

/// Random pairs of segments; kind 0 is generic, the others are degenerate.
constexpr int kKinds = 9;
std::array<Segment<double>, 2> random_pair(int kind, Uniform& uniform) {
  Segment<double> a{random_point(uniform, 1), random_point(uniform, 1)},
      b{random_point(uniform, 1), random_point(uniform, 1)};
  const Point u = difference(a.to, a.from);
  const double tilts[] = {0, 1e-15, 1e-12, 1e-8, 1e-4};
  switch (kind) {
    case 1:  // crossing
      b.to = along(along(a.from, u, uniform(0, 1)), difference(b.from, a.to), uniform(-1, 0));
      b.from = along(along(a.from, u, 0.5), difference(b.to, along(a.from, u, 0.5)), -1);
      break;
    case 2:  // parallel and nearly parallel
    case 3:
      b.to = along(b.from, u, uniform(-2, 2));
      for (double& x : b.to) x += tilts[static_cast<int>(uniform(0, 5))] * uniform(-1, 1);
      break;
    case 4:  // collinear
      b.from = along(a.from, u, uniform(-3, 3));
      b.to = along(a.from, u, uniform(-3, 3));
      break;
    case 5:
      b.to = b.from;
      break;
    case 6:
      a.to = a.from;
      break;
    case 7:
      a.to = a.from;
      b.to = b.from;
      break;
    case 8:  // a common end point
      b.from = uniform(0, 1) < 0.5 ? a.from : a.to;
      break;
    default:
      break;
  }
  return {a, b};
}

TEST(SegmentDistance, KnownCases) {
  const struct {
    Segment<double> a, b;
    double distance;
  } cases[] = {
      {{{0, 0, 0}, {2, 0, 0}}, {{1, -1, 0}, {1, 1, 0}}, 0},  // crossing
      {{{0, 0, 0}, {2, 0, 0}}, {{1, -1, 3}, {1, 1, 3}}, 3},  // one above the other
      {{{0, 0, 0}, {2, 0, 0}}, {{1, 1, 0}, {5, 1, 0}}, 1},   // parallel, side by side
      {{{0, 0, 0}, {2, 0, 0}}, {{5, 4, 0}, {9, 4, 0}}, 5},   // parallel, past each other
      {{{0, 0, 0}, {2, 0, 0}}, {{9, 4, 0}, {5, 4, 0}}, 5},   // the second one reversed
      {{{0, 0, 0}, {2, 0, 0}}, {{3, 0, 0}, {7, 0, 0}}, 1},   // collinear
      {{{0, 0, 0}, {2, 0, 0}}, {{1, 0, 0}, {7, 0, 0}}, 0},   // collinear and overlapping
      {{{0, 0, 0}, {2, 0, 0}}, {{1, 2, 0}, {1, 5, 0}}, 2},   // an end point against an inner point
      {{{0, 0, 0}, {2, 0, 0}}, {{5, 4, 0}, {9, 9, 0}}, 5},   // an end point against an end point
      {{{0, 0, 0}, {0, 0, 0}}, {{3, 4, 0}, {3, 4, 0}}, 5},   // two points
      {{{1, 1, 0}, {1, 1, 0}}, {{0, 0, 0}, {2, 0, 0}}, 1},   // a point beside a segment
      {{{0, 0, 0}, {2, 0, 0}}, {{5, 4, 0}, {5, 4, 0}}, 5},   // a point beyond a segment
      {{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {0, 1, 0}}, 0},   // a common end point
      {{{0, 0, 0}, {1, 0, 0}}, {{2, -1, 0}, {2, 1, 0}}, 1},  // the unconstrained minimum lies outside the first only
      {{{0, 0, 0}, {1, 0, 0}}, {{3, 1, 0}, {3, 9, 0}}, std::sqrt(5.0)},  // outside both
  };
  for (const auto& c : cases) {
    EXPECT_NEAR(segment_distance(c.a, c.b), c.distance, kRoundoff);
    EXPECT_NEAR(segment_distance(c.b, c.a), c.distance, kRoundoff);
  }
}

TEST(SegmentDistance, EqualsNumericalSearch) {
  Uniform uniform(1);
  for (int i = 0; i < 40000; ++i) {
    const auto [a, b] = random_pair(i % kKinds, uniform);
    const double found = segment_distance(a, b);
    // Near the minimum the distance varies quadratically, so the search is accurate to the root of the rounding error.
    const double searched = std::fmin(searched_distance(a, b), searched_distance(b, a));
    ASSERT_NEAR(found, searched, 1e-8) << "kind " << i % kKinds << ", pair " << i;
    ASSERT_LE(found, searched + kRoundoff) << "kind " << i % kKinds << ", pair " << i;
    ASSERT_NEAR(found, segment_distance(b, a), 10 * kRoundoff);
    ASSERT_NEAR(found, segment_distance({a.to, a.from}, b), 10 * kRoundoff);
  }
}

// Segments that cross at a known point, at angles down to the rounding error.
TEST(SegmentDistance, IsAccurateForNearlyParallelSegments) {
  for (const double angle : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-16})
    for (const double where : {0.1, 0.5, 0.7})
      for (const double gap : {0.0, 1e-9, 0.3}) {
        const Segment<double> a{{-where, 0, 0}, {1 - where, 0, 0}};
        const Segment<double> b{{-0.5, -0.5 * angle, gap}, {0.5, 0.5 * angle, gap}};
        EXPECT_NEAR(segment_distance(a, b), gap, kRoundoff) << angle << ' ' << where;
      }
}

TEST(SegmentDistance, EqualsFcl) {
  Uniform uniform(2);
  int compared = 0;
  const auto capsule = [](const Segment<double>& axis, double radius) {
    const fcl::Vector3d from(axis.from[0], axis.from[1], axis.from[2]), to(axis.to[0], axis.to[1], axis.to[2]);
    fcl::Transform3d pose = fcl::Transform3d::Identity();  // FCL's capsules lie along z about the origin
    if (axis.from != axis.to)
      pose.linear() = Eigen::Quaterniond::FromTwoVectors(fcl::Vector3d::UnitZ(), to - from).toRotationMatrix();
    pose.translation() = 0.5 * (from + to);
    return fcl::CollisionObjectd(std::make_shared<fcl::Capsuled>(radius, (to - from).norm()), pose);
  };
  for (int i = 0; i < 20000; ++i) {
    const auto [a, b] = random_pair(i % kKinds, uniform);
    const double radius_a = uniform(0.01, 0.3), radius_b = uniform(0.01, 0.3);
    const double ours = capsule_distance(Capsule<double>{a, radius_a}, Capsule<double>{b, radius_b});
    if (ours < 1e-6) continue;  // FCL does not compute penetration depths
    const auto object_a = capsule(a, radius_a), object_b = capsule(b, radius_b);
    fcl::DistanceResultd result;
    fcl::distance(&object_a, &object_b, fcl::DistanceRequestd(true), result);
    ASSERT_NEAR(ours, result.min_distance, 1e-7) << "kind " << i % kKinds << ", pair " << i;
    ++compared;
  }
  EXPECT_GT(compared, 5000);
}

TEST(CapsuleDistance, OverlapIsThePenetrationDepth) {
  const Capsule<double> a{{{0, 0, 0}, {2, 0, 0}}, 0.3};
  const auto above = [](double height) { return Capsule<double>{{{1, -1, height}, {1, 1, height}}, 0.2}; };
  EXPECT_NEAR(capsule_distance(a, above(0.6)), 0.1, kRoundoff);
  EXPECT_NEAR(capsule_distance(a, above(0.5)), 0, kRoundoff);
  EXPECT_NEAR(capsule_distance(a, above(0.1)), -0.4, kRoundoff);
  EXPECT_NEAR(capsule_distance(a, above(0.0)), -0.5, kRoundoff);
  Uniform uniform(3);
  for (int i = 0; i < 2000; ++i) {
    const auto [p, q] = random_pair(i % kKinds, uniform);
    const double gap = segment_distance(p, q);
    if (gap < 1e-3) continue;
    const double radii = gap + uniform(0, 1), depth = -capsule_distance(Capsule<double>{p, radii / 2}, {q, radii / 2});
    ASSERT_NEAR(depth, radii - gap, kRoundoff);
    double overlap = 1e9;  // minimum over translations by the depth: they separate the two at most to touch
    for (int k = 0; k < 200; ++k) {
      Point shift = random_point(uniform, 1);
      const double size = std::sqrt(dot(shift, shift));
      Segment<double> moved = q;
      for (std::size_t c = 0; c < 3; ++c) {
        moved.from[c] += shift[c] / size * depth;
        moved.to[c] += shift[c] / size * depth;
      }
      overlap = std::fmin(overlap, radii - segment_distance(p, moved));
    }
    ASSERT_GE(overlap, -1e-12);
  }
}

TEST(SegmentDistance, DerivativesEqualDifferences) {
  Uniform uniform(4);
  int compared = 0;
  for (int i = 0; i < 500; ++i) {
    const auto pair = random_pair(0, uniform);
    const Segment<double>&a = pair[0], &b = pair[1];
    const Segment<double> direction{random_point(uniform, 1), random_point(uniform, 1)};
    const auto at = [&](auto step) {
      using S = decltype(step);
      const auto moved = [&](const Point& p, const Point& d) {
        return Point3<S>{S(p[0]) + step * d[0], S(p[1]) + step * d[1], S(p[2]) + step * d[2]};
      };
      return segment_distance<S>({moved(a.from, direction.from), moved(a.to, direction.to)},
                                 {moved(b.from, direction.to), moved(b.to, direction.from)});
    };
    const Dual4 exact = at(Dual4::variable(0, 0));
    EXPECT_EQ(exact.a, at(0.0));
    if (exact.a < 0.05) continue;  // not differentiable where they cross
    constexpr double kStep = 1e-5;
    EXPECT_NEAR(exact.v[0], (at(kStep) - at(-kStep)) / (2 * kStep), 1e-5) << i;
    ++compared;
  }
  EXPECT_GT(compared, 400);
}

TEST(Bounds, DistanceOfBoxesIsALowerBound) {
  Uniform uniform(5);
  for (int i = 0; i < 5000; ++i) {
    const auto [a, b] = random_pair(i % kKinds, uniform);
    const auto [c, d] = random_pair(i % kKinds, uniform);
    const auto shifted = [&](Segment<double> s) {
      for (Point* end : {&s.from, &s.to}) (*end)[static_cast<std::size_t>(i % 3)] += 2.5;
      return s;
    };
    const double apart = distance_of_bounds(joined(bounds_of(a), b), joined(bounds_of(shifted(c)), shifted(d)));
    for (const auto& p : {a, b})
      for (const auto& q : {c, d}) ASSERT_LE(apart, segment_distance(p, shifted(q)) + kRoundoff);
  }
  EXPECT_EQ(distance_of_bounds<double>({{0, 0, 0}, {1, 1, 1}}, {{4, 5, 0}, {6, 7, 8}}), 5);
  EXPECT_EQ(distance_of_bounds<double>({{0, 0, 0}, {1, 1, 1}}, {{0.5, 0.5, 0.5}, {2, 2, 2}}), 0);
}

}  // namespace
}  // namespace pkm
