// Branch and bound of volumes that have closed forms.
#include "engine/workspace/bounds/volume_bounds.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/core/team.hpp"
#include "engine/math/scalar.hpp"
#include "tests/unit/workspace/bounds/formulas.hpp"

namespace pkm::bounds {
namespace {

constexpr Ranges kCube = {{{-1, 1}, {-1, 1}, {-1, 1}}};

VolumeBounds bounds_of(const std::string& axes, const std::vector<std::string>& constraints, double gap,
                       const Ranges& ranges = kCube, std::size_t boxes = 100'000) {
  return volume_bounds(conditions(axes, constraints), ranges, {.gap = gap, .max_boxes = boxes});
}
void expect_holds(const VolumeBounds& found, double volume, double gap) {
  EXPECT_LE(found.lower, volume);
  EXPECT_GE(found.upper, volume);
  EXPECT_LE(found.gap(), gap);
  EXPECT_FALSE(found.stopped);
}

TEST(VolumeBounds, OfABallShrinkWithTheBoxes) {
  const double r = 0.7, volume = 4 * kPi / 3 * r * r * r;
  double gap = 2.001;
  for (const std::size_t boxes : {1u, 10u, 100u, 1000u, 10'000u}) {
    const VolumeBounds found = bounds_of("xyz", {"0.49 - (x - 0.1)^2 - y^2 - (z + 0.2)^2"}, 0, kCube, boxes);
    EXPECT_LE(found.lower, volume) << boxes;
    EXPECT_GE(found.upper, volume) << boxes;
    EXPECT_LT(found.gap(), gap) << boxes;
    EXPECT_GE(found.boxes, boxes);
    gap = found.gap();
  }
  EXPECT_LT(gap, 1e-2);
}

TEST(VolumeBounds, OfDiscsInOneAndTwoOuterCoordinates) {
  expect_holds(bounds_of("xz", {"1 - x^2 - z^2"}, 1e-4, {{{-1, 1}, {-1, 1}}}), kPi, 1e-4);
  // a cylinder whose axis is an outer coordinate, or the column coordinate
  expect_holds(bounds_of("xyz", {"0.25 - y^2 - z^2"}, 1e-2), 2 * kPi * 0.25, 1e-2);
  expect_holds(bounds_of("xyz", {"0.25 - x^2 - y^2"}, 5e-2), 2 * kPi * 0.25, 5e-2);
}

/// Two unit discs with the distance 1: the lens has the area 2 pi/3 - sqrt(3)/2.
TEST(VolumeBounds, OfTheIntersectionUnionAndDifferenceOfTwoDiscs) {
  const Ranges ranges = {{{-1.5, 1.5}, {-1, 1}}};
  const std::string first = "1 - (x - 0.5)^2 - z^2", second = "1 - (x + 0.5)^2 - z^2";
  const double lens = 2 * kPi / 3 - std::sqrt(3) / 2;
  expect_holds(bounds_of("xz", {first, second}, 1e-3, ranges), lens, 1e-3);
  expect_holds(bounds_of("xz", {"max(" + first + ", " + second + ")"}, 1e-2, ranges), 2 * kPi - lens, 1e-2);
  expect_holds(bounds_of("xz", {first, "-(" + second + ")"}, 1e-3, ranges), kPi - lens, 1e-3);
}

TEST(VolumeBounds, OfEmptyAndFullBoxes) {
  const VolumeBounds none = bounds_of("xyz", {"-1 - x^2"}, 1e-3), all = bounds_of("xyz", {"2 + x"}, 1e-3);
  EXPECT_EQ(none.lower, 0);
  EXPECT_EQ(none.upper, 0);
  EXPECT_EQ(none.boxes, 1u);
  expect_holds(all, 8, 1e-14);
  EXPECT_EQ(all.boxes, 1u);
}

TEST(VolumeBounds, OfAnIntervalNeedOneBox) {
  const VolumeBounds found = bounds_of("z", {"0.25 - z^2"}, 1e-6, {{{-1, 1}}});
  expect_holds(found, 1, 1e-6);
  EXPECT_EQ(found.boxes, 1u);
}

/// Where a root is undefined, nothing is feasible: 1/2 of the ball.
TEST(VolumeBounds, LeaveOutWhatIsUndefined) {
  expect_holds(bounds_of("xyz", {"0.25 - x^2 - y^2 - z^2", "sqrt(x)"}, 1e-2), 2 * kPi / 3 * 0.125, 1e-2);
}

TEST(VolumeBounds, AreTheSameForAnyNumberOfThreads) {
  const Constraints torus = conditions("xyz", {"0.04 - (sqrt(x^2 + y^2) - 0.5)^2 - z^2"});
  VolumeBounds one, four;
  with_team(1, [&] { one = volume_bounds(torus, kCube, {.gap = 5e-2}); });
  with_team(4, [&] { four = volume_bounds(torus, kCube, {.gap = 5e-2}); });
  EXPECT_EQ(one.lower, four.lower);
  EXPECT_EQ(one.upper, four.upper);
  EXPECT_EQ(one.examined, four.examined);
  expect_holds(one, 2 * kPi * kPi * 0.5 * 0.04, 5e-2);
}

TEST(VolumeBounds, HoldIfTheyAreStopped) {
  int calls = 0;
  BoundsOptions options{.gap = 1e-6, .stop = [&] { return ++calls > 50; }};
  VolumeBounds found;
  with_team(1, [&] { found = volume_bounds(conditions("xyz", {"0.25 - x^2 - y^2 - z^2"}), kCube, options); });
  EXPECT_TRUE(found.stopped);
  EXPECT_LE(found.lower, kPi / 6);
  EXPECT_GE(found.upper, kPi / 6);
}

}  // namespace
}  // namespace pkm::bounds
