// Distances of links from obstacles: against distances from the box's edges and of the segment's end points, against
// separating directions, and derivatives against differences.
#include "engine/geometry/obstacle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/dual.hpp"
#include "engine/math/random.hpp"

namespace pkm {
namespace {

using Point = Point3<double>;

double length(const Point& p) { return std::sqrt(dot(p, p)); }

double distance_of_point(const Point& p, const SolidBox& box) {
  Point beyond;
  for (std::size_t i = 0; i < 3; ++i) beyond[i] = std::fmax(0, std::fabs(p[i] - box.centre[i]) - box.half[i]);
  return length(beyond);
}

std::array<Segment<double>, 12> edges_of(const SolidBox& box) {
  const auto vertex = [&](std::size_t bits) {
    Point p = box.centre;
    for (std::size_t i = 0; i < 3; ++i) p[i] += (bits >> i & 1 ? 1 : -1) * box.half[i];
    return p;
  };
  std::array<Segment<double>, 12> edges;
  std::size_t n = 0;
  for (std::size_t bits = 0; bits < 8; ++bits)
    for (std::size_t i = 0; i < 3; ++i)
      if (!(bits >> i & 1)) edges[n++] = {vertex(bits), vertex(bits | std::size_t{1} << i)};
  return edges;
}

/// True if the segment intersects the box (slab test): the intervals of t between parallel faces intersect.
bool intersects(const Segment<double>& s, const SolidBox& box) {
  double low = 0, high = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const double p = s.from[i] - box.centre[i], u = s.to[i] - s.from[i];
    if (u == 0) {
      if (std::fabs(p) > box.half[i]) return false;
      continue;
    }
    const double a = (-box.half[i] - p) / u, b = (box.half[i] - p) / u;
    low = std::fmax(low, std::fmin(a, b));
    high = std::fmin(high, std::fmax(a, b));
  }
  return low <= high;
}

/// Distance of a segment that does not intersect the box: a closest point is an end point of it or lies on an edge of
/// the box.
double reference_distance(const Segment<double>& s, const SolidBox& box) {
  double minimum = std::fmin(distance_of_point(s.from, box), distance_of_point(s.to, box));
  for (const Segment<double>& edge : edges_of(box)) minimum = std::fmin(minimum, segment_distance(s, edge));
  return minimum;
}

class Random {
 public:
  double in(double low, double high) { return low + (high - low) * stream_.u01(); }
  Point point(double reach) { return {in(-reach, reach), in(-reach, reach), in(-reach, reach)}; }
  /// A random segment and box of all kinds: distant and close, long, short, points, parallel to the axes, ending in a
  /// vertex or in the centre of the box.
  std::pair<Segment<double>, SolidBox> pair() {
    SolidBox box{point(0.3), {in(0.01, 1), in(0.01, 1), in(0.01, 1)}};
    Segment<double> s{point(2), point(2)};
    const int kind = static_cast<int>(in(0, 6));
    if (kind == 1) s.to = s.from;
    if (kind == 2) {
      s.to = s.from;
      s.to[static_cast<std::size_t>(in(0, 3))] += in(-3, 3);
    }
    if (kind == 3)
      for (std::size_t i = 0; i < 3; ++i) s.to[i] = s.from[i] + in(-1e-6, 1e-6);
    if (kind == 4)
      for (std::size_t i = 0; i < 3; ++i) s.to[i] = box.centre[i] + (in(-1, 1) < 0 ? -1 : 1) * box.half[i];
    if (kind == 5) s.from = box.centre;
    return {s, box};
  }

 private:
  Stream stream_{53, 0, 0, Stream::Use::start};
};

TEST(BoxDistance, EqualsDistanceToEdgesAndOfEndPoints) {
  Random random;
  int apart = 0, through = 0;
  for (int k = 0; k < 200000; ++k) {
    const auto [s, box] = random.pair();
    const double found = box_distance(s, box);
    if (intersects(s, box)) {
      EXPECT_LE(found, 1e-11);  // intersects() has rounding errors
      ++through;
    } else {
      EXPECT_NEAR(found, reference_distance(s, box), 1e-12);
      ++apart;
    }
  }
  EXPECT_GT(apart, 50000);
  EXPECT_GT(through, 20000);
}

TEST(BoxDistance, IsThePenetrationDepth) {
  Random random;
  int through = 0, attained = 0;
  while (through < 1000) {
    const auto [s, box] = random.pair();
    if (!intersects(s, box)) continue;
    ++through;
    const double depth = -box_distance(s, box);
    // the translation that separates the two is at least the depth in every direction, and equals it in the best one,
    // which a random search approximates
    const auto separation_along = [&, s = s, box = box](const Point& n) {
      const double norm = length(n);
      double reach = 0, from = 0, to = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        reach += box.half[i] * std::fabs(n[i]) / norm;
        from += n[i] / norm * (s.from[i] - box.centre[i]);
        to += n[i] / norm * (s.to[i] - box.centre[i]);
      }
      return reach - std::fmin(from, to);
    };
    double minimum = 1e300;
    Point best{};
    for (int step = 0; step < 3000; ++step) {
      Point n = random.point(1);
      const double radius = step < 500 ? 0 : std::pow(1e-6, (step - 500) / 2500.0);  // of the search about the best
      if (radius > 0)
        for (std::size_t i = 0; i < 3; ++i) n[i] = best[i] + radius * n[i];
      if (length(n) < 1e-3) continue;
      const double separation = separation_along(n);
      if (separation >= minimum) continue;
      minimum = separation;
      for (std::size_t i = 0; i < 3; ++i) best[i] = n[i] / length(n);
    }
    EXPECT_GE(minimum, depth - 1e-13);
    attained += minimum < depth + 1e-4;
    EXPECT_LE(depth, std::fmin(box.half[0], std::fmin(box.half[1], box.half[2])) + length(difference(s.to, s.from)));
  }
  EXPECT_GT(attained, 900) << "the search may miss the best direction";
}

