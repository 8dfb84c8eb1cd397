#include "engine/generic/edges/proven_volume.hpp"

#include <gtest/gtest.h>

#include "engine/generic/edges/interval_series.hpp"
#include "engine/math/random.hpp"

namespace pkm::generic::edges {
namespace {

using Kind = Body::Kind;

Body ball_of(const Vector3& centre, double radius, double side = 1) {
  return {.kind = Kind::sphere, .centre = centre, .radius = radius, .side = side};
}
Body cylinder_of(const Vector3& axis, double radius, double side = 1) {
  return {.kind = Kind::cylinder, .axis = axis, .radius = radius, .side = side};
}
Body half_space_of(const Vector3& normal, double distance) {
  return {.kind = Kind::plane, .axis = normal, .radius = distance};
}

std::optional<Interval> prove(const Solid& solid) {
  std::vector<IntervalBody> bodies;
  for (const Body& body : solid.bodies) bodies.push_back(enclosed(body));
  return proven_volume(bodies, solid.bound);
}

/// @param width  largest one, relative to the volume
void expect_bounds(const Solid& solid, double volume, double width = 1e-10) {
  const auto found = prove(solid);
  ASSERT_TRUE(found);
  EXPECT_LE(found->lower, volume * (1 + 1e-15));
  EXPECT_GE(found->upper, volume * (1 - 1e-15));
  EXPECT_LE(found->width(), width * volume);
}

double volume_from_edges(const Solid& solid) {
  VolumeScratch scratch;
  const EdgeVolume found = volume(solid, 1e-13, scratch);
  EXPECT_TRUE(found.is_supported && found.is_closed);
  return found.value;
}

/// Volume of the intersection of balls whose surfaces overlap by `depth` along the line of their centres.
double lens(double R, double r, double depth) {
  const double d = R + r - depth;
  return kPi * depth * depth * (d * d + 2 * d * (r + R) - 3 * (r - R) * (r - R)) / (12 * d);
}

TEST(IntervalSeries, ContainsTheCoefficientsOfAFormula) {
  const auto x = IntervalSeries<4>::variable(0.1);
  // sqrt(1 + x)/(1 - x) at 0.1, coefficients from a computer algebra system: f, f', f''/2, ..
  const IntervalSeries<4> f = sqrt(IntervalSeries<4>(1.0) + x) / (IntervalSeries<4>(1.0) - x);
  // by the recurrence of the product with (0.9 - h) and the binomial series of sqrt(1.1 + h)
  const double root = std::sqrt(1.1);
  const std::array<double, 5> s{root, 0.5 / root, -0.125 / (1.1 * root), 0.0625 / (1.21 * root),
                                -5.0 / 128 / (1.331 * root)};
  double q = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    q = (s[k] + q) / 0.9;
    EXPECT_LE(f.c[k].lower, q + 1e-15);
    EXPECT_GE(f.c[k].upper, q - 1e-15);
    EXPECT_LE(f.c[k].width(), 1e-13);
  }
}

TEST(IntervalSeries, ContainsTheDerivativesAtAllPointsOfAnInterval) {
  const auto at = [](const Interval& x) {
    return sqrt(square(IntervalSeries<3>::variable(x)) + IntervalSeries<3>(1.0));
  };
  const IntervalSeries<3> whole = at({0.5, 1});
  for (const double x : {0.5, 0.6, 0.7, 0.99, 1.0}) {
    const IntervalSeries<3> point = at(x);
    for (std::size_t k = 0; k <= 3; ++k) {
      EXPECT_LE(whole.c[k].lower, point.c[k].lower);
      EXPECT_GE(whole.c[k].upper, point.c[k].upper);
    }
  }
}

TEST(ProvenVolume, OfBallsCylindersAndHalfSpacesContainsClosedForms) {
  expect_bounds({{ball_of({{1, 2, 3}}, 0.5)}, 4.5}, kPi / 6);
  const Vector3 a{{0.1, 0.2, 0.3}}, b{{0.1, 1.1, 0.3}};
  expect_bounds({{ball_of(a, 1), ball_of(b, 0.8)}, 3}, lens(1, 0.8, 0.9));
  expect_bounds({{ball_of(a, 1), ball_of(b, 0.8, -1)}, 3}, 4 * kPi / 3 - lens(1, 0.8, 0.9));
  const Vector3 axis{{0.6, 0, 0.8}};
  const double ring = kPi / 6 * std::pow(2 * std::sqrt(0.75), 3);
  expect_bounds({{ball_of({}, 1), cylinder_of(axis, 0.5, -1)}, 1}, ring);
  expect_bounds({{ball_of({}, 1), cylinder_of(axis, 0.5)}, 1}, 4 * kPi / 3 - ring);
  expect_bounds({{cylinder_of({{0, 0, 1}}, 0.5), half_space_of(axis, 0.8), half_space_of({{0, 0, -1}}, 1)}, 3},
                kPi / 2);
}

TEST(ProvenVolume, ContainsASolidThatIsThinnerThanAnySample) {
  expect_bounds({{ball_of({{0, 0, 1}}, 1), ball_of({{0, 0, -0.7}}, 0.7 + 1e-6)}, 3}, lens(1, 0.7 + 1e-6, 1e-6), 0.5);
}

TEST(ProvenVolume, OfALargerIntervalContainsTheVolumesOfAllItsNumbers) {
  std::vector<IntervalBody> bodies{enclosed(ball_of({}, 1)), enclosed(ball_of({{0, 0, 1}}, 0.8))};
  bodies[1].radius = {0.8, 0.8 + 1e-5};
  const auto found = proven_volume(bodies, 1);
  ASSERT_TRUE(found);
  EXPECT_LE(found->lower, lens(1, 0.8, 0.8));
  EXPECT_GE(found->upper, lens(1, 0.8 + 1e-5, 0.8 + 1e-5));
  EXPECT_LE(found->width(), 1e-2);
}

TEST(ProvenVolume, OfSlidesContainsTheVolumeFromEdges) {
  for (const double slant : {0.0, 0.5}) {
    Solid solid{.bodies = {}, .bound = 2};
    for (int i = 0; i < 3; ++i) {
      const auto [s, c] = portable::sincos(2 * kPi * i / 3);
      const Vector3 axis{{slant * c, slant * s, 1}};
      solid.bodies.push_back({.kind = Kind::slide,
                              .centre = {{0.24 * c, 0.24 * s, 0}},
                              .axis = axis * (1 / norm(axis)),
                              .radius = 0.5,
                              .to = 0.6,
                              .is_first_root = false});
    }
    expect_bounds(solid, volume_from_edges(solid));
  }
}

TEST(ProvenVolume, OfCranksContainsTheVolumeFromEdges) {
  Stream random(6, 0, 0, Stream::Use::start);
  const auto between = [&](double low, double high) { return low + (high - low) * random.u01(); };
  for (const bool equal : {true, false}) {  // legs that are mirror images of each other, or not
    Solid solid{.bodies = {half_space_of({{0, 0, 1}}, 0)}, .bound = 1.3};
    for (int i = 0; i < 3; ++i) {
      const auto [s, c] = portable::sincos(2 * kPi * i / 3 + (equal ? 0 : between(-0.2, 0.2)));
      const Vector3 axis{{-s, c, equal ? 0 : between(-0.2, 0.2)}}, unit = axis * (1 / norm(axis)), out{{c, s, 0}},
                                                                   zero = out - unit * dot(unit, out);
      solid.bodies.push_back({.kind = Kind::crank,
                              .centre = {{0.15 * c, 0.15 * s, 0}},
                              .axis = unit,
                              .zero = zero * (1 / norm(zero)),
                              .radius = equal ? 0.8 : between(0.6, 0.9),
                              .crank = equal ? 0.235 : between(0.2, 0.3),
                              .from = -0.6,
                              .to = equal ? 1.6 : between(1.4, 3)});
    }
    expect_bounds(solid, volume_from_edges(solid));
  }
}

/// Edges leave boxes of the angles of the cranks at other places for each range.
TEST(ProvenVolume, OfCranksWithDifferentRangesContainsTheVolumeFromEdges) {
  for (const double to : {1.7997, 1.8097, 1.8207, 1.8297}) {
    Solid solid{.bodies = {half_space_of({{0, 0, 1}}, 0)}, .bound = 0.8};
    for (int i = 0; i < 3; ++i) {
      const auto [s, c] = portable::sincos(2 * kPi * i / 3);
      solid.bodies.push_back({.kind = Kind::crank,
                              .centre = {{0.13259 * c, 0.13259 * s, 0}},
                              .axis = {{-s, c, 0}},
                              .zero = {{c, s, 0}},
                              .radius = 0.54209,
                              .crank = 0.20229,
                              .from = -0.698,
                              .to = to});
    }
    expect_bounds(solid, volume_from_edges(solid), 1e-9);
  }
}

TEST(ProvenVolume, OfRandomSolidsContainsTheVolumeFromEdges) {
  Stream random(5, 0, 0, Stream::Use::start);
  const auto between = [&](double low, double high) { return low + (high - low) * random.u01(); };
  const auto vector = [&](double size) {
    return Vector3{{between(-size, size), between(-size, size), between(-size, size)}};
  };
  int proven = 0;
  for (int i = 0; i < 25; ++i) {
    SCOPED_TRACE(i);
    Solid solid{.bodies = {ball_of({}, 1)}, .bound = 1};
    for (int k = 0; k < 2; ++k) {
      const Vector3 axis = vector(1), normal = vector(1);
      Body bore = cylinder_of(axis * (1 / norm(axis)), between(0.3, 0.8), k == 0 ? 1 : -1);
      bore.centre = vector(0.3);
      solid.bodies.push_back(bore);
      solid.bodies.push_back(ball_of(vector(0.6), between(0.3, 0.9), k == 0 ? 1 : -1));
      solid.bodies.push_back(half_space_of(normal * (1 / norm(normal)), between(0, 0.5)));
    }
    const double volume = volume_from_edges(solid);
    const auto found = prove(solid);
    if (!found) continue;
    ++proven;
    EXPECT_LE(found->lower, volume + 1e-14);
    EXPECT_GE(found->upper, volume - 1e-14);
    EXPECT_LE(found->width(), 1e-9);
  }
  EXPECT_GE(proven, 24);
}

TEST(ProvenVolume, IsUnknownWhereSurfacesTouch) {
  EXPECT_FALSE(prove({{ball_of({}, 1), ball_of({{0, 0, 0.5}}, 0.5, -1)}, 1}));
  const double r = 0.7;
  EXPECT_FALSE(prove({{cylinder_of({{1, 0, 0}}, r), cylinder_of({{0, 1, 0}}, r)}, 1}));
}

}  // namespace
}  // namespace pkm::generic::edges
