#include "engine/generic/edges/solid.hpp"

#include <gtest/gtest.h>

#include "engine/math/random.hpp"

namespace pkm::generic::edges {
namespace {

using Kind = Body::Kind;

EdgeVolume volume(const Solid& solid, double tolerance, std::vector<Body>* gradient = nullptr) {
  VolumeScratch scratch;
  return edges::volume(solid, tolerance, scratch, gradient);
}

Vector3 unit(const Vector3& v) { return v * (1 / norm(v)); }

Body ball(const Vector3& centre, double radius, double side = 1) {
  return {.kind = Kind::sphere, .centre = centre, .radius = radius, .side = side};
}
Body cylinder(const Vector3& axis, double radius, double side = 1) {
  return {.kind = Kind::cylinder, .axis = axis, .radius = radius, .side = side};
}
Body half_space(const Vector3& normal, double distance) {
  return {.kind = Kind::plane, .axis = normal, .radius = distance};
}

/// Three cranks and rods, at 120 deg about z, below a plane.
Solid rotary_delta(double base, double platform, double crank, double rod, double from, double to, double depth = 0) {
  Solid solid{.bodies = {}, .bound = crank + rod};
  for (int i = 0; i < 3; ++i) {
    const auto [s, c] = portable::sincos(2 * kPi * i / 3);
    solid.bodies.push_back({.kind = Kind::crank,
                            .centre = {{(base - platform) * c, (base - platform) * s, 0}},
                            .axis = {{-s, c, 0}},
                            .zero = {{c, s, 0}},
                            .radius = rod,
                            .crank = crank,
                            .from = from,
                            .to = to});
  }
  solid.bodies.push_back(half_space({{0, 0, 1}}, -depth));
  return solid;
}

/// Three cranks and rods, each with dimensions and directions of its own, below a plane.
Solid asymmetric_delta(Stream& random) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.u01(); };
  Solid solid{.bodies = {}, .bound = 1.2};
  for (int i = 0; i < 3; ++i) {
    const auto [s, c] = portable::sincos(2 * kPi * i / 3 + between(-0.3, 0.3));
    const double base = between(0.1, 0.25), tilt = between(-0.2, 0.2), from = between(-1.5, 0);
    const Vector3 axis = unit({{-s, c, tilt}});
    const Vector3 out{{c, s, 0}};
    solid.bodies.push_back({.kind = Kind::crank,
                            .centre = {{base * c, base * s, between(-0.1, 0.1)}},
                            .axis = axis,
                            .zero = unit(out - axis * dot(out, axis)),
                            .radius = between(0.3, 0.7),
                            .crank = between(0.12, 0.28),
                            .from = from,
                            .to = from + between(0.5, 3.5)});
  }
  solid.bodies.push_back(half_space({{0, 0, 1}}, 0.05));
  return solid;
}

Solid three_slides(const std::vector<Vector3>& centres, const std::vector<Vector3>& axes, double rod, double from,
                   double to) {
  Solid solid{.bodies = {}, .bound = 2};
  for (std::size_t i = 0; i < 3; ++i)
    solid.bodies.push_back({.kind = Kind::slide,
                            .centre = centres[i],
                            .axis = axes[i],
                            .radius = rod,
                            .from = from,
                            .to = to,
                            .is_first_root = false});
  return solid;
}
Solid orthoglide() { return three_slides({{}, {}, {}}, {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}, 0.31, 0.126, 0.383); }
Solid linear_delta() {
  std::vector<Vector3> centres;
  for (int i = 0; i < 3; ++i) {
    const auto [s, c] = portable::sincos(2 * kPi * i / 3);
    centres.push_back({{0.24 * c, 0.24 * s, 0}});
  }
  const Vector3 up{{0, 0, 1}};
  return three_slides(centres, {up, up, up}, 0.5, 0, 0.6);
}

void expect_volume(const Solid& solid, double expected, double relative = 1e-14) {
  const EdgeVolume found = volume(solid, 1e-9);
  EXPECT_TRUE(found.is_supported);
  EXPECT_TRUE(found.is_closed) << found.gap;
  EXPECT_NEAR(found.value, expected, relative * expected);
  EXPECT_LE(std::fabs(found.value - expected), found.error + relative * expected);
  EXPECT_LE(found.error, 1e-9 * expected);
}

