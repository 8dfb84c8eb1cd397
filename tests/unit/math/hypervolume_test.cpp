// Hypervolumes of fronts against values calculated by hand, by inclusion-exclusion and by pagmo, and invariances.
#include "engine/math/hypervolume.hpp"

#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/unit/math/random_fronts.hpp"

namespace pkm::test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double hypervolume_of(const std::vector<double>& points, const std::vector<double>& reference) {
  return hypervolume(points, reference.size(), reference);
}

/// Inclusion-exclusion principle over all subsets of the points; for fronts of a few points.
double by_inclusion_exclusion(const std::vector<double>& points, const std::vector<double>& reference) {
  const std::size_t objectives = reference.size(), count = points.size() / objectives;
  double sum = 0;
  for (std::uint32_t subset = 1; subset < 1u << count; ++subset) {
    double box = -1;
    for (std::size_t i = 0; i < count; ++i)
      if (subset >> i & 1u) box = -box;
    for (std::size_t k = 0; k < objectives; ++k) {
      double worst = -kInfinity;
      for (std::size_t i = 0; i < count; ++i)
        if (subset >> i & 1u) worst = std::fmax(worst, points[i * objectives + k]);
      box *= std::fmax(reference[k] - worst, 0);
    }
    sum += box;
  }
  return sum;
}

/// The points in random order.
std::vector<double> shuffled(const std::vector<double>& points, std::size_t objectives, std::uint64_t seed) {
  std::vector<double> result = points;
  Stream stream(seed, 0, 0, Stream::Use::selection);
  for (std::size_t row = points.size() / objectives; row > 1; --row) {
    const std::size_t other = stream.below(row);
    for (std::size_t k = 0; k < objectives; ++k)
      std::swap(result[(row - 1) * objectives + k], result[other * objectives + k]);
  }
  return result;
}

TEST(Hypervolume, EqualsValuesCalculatedByHand) {
  EXPECT_EQ(hypervolume_of({}, {4, 4}), 0);
  EXPECT_EQ(hypervolume_of({1, 2}, {4, 4}), 6);
  EXPECT_EQ(hypervolume_of({1, 3, 2, 2, 3, 1}, {4, 4}), 6);
  EXPECT_EQ(hypervolume_of({-1, 3, 2, -2}, {4, 4}), 3 * 1 + 2 * 6);
  EXPECT_EQ(hypervolume_of({}, {4, 4, 4}), 0);
  EXPECT_EQ(hypervolume_of({1, 2, 3}, {4, 4, 4}), 6);
  EXPECT_EQ(hypervolume_of({0, 1, 1, 1, 0, 1, 1, 1, 0}, {2, 2, 2}), 1 + 3 * 1);
  EXPECT_EQ(hypervolume_of({0, 0, 1, 0, 1, 0, 1, 0, 0}, {2, 2, 2}), 8 - 1);
}

TEST(Hypervolume, IgnoresPointsNotBetterThanTheReferencePoint) {
  EXPECT_EQ(hypervolume_of({1, 4, 4, 1, 5, 0}, {4, 4}), 0);
  EXPECT_EQ(hypervolume_of({1, 3, 0, 4, 3, 1, 9, -9}, {4, 4}), hypervolume_of({1, 3, 3, 1}, {4, 4}));
  EXPECT_EQ(hypervolume_of({1, 1, 1, 0, 0, 2, 0, 2, 0, 3, 0, 0}, {2, 2, 2}), 1);
}

TEST(Hypervolume, IgnoresPointsThatAreNotFinite) {
  EXPECT_EQ(hypervolume_of({1, 2, kNaN, 0, 0, kNaN, 0, -kInfinity, -kInfinity, 0, kInfinity, 0}, {4, 4}), 6);
  EXPECT_EQ(hypervolume_of({1, 2, 3, 0, kNaN, 0, 0, 0, -kInfinity}, {4, 4, 4}), 6);
}

