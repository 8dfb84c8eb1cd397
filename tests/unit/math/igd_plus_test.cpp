// IGD+ against values calculated by hand, and its invariances.
#include "engine/math/igd_plus.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/math/random_fronts.hpp"

namespace pkm::test {
namespace {

double distance(const std::vector<double>& points, const std::vector<double>& front,
                const std::vector<double>& extents) {
  return igd_plus(points, extents.size(), front, extents);
}

TEST(IgdPlus, EqualsValuesCalculatedByHand) {
  EXPECT_EQ(distance({4, 6}, {1, 2}, {1, 1}), 5);
  EXPECT_EQ(distance({7, 6}, {1, 2}, {2, 1}), 5);
  EXPECT_EQ(distance({4, 0}, {1, 2}, {1, 1}), 3) << "being better than the front has distance 0";
  EXPECT_EQ(distance({0, 3, 3, 0}, {0, 2, 2, 0}, {1, 1}), 1);
  EXPECT_EQ(distance({0, 2}, {0, 2, 2, 0}, {1, 1}), 1) << "the mean of 0 and 2";
  EXPECT_EQ(distance({3, 4, 12}, {0, 0, 0}, {1, 1, 1}), 13);
}

TEST(IgdPlus, IsZeroIfThePointsIncludeTheFront) {
  std::vector<double> points = random_front("sphere", 50, 3);
  const std::vector<double> front = points;
  EXPECT_EQ(distance(points, front, {1, 2, 3}), 0);
  points.insert(points.end(), {9, 9, 9});
  EXPECT_EQ(distance(points, front, {1, 2, 3}), 0);
}

TEST(IgdPlus, DecreasesWithBetterPointsAndIgnoresTheirOrder) {
  const std::vector<double> front = random_front("sphere", 200, 2);
  std::vector<double> points, reversed;
  double known = std::numeric_limits<double>::infinity();
  for (const double size : {2.0, 1.5, 1.2, 1.1}) {
    for (const double value : random_front("sphere", 30, 2, 7)) points.push_back(size * value);
    const double next = distance(points, front, {1, 1});
    EXPECT_LT(next, known) << size;
    known = next;
  }
  for (std::size_t row = points.size(); row > 0; row -= 2)
    reversed.insert(reversed.end(), {points[row - 2], points[row - 1]});
  EXPECT_EQ(distance(reversed, front, {1, 1}), known);
}

TEST(IgdPlus, IsInfiniteWithoutPointsAndNeverNaN) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(distance({}, {1, 2}, {1, 1}), infinity);
  EXPECT_EQ(distance({nan, 0, 0, nan}, {1, 2}, {1, 1}), infinity);
  EXPECT_EQ(distance({nan, 0, 2, 2}, {1, 2}, {1, 1}), 1);
  EXPECT_THROW(distance({1, 1}, {}, {1, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace pkm::test