TEST(EdgeVolume, OfABallIsThatOfItsPole) { expect_volume({{ball({{1, 2, 3}}, 0.5)}, 4.5}, kPi / 6); }

TEST(EdgeVolume, OfALensAndALuneAreClosedForms) {
  const double R = 1, r = 0.8, d = 0.9;
  const double lens = kPi * (R + r - d) * (R + r - d) * (d * d + 2 * d * (r + R) - 3 * (r - R) * (r - R)) / (12 * d);
  const Vector3 a{{0.1, 0.2, 0.3}}, b{{0.1, 1.1, 0.3}};
  expect_volume({{ball(a, R), ball(b, r)}, 3}, lens);
  expect_volume({{ball(a, R), ball(b, r, -1)}, 3}, 4 * kPi / 3 - lens);
}

TEST(EdgeVolume, OfABallWithABoreIsThatOfABallOfItsHeight) {
  const double ring = kPi / 6 * std::pow(2 * std::sqrt(0.75), 3);
  const Vector3 axis{{0.6, 0, 0.8}};
  expect_volume({{ball({}, 1), cylinder(axis, 0.5, -1)}, 1}, ring);
  expect_volume({{ball({}, 1), cylinder(axis, 0.5)}, 1}, 4 * kPi / 3 - ring);
}

TEST(EdgeVolume, OfVivianisSolidIsAClosedForm) {
  Body bore = cylinder({{0, 0, 1}}, 0.5);
  bore.centre = {{0.5, 0, 0}};
  expect_volume({{ball({}, 1), bore}, 1}, 2 * kPi / 3 - 8.0 / 9);
}

TEST(EdgeVolume, OfTwoAndThreeEqualCylindersAreSteinmetzSolids) {
  const double r = 0.7;
  const Body x = cylinder({{1, 0, 0}}, r), y = cylinder({{0, 1, 0}}, r), z = cylinder({{0, 0, 1}}, r);
  expect_volume({{x, y}, 2}, 16.0 / 3 * r * r * r);
  expect_volume({{x, y, z}, 2}, 8 * (2 - std::sqrt(2.0)) * r * r * r);
}

TEST(EdgeVolume, OfAnObliquelyCutCylinderIsThatOfItsAxis) {
  expect_volume({{cylinder({{0, 0, 1}}, 0.5), half_space({{0.6, 0, 0.8}}, 0.8), half_space({{0, 0, -1}}, 1)}, 3},
                kPi * 0.25 * 2);
}

TEST(EdgeVolume, OfABoxIsAProduct) {
  Solid box{.bodies = {}, .bound = 4};
  for (std::size_t i = 0; i < 3; ++i) {
    Vector3 n{};
    n[i] = 1;
    box.bodies.push_back(half_space(n, 1 + static_cast<double>(i)));
    box.bodies.push_back(half_space(n * -1.0, 0.5));
  }
  expect_volume(box, 1.5 * 2.5 * 3.5);
}

TEST(EdgeVolume, OfASweptHalfBallIsItsCrossSectionTimesThePath) {
  Solid tube{.bodies = {{.kind = Kind::crank,
                         .axis = {{0, 0, 1}},
                         .zero = {{1, 0, 0}},
                         .radius = 0.3,
                         .crank = 1,
                         .from = -1,
                         .to = 2}},
             .bound = 1.3};
  expect_volume(tube, 3 * kPi * 0.09);
  tube.bodies.front().to = 4;
  tube.bodies.front().is_first_root = false;
  expect_volume(tube, 5 * kPi * 0.09);
  tube.bodies.push_back(half_space({{0, 0, 1}}, 0));
  expect_volume(tube, 2.5 * kPi * 0.09);
}