TEST(Hypervolume, EqualsInclusionExclusion) {
  for (const std::size_t objectives : {2, 3})
    for (const char* shape : {"sphere", "plane", "cloud"})
      for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        std::vector<double> points = random_front(shape, 9, objectives, seed);
        if (seed % 2 == 0)  // ties in single coordinates, equal and dominated points
          for (double& value : points) value = std::round(4 * value) / 4;
        for (const double bound : {1.1, 0.8}) {
          const std::vector<double> reference(objectives, bound);
          EXPECT_NEAR(hypervolume_of(points, reference), by_inclusion_exclusion(points, reference), 1e-13)
              << objectives << " objectives, " << shape << ", seed " << seed;
        }
      }
}

TEST(Hypervolume, DependsNeitherOnOrderNorOnRepeatedOrDominatedPoints) {
  for (const std::size_t objectives : {2, 3})
    for (const char* shape : {"sphere", "plane", "cloud"}) {
      std::vector<double> points = random_front(shape, 200, objectives);
      const std::vector<double> reference = front_reference(objectives);
      const double known = hypervolume_of(points, reference);
      for (std::size_t i = 0; i < 50 * objectives; ++i) points.push_back(points[i]);
      for (std::size_t i = 0; i < 50 * objectives; ++i) points.push_back(points[i] + 0.01 * static_cast<double>(i % 2));
      for (std::uint64_t seed = 1; seed <= 10; ++seed)
        EXPECT_EQ(hypervolume_of(shuffled(points, objectives, seed), reference), known) << objectives << ' ' << shape;
    }
}

TEST(Hypervolume, IncreasesWithEveryNonDominatedPoint) {
  for (const std::size_t objectives : {2, 3}) {
    const std::vector<double> points = random_front("sphere", 100, objectives);
    double known = 0;
    for (std::size_t count = 1; count <= 100; ++count) {
      const double next = hypervolume({points.data(), count * objectives}, objectives, front_reference(objectives));
      EXPECT_GT(next, known) << objectives << " objectives, point " << count;
      known = next;
    }
  }
}

TEST(Hypervolume, IsConsistentBetweenTwoAndThreeObjectives) {
  const std::vector<double> flat = random_front("cloud", 300, 2);
  for (const std::size_t constant : {0, 1, 2}) {
    std::vector<double> points;
    for (std::size_t row = 0; row < flat.size(); row += 2) {
      std::vector<double> point = {flat[row], flat[row + 1]};
      point.insert(point.begin() + static_cast<std::ptrdiff_t>(constant), 0.25);
      points.insert(points.end(), point.begin(), point.end());
    }
    std::vector<double> reference(3, 1.1);
    reference[constant] = 0.75;
    EXPECT_NEAR(hypervolume_of(points, reference), 0.5 * hypervolume_of(flat, {1.1, 1.1}), 1e-14) << constant;
  }
}

TEST(Hypervolume, EqualsPagmo) {
  const auto data = nlohmann::json::parse(std::ifstream(PKM_TEST_DATA "/hypervolumes.json"));
  ASSERT_EQ(data.size(), 18u);
  for (const auto& entry : data) {
    const auto objectives = entry.at("objectives").get<std::size_t>();
    const auto shape = entry.at("shape").get<std::string>();
    const auto points = random_front(shape, entry.at("points").get<std::size_t>(), objectives);
    const auto value = entry.at("hypervolume").get<double>();
    EXPECT_NEAR(hypervolume_of(points, front_reference(objectives)), value, 1e-12 * value) << entry.dump();
  }
}

TEST(Hypervolume, RejectsInvalidArguments) {
  const auto message = [](std::vector<double> reference) -> std::string {
    try {
      hypervolume_of({}, reference);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({1}), "hypervolume: found 1 objectives; expected 2 or 3");
  EXPECT_EQ(message({1, 1, 1, 1}), "hypervolume: found 4 objectives; expected 2 or 3");
  EXPECT_EQ(message({1, kNaN}), "hypervolume: the reference point is not finite");
  EXPECT_EQ(message({1, 1, kInfinity}), "hypervolume: the reference point is not finite");
}

}  // namespace
}  // namespace pkm::test
