// Conics in the square [-1, 1]^2: intersection points and areas against closed forms.
#include "engine/generic/conic.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/math/scalar.hpp"

namespace pkm::generic {
namespace {

Conic conic(const std::array<double, 6>& c) {
  Conic made{.c = c};
  for (const double each : c) made.scale += std::fabs(each);
  return made;
}
/// r^2 - (t - t0)^2 - (s - s0)^2, positive inside.
Conic circle(double t0, double s0, double r) { return conic({r * r - t0 * t0 - s0 * s0, 2 * t0, 2 * s0, -1, 0, -1}); }
/// 1 - (t/a)^2 - (s/b)^2
Conic ellipse(double a, double b) { return conic({1, 0, 0, -1 / (a * a), 0, -1 / (b * b)}); }

std::vector<Point> common_points(const Conic& P, const Conic& Q) {
  std::array<Point, 16> points{};
  std::vector<Point> found(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(crossings(P, Q, points)));
  std::copy_n(points.begin(), found.size(), found.begin());
  return found;
}
void expect_points(std::vector<Point> found, const std::vector<Point>& expected, double tolerance) {
  ASSERT_EQ(found.size(), expected.size());
  std::ranges::sort(found,
                    [](const Point& p, const Point& q) { return std::fabs(p.t - q.t) > 1e-6 ? p.t < q.t : p.s < q.s; });
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i].t, expected[i].t, tolerance) << i;
    EXPECT_NEAR(found[i].s, expected[i].s, tolerance) << i;
  }
}

TEST(ConicIntersection, OfTwoCircles) {
  // Radii 0.5, centres 0.6 apart: half of the chord is sqrt(0.25 - 0.09) = 0.4.
  expect_points(common_points(circle(-0.3, 0, 0.5), circle(0.3, 0, 0.5)), {{0, -0.4}, {0, 0.4}}, 1e-14);
  expect_points(common_points(circle(0, -0.3, 0.5), circle(0, 0.3, 0.5)), {{-0.4, 0}, {0.4, 0}}, 1e-14);
  EXPECT_TRUE(common_points(circle(-0.5, 0, 0.3), circle(0.5, 0, 0.3)).empty());
  EXPECT_TRUE(common_points(circle(0.1, 0, 0.3), circle(0, 0, 0.8)).empty()) << "one inside the other";
}

TEST(ConicIntersection, OfTwoEllipsesInFourPoints) {
  // By symmetry |t| = |s| = x with x^2 (1/0.81 + 1/0.25) = 1.
  const double x = 1 / std::sqrt(1 / 0.81 + 1 / 0.25);
  expect_points(common_points(ellipse(0.9, 0.5), ellipse(0.5, 0.9)), {{-x, -x}, {-x, x}, {x, -x}, {x, x}}, 1e-14);
}

TEST(ConicIntersection, OfAHyperbolaALineAndACircle) {
  const Conic hyperbola = conic({-0.12, 0, 0, 0, 1, 0}), line = conic({-0.7, 1, 1, 0, 0, 0});
  // t s = 0.12 and t + s = 0.7; with t^2 + s^2 = 0.25 the same points and their opposites
  expect_points(common_points(hyperbola, line), {{0.3, 0.4}, {0.4, 0.3}}, 1e-14);
  expect_points(common_points(hyperbola, circle(0, 0, 0.5)), {{-0.4, -0.3}, {-0.3, -0.4}, {0.3, 0.4}, {0.4, 0.3}},
                1e-14);
  expect_points(common_points(line, circle(0, 0, 0.5)), {{0.3, 0.4}, {0.4, 0.3}}, 1e-14);
}

TEST(ConicIntersection, OfCurvesThatTouch) {
  // The distance of the centres equals the sum of the radii; contact is known to the root of the rounding error.
  const std::vector<Point> contact = common_points(circle(-0.3, 0.1, 0.25), circle(0.3, 0.1, 0.35));
  ASSERT_FALSE(contact.empty());
  for (const Point& p : contact) {
    EXPECT_NEAR(p.t, -0.05, 1e-6);
    EXPECT_NEAR(p.s, 0.1, 1e-6);
  }
}

/// Area between the upper and the lower root of a conic on [from, to].
double area(const Conic& P, double from, double to) {
  return area_below(P, {1, from, to}) - area_below(P, {0, from, to});
}