/// References: cylindrical decomposition, to the digits that it reports.
TEST(EdgeVolume, OfParallelRobotsAgreesWithCylindricalDecomposition) {
  const double deg = kPi / 180;
  expect_volume(rotary_delta(0.2, 0.05, 0.2, 0.5, -40 * deg, 95 * deg), 0.0790895627332, 1e-12);
  expect_volume(linear_delta(), 0.0974508000056, 1e-11);
  expect_volume(orthoglide(), 0.0174201287309, 1e-11);
}

/// References: brute force by inverse kinematics, and certified bounds.
TEST(EdgeVolume, OfWideCranksIsRight) {
  expect_volume(rotary_delta(.12940561859303862, .041944237984920529, .27486452962414226, .65021369769406367,
                             -.96846697688562788, 2.0713768713352843),
                0.501861152079, 1e-11);
  expect_volume(rotary_delta(.13426198660357239, .040892405365460772, .17781219728363606, .61440903185353202,
                             -.30435893295593752, 2.0837650793270677, .2712143322415246),
                0.107478517961, 1e-11);
}

/// The two parts into which a plane divides a solid have other edges, and the volume of the solid together.
TEST(EdgeVolume, OfRandomSolidsIsTheSumOfTheVolumesOfTheirParts) {
  Stream random(1, 0, 0, Stream::Use::start);
  const auto between = [&](double low, double high) { return low + (high - low) * random.u01(); };
  const auto direction = [&] { return unit({{between(-1, 1), between(-1, 1), between(-1, 1)}}); };
  int not_closed = 0;  // a crank nearly as long as the distance of its pivot from the middle
  for (int i = 0; i < 250; ++i) {
    SCOPED_TRACE(i);
    Solid solid;
    double height = 0;
    if (i >= 200) {
      solid = asymmetric_delta(random);
      height = -0.4;
    } else if (i % 4 == 0) {
      const double from = between(-3, 1), base = between(0.1, 0.3), platform = between(0.03, 0.07);
      solid = rotary_delta(base, platform, between(0.12, 0.28), between(0.3, 0.7), from, from + between(0.5, 5.2));
      height = -0.4;
    } else if (i % 4 == 1) {
      const std::vector<Vector3> axes{unit({{1, between(-0.2, 0.2), 0}}), unit({{0, 1, between(-0.2, 0.2)}}),
                                      unit({{between(-0.2, 0.2), 0, 1}})};
      solid = three_slides({{}, {{between(0, 0.03), 0, 0}}, {}}, axes, between(0.2, 0.4), between(0.08, 0.18),
                           between(0.2, 0.5));
    } else if (i % 4 == 2) {
      solid.bound = 2;
      for (int k = 0; k < 3; ++k) {
        solid.bodies.push_back(cylinder(direction(), between(0.3, 0.7)));
        solid.bodies.back().centre = direction() * between(0, 0.2);
      }
      solid.bodies.push_back(ball(direction() * between(0, 0.2), between(0.6, 0.9)));
      solid.bodies.push_back(ball(direction() * between(0, 0.3), between(0.1, 0.3), -1));
    } else {
      solid.bound = 2.5;
      for (int k = 0; k < 6; ++k) {
        const Vector3 centre = direction() * between(0.2, 0.6);
        solid.bodies.push_back(ball(centre, between(1.2, 2)));
        solid.bodies.push_back(ball(centre, between(0.4, 0.8), -1));
      }
      height = 0.5;
    }
    const Vector3 normal = direction();
    const double distance = between(-0.1, 0.1) + height * normal[2];
    Solid above = solid, below = solid;
    below.bodies.push_back(half_space(normal, distance));
    above.bodies.push_back(half_space(normal * -1.0, -distance));
    const EdgeVolume whole = volume(solid, 1e-10), a = volume(above, 1e-10), b = volume(below, 1e-10);
    if (!whole.is_closed || !a.is_closed || !b.is_closed) {
      ++not_closed;
      continue;
    }
    EXPECT_NEAR(whole.value, a.value + b.value, whole.error + a.error + b.error + 1e-15);
  }
  EXPECT_LE(not_closed, 1);
}