TEST(BoxDistance, IsContinuousWhereIntersectionBegins) {
  const SolidBox box{{0, 0, 0}, {1, 2, 3}};
  for (const double x : {1 - 1e-9, 1.0, 1 + 1e-9}) {
    EXPECT_NEAR(box_distance<double>({{x, -1, 0}, {x, 1, 0}}, box), x - 1, 1e-15);
    EXPECT_NEAR(box_distance<double>({{x, 0, 0}, {x + 1, 0, 5}}, box), x - 1, 1e-15);
  }
  EXPECT_NEAR(box_distance<double>({{0, -9, 0}, {0, 9, 0}}, box), -1, 1e-15) << "through the centre";
}

TEST(BoxDistance, DerivativesEqualDifferences) {
  Random random;
  int compared = 0;
  for (int k = 0; k < 3000; ++k) {
    const auto [s, box] = random.pair();
    const Point velocity_from = random.point(1), velocity_to = random.point(1);
    const auto moved = [&, s = s]<class S>(const S& t) {
      Segment<S> at;
      for (std::size_t i = 0; i < 3; ++i) {
        at.from[i] = s.from[i] + velocity_from[i] * t;
        at.to[i] = s.to[i] + velocity_to[i] * t;
      }
      return at;
    };
    Dual4 t(0.0);
    t.v[0] = 1;
    constexpr double kStep = 1e-6;
    const double before = box_distance(moved(-kStep), box), after = box_distance(moved(kStep), box),
                 at = box_distance(moved(0.0), box), derivative = box_distance(moved(t), box).v[0];
    if (std::fabs(before + after - 2 * at) > 1e-10) continue;  // not differentiable, or strongly curved
    EXPECT_NEAR(derivative, (after - before) / (2 * kStep), 1e-5);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

TEST(Obstacle, SphereIsACapsuleWithAPointAsAxis) {
  const Obstacle ball{"ball", Capsule<double>{{{0, 0, 3}, {0, 0, 3}}, 0.5}};
  EXPECT_NEAR(obstacle_distance<double>({{{-1, 0, 0}, {1, 0, 0}}, 0.25}, ball), 3 - 0.75, 1e-15);
  const Obstacle wall{"wall", SolidBox{{0, 0, 2}, {5, 5, 0.5}}};
  EXPECT_NEAR(obstacle_distance<double>({{{-1, 0, 0}, {1, 0, 1}}, 0.25}, wall), 0.5 - 0.25, 1e-15);
}

TEST(Obstacle, ClearanceTestAgreesWithMinimumDistance) {
  Random random;
  int clear = 0, overlapping = 0;
  for (int k = 0; k < 20000; ++k) {
    Obstacles obstacles;
    std::array<Capsule<double>, 3> links;
    for (int n = 0; n < 2; ++n) {
      const auto [s, box] = random.pair();
      obstacles.push_back({"box", box});
      obstacles.push_back({"capsule", Capsule<double>{s, random.in(0.01, 0.2)}});
    }
    for (auto& link : links) link = {random.pair().first, random.in(0.01, 0.2)};
    for (auto& link : links)  // mostly far from the obstacles
      for (auto* const end : {&link.axis.from, &link.axis.to}) (*end)[0] += 2;
    const std::array<std::size_t, 2> moves = {0, 2};
    const ClosestPair<double> nearest = nearest_obstacle<double>(links, moves, obstacles);
    EXPECT_NE(nearest.first, 1u);
    double minimum = 1e300;
    for (const std::size_t link : moves)
      for (const Obstacle& obstacle : obstacles) minimum = std::fmin(minimum, obstacle_distance(links[link], obstacle));
    EXPECT_EQ(nearest.clearance, minimum);
    for (const double limit : {-0.4, -0.1, 0.0, 0.2, minimum - 1e-12, minimum + 1e-12})
      EXPECT_EQ(respects_obstacle_clearance(obstacles, links, moves, limit), minimum >= limit)
          << minimum << " " << limit;
    ++(minimum >= 0 ? clear : overlapping);
  }
  EXPECT_GT(clear, 1000);
  EXPECT_GT(overlapping, 1000);
}

}  // namespace
}  // namespace pkm