TEST(ConicArea, OfCirclesAndEllipses) {
  EXPECT_NEAR(area(circle(0, 0, 1), -1, 1), kPi, 1e-14);
  EXPECT_NEAR(area(circle(0.2, -0.1, 0.7), -0.5, 0.9), kPi * 0.49, 1e-14);
  EXPECT_NEAR(area(ellipse(0.8, 0.3), -0.8, 0.8), kPi * 0.24, 1e-14);
  // t^2 + t s + s^2 = 3/4: area pi c / sqrt(1 - 1/4), and |t| <= 1
  EXPECT_NEAR(area(conic({0.75, 0, 0, -1, -1, -1}), -1, 1), kPi * 0.75 / std::sqrt(0.75), 1e-13);
  // circular segment: r^2 (alpha - sin(alpha) cos(alpha)) with cos(alpha) = 0.6
  EXPECT_NEAR(area(circle(0, 0, 1), 0.6, 1), std::acos(0.6) - 0.48, 1e-14);
}

/// Two discs of radius 1/2 and 0.4 with the distance 1/2: the lens consists of two circular segments.
TEST(ConicArea, OfTwoOverlappingDiscs) {
  const double r = 0.5, q = 0.4, d = 0.5;
  const Conic first = circle(-0.2, 0, r), second = circle(d - 0.2, 0, q);
  const std::vector<Point> points = common_points(first, second);
  ASSERT_EQ(points.size(), 2u);
  const double t = points[0].t;
  const double lens = area(second, d - 0.2 - q, t) + area(first, t, r - 0.2);
  const double alpha = std::acos((d * d + r * r - q * q) / (2 * d * r)),
               beta = std::acos((d * d + q * q - r * r) / (2 * d * q));
  EXPECT_NEAR(lens, r * r * (alpha - std::sin(2 * alpha) / 2) + q * q * (beta - std::sin(2 * beta) / 2), 1e-14);
}

TEST(ConicArea, OfStraightAndNearlyStraightArcs) {
  EXPECT_NEAR(area_below(conic({-0.3, -0.5, 1, 0, 0, 0}), {0, -0.4, 0.8}), 0.3 * 1.2 + 0.25 * (0.64 - 0.16), 1e-15);
  EXPECT_NEAR(area_below(conic({-0.1, 0, 1, -0.6, 0, 0}), {0, -1, 0.5}), 0.15 + 0.2 * (0.125 + 1), 1e-15);  // parabola
  // c s^2 + s = 1/2 with small c
  for (const double c : {1e-3, 1e-5, 1e-7})
    EXPECT_NEAR(area_below(conic({-0.5, 0, 1, 0, 0, c}), {1, 0, 1}), 1 / (1 + std::sqrt(1 + 2 * c)), 1e-12) << c;
}

/// The area pi c / sqrt(k l - m^2 / 4) of c - k t^2 - m t s - l s^2 and its derivatives. Those of the endpoints do not
/// count: the roots coincide there.
TEST(ConicArea, DerivativesOfAnEllipse) {
  const double c = 0.5, k = 1.2, l = 0.9, m = 0.4, D = k * l - m * m / 4;
  const Conic P = conic({c, 0, 0, -k, -m, -l});
  const double end = std::sqrt(c * l / D);
  std::array<double, 6> slopes{};
  add_gradient_of_area(P, {1, -end, end}, 2, slopes);
  add_gradient_of_area(P, {0, -end, end}, -2, slopes);
  const double whole = kPi * c / std::sqrt(D);
  EXPECT_NEAR(area(P, -end, end), whole, 1e-13);
  const double expected[] = {whole / c, 0, 0, whole * l / (2 * D), -whole * m / (4 * D), whole * k / (2 * D)};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(slopes[i], 2 * expected[i], 1e-7) << i;
}

/// Derivatives on a part of an arc with fixed endpoints, against central differences.
TEST(ConicArea, DerivativesOfAnArc) {
  const std::array<double, 6> bent = {0.4, 0.1, -0.2, -0.9, 0.3, -1}, straight = {-0.3, -0.5, 1, 0.2, 0.3, 0};
  for (const auto& [c, root] : {std::pair(bent, 0), std::pair(bent, 1), std::pair(straight, 0)}) {
    const Arc arc{root, -0.3, 0.4};
    std::array<double, 6> slopes{};
    add_gradient_of_area(conic(c), arc, 1, slopes);
    for (std::size_t i = 0; i < (c[5] == 0 ? 5u : 6u); ++i) {
      constexpr double kStep = 1e-5;
      std::array<double, 6> above = c, below = c;
      above[i] += kStep;
      below[i] -= kStep;
      EXPECT_NEAR(slopes[i], (area_below(conic(above), arc) - area_below(conic(below), arc)) / (2 * kStep), 1e-8) << i;
    }
  }
}

}  // namespace
}  // namespace pkm::generic