/// If base and platform have the same radius, all three tori touch each other on the axis of symmetry, and six of their
/// curves pass through that point. A search cannot separate the ends of the edges there, by the square root of the
/// rounding errors, and reports that.
TEST(EdgeVolume, OfADeltaWithEqualRadiiIsTheLimitOfUnequalOnes) {
  const auto at = [](double difference) {
    return volume(rotary_delta(0.05 + difference, 0.05, 0.376, 0.437, -0.7, 1.6), 1e-10);
  };
  const EdgeVolume equal = at(0);
  EXPECT_TRUE(equal.is_supported && equal.is_closed) << equal.gap;
  EXPECT_GT(equal.value, 0.3);
  EXPECT_LT(equal.error, 1e-7);
  constexpr double kStep = 1e-4;
  for (const double side : {1.0, -1.0})
    EXPECT_NEAR(equal.value, 3 * at(side * kStep).value - 3 * at(2 * side * kStep).value + at(3 * side * kStep).value,
                equal.error + 1e-10);
}

TEST(EdgeVolume, IsZeroOfAnEmptySolid) {
  const EdgeVolume found = volume({{ball({}, 1), ball({{3, 0, 0}}, 1)}, 4}, 1e-9);
  EXPECT_TRUE(found.is_closed);
  EXPECT_EQ(found.value, 0);
}

TEST(EdgeVolume, OfThePartsInsideAndOutsideOfACylinderAddUp) {
  Solid solid = rotary_delta(0.2, 0.05, 0.2, 0.5, -0.7, 1.6);
  const EdgeVolume whole = volume(solid, 1e-12);
  double sum = 0;
  for (const double side : {1.0, -1.0}) {
    Body core = cylinder(unit({{0.1, -0.05, 1}}), 0.25, side);
    core.centre = {{0.02, 0.03, 0}};
    solid.bodies.resize(4);
    solid.bodies.push_back(core);
    const EdgeVolume part = volume(solid, 1e-12);
    EXPECT_TRUE(part.is_supported && part.is_closed);
    EXPECT_GT(part.value, 0.01);
    sum += part.value;
  }
  EXPECT_NEAR(sum, whole.value, 1e-14);
}

TEST(EdgeVolume, RefusesFacesOnTheSameSurface) {
  const Body z = cylinder({{0, 0, 1}}, 1), above = half_space({{0, 0, -1}}, 1);
  EXPECT_FALSE(volume({{z, z, above}, 2}, 1e-9).is_supported);
  EXPECT_FALSE(volume({{ball({}, 1), ball({}, 1)}, 2}, 1e-9).is_supported);
  EXPECT_FALSE(volume({{ball({}, 1), above, above}, 2}, 1e-9).is_supported);
  Solid twice = rotary_delta(0.2, 0.05, 0.2, 0.5, -0.7, 1.6);
  twice.bodies.push_back(twice.bodies.front());
  twice.bodies.back().to = 1.2;
  EXPECT_FALSE(volume(twice, 1e-9).is_supported);
  EXPECT_TRUE(volume({{ball({}, 1), ball({}, 2)}, 2}, 1e-9).is_supported);
}

/// Compares the derivative by a number with a central difference.
template <class Change>
void expect_derivative(const Solid& solid, double derivative, const Change& change) {
  const auto at = [&](double step) {
    Solid changed = solid;
    change(changed, step);
    return volume(changed, 1e-13).value;
  };
  constexpr double kStep = 1e-4;
  const double difference = (8 * (at(kStep) - at(-kStep)) - (at(2 * kStep) - at(-2 * kStep))) / (12 * kStep);
  EXPECT_NEAR(derivative, difference, 1e-8);
}

void expect_gradient(const Solid& solid) {
  std::vector<Body> gradient;
  ASSERT_TRUE(volume(solid, 1e-13, &gradient).is_closed);
  for (std::size_t i = 0; i < solid.bodies.size(); ++i) {
    SCOPED_TRACE(i);
    const Body& by = gradient[i];
    for (const auto member : {&Body::radius, &Body::crank, &Body::from, &Body::to}) {
      if (solid.bodies[i].*member == 0) continue;
      expect_derivative(solid, by.*member, [&](Solid& s, double step) { s.bodies[i].*member += step; });
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (solid.bodies[i].kind != Kind::plane)
        expect_derivative(solid, by.centre[k], [&](Solid& s, double step) { s.bodies[i].centre[k] += step; });
      if (solid.bodies[i].kind == Kind::sphere) continue;
      const Vector3 a = solid.bodies[i].axis, zero = solid.bodies[i].zero;
      Vector3 e{};
      e[k] = 1;
      const Vector3 da = e - a * a[k];
      // zero follows the axis: it remains normal to it
      expect_derivative(solid, dot(by.axis, da) - dot(zero, da) * dot(by.zero, a), [&](Solid& s, double step) {
        s.bodies[i].axis = unit(a + da * step);
        s.bodies[i].zero = zero - s.bodies[i].axis * dot(zero, s.bodies[i].axis);
        if (dot(zero, zero) > 0) s.bodies[i].zero = unit(s.bodies[i].zero);
      });
      if (solid.bodies[i].kind != Kind::crank) continue;
      const Vector3 dz = e - a * a[k] - zero * zero[k];
      expect_derivative(solid, dot(by.zero, dz),
                        [&](Solid& s, double step) { s.bodies[i].zero = unit(zero + dz * step); });
    }
  }
}

TEST(EdgeVolumeGradient, AgreesWithDifferencesForQuadrics) {
  Body bore = cylinder({{0.6, 0, 0.8}}, 0.4, -1);
  bore.centre = {{0.1, 0.05, 0}};
  expect_gradient({{ball({{0.1, 0, 0}}, 1), ball({{0.5, 0.3, 0.2}}, 0.9), bore, half_space({{0, 0.6, 0.8}}, 0.4)}, 2});
}
TEST(EdgeVolumeGradient, AgreesWithDifferencesForSlides) {
  Solid solid = orthoglide();
  for (std::size_t i = 0; i < 3; ++i) {
    solid.bodies[i].radius += 0.01 * static_cast<double>(i);
    solid.bodies[i].from += 0.02 * static_cast<double>(i);
  }
  expect_gradient(solid);
}
TEST(EdgeVolumeGradient, AgreesWithDifferencesForCranksOfDifferentDimensions) {
  Stream random(3, 0, 0, Stream::Use::start);
  expect_gradient(asymmetric_delta(random));
}
TEST(EdgeVolumeGradient, AgreesWithDifferencesForACrank) {
  Solid solid = rotary_delta(0.2, 0.05, 0.2, 0.5, -0.4, 1.6);
  solid.bodies.erase(solid.bodies.begin() + 1, solid.bodies.begin() + 3);
  solid.bodies.front().centre = {{0.1, 0.02, -0.03}};
  solid.bodies.push_back(ball({{0, 0.1, -0.3}}, 0.4));
  expect_gradient(solid);
}
/// The three limbs together, by the dimensions that they share.
TEST(EdgeVolumeGradient, AgreesWithDifferencesForARotaryDelta) {
  const Solid solid = rotary_delta(0.2, 0.05, 0.2, 0.5, -0.7, 1.6, 0.3);
  std::vector<Body> gradient;
  ASSERT_TRUE(volume(solid, 1e-13, &gradient).is_closed);
  for (const auto member : {&Body::radius, &Body::crank, &Body::from, &Body::to}) {
    const double sum = gradient[0].*member + gradient[1].*member + gradient[2].*member;
    expect_derivative(solid, sum, [&](Solid& s, double step) {
      for (std::size_t i = 0; i < 3; ++i) s.bodies[i].*member += step;
    });
  }
  double by_base = 0;
  for (std::size_t i = 0; i < 3; ++i) by_base += dot(gradient[i].centre, solid.bodies[i].zero);
  expect_derivative(solid, by_base, [&](Solid& s, double step) {
    for (std::size_t i = 0; i < 3; ++i) s.bodies[i].centre += s.bodies[i].zero * step;
  });
  expect_derivative(solid, gradient[3].radius, [&](Solid& s, double step) { s.bodies[3].radius += step; });
}

}  // namespace
}  // namespace pkm::generic::edges
