// Selection of designs from a Pareto front: compromise, knees, representative subset.
#include "engine/problem/front.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/unit/optimisers/multi_objective_problems.hpp"

namespace pkm::test {
namespace {

using ::testing::ElementsAre;
using ::testing::UnorderedElementsAre;

/// A straight front: the points (t, 1 - t).
Scores line(std::initializer_list<double> at) {
  Scores scores{2};
  for (const double t : at) scores.add(std::array{t, 1 - t});
  return scores;
}

TEST(Front, TheCompromiseUsesNormalisedScores) {
  // The second score is in thousands: without normalisation the last design would be selected.
  const Scores scores{2, {0, 4000, 1, 1000, 4, 0}};
  EXPECT_EQ(compromise(scores), 1u);
}

TEST(Front, AConcaveFrontHasACentralCompromiseAndNoKnees) {
  for (const FrontProblem& known : {zdt_problems()[1], zdt_problems()[4], dtlz2()}) {
    const Scores front{known.objectives(), known.front};
    const Ranges extent = ranges_of(front);
    const std::size_t chosen = compromise(front);
    for (std::size_t k = 0; k < front.objectives; ++k)
      EXPECT_LT((front[chosen][k] - extent.minimum[k]) / extent.range(k), 0.65) << known.name;
    EXPECT_TRUE(knees(front).empty()) << known.name;
    const auto one = select_representatives(front, 1);
    EXPECT_THAT(one, ElementsAre(chosen));
  }
}

TEST(Front, AConstantScoreDoesNotAffectKnees) {
  Scores scores{3};
  for (int i = 0; i <= 50; ++i) scores.add(std::array{i / 50.0, std::pow(1 - i / 50.0, 3), 7.0});
  EXPECT_EQ(knees(scores).size(), 1u);
}

TEST(Front, KneesAreConvexBendsAndNotExtremePoints) {
  // A polyline with two bends towards the origin and one away from it, in the middle.
  const std::array<double, 2> corners[] = {{0.0, 1.0}, {0.05, 0.7}, {0.45, 0.6}, {0.7, 0.05}, {1.0, 0.0}};
  Scores scores{2};
  for (std::size_t i = 0; i + 1 < std::size(corners); ++i)
    for (int k = 0; k < 10; ++k)
      scores.add(std::array{corners[i][0] + (corners[i + 1][0] - corners[i][0]) * k / 10,
                            corners[i][1] + (corners[i + 1][1] - corners[i][1]) * k / 10});
  scores.add(corners[4]);
  EXPECT_THAT(knees(scores), UnorderedElementsAre(10, 30));
  EXPECT_TRUE(knees(line({0, 0.5, 1})).empty());  // a straight front has no knees
}

TEST(Front, AFrontOfFewDesignsHasNoKnees) {
  for (const std::size_t designs : {9U, 10U}) {
    Scores scores{2};
    for (std::size_t i = 0; i < designs; ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(designs - 1);
      scores.add(std::array{t, std::pow(1 - t, 3)});
    }
    EXPECT_EQ(knees(scores).empty(), designs < 10) << designs;
  }
}

TEST(Front, ADesignNextToAnExtremePointIsNoKnee) {
  // A concave front, except for one design whose cost is slightly lower than that of the neighbouring extreme point.
  Scores scores{2};
  scores.add(std::array{0.0, 1.0});
  scores.add(std::array{4e-6, 1 - 8e-6});
  for (int i = 1; i <= 50; ++i) scores.add(std::array{i / 50.0, 1 - std::pow(i / 50.0, 3)});
  EXPECT_TRUE(knees(scores).empty());
  // With a cost lower by 0.2 it is a knee, although it is close to the extreme point in the first score.
  scores.values[2] = 4e-6;
  scores.values[3] = 0.8;
  EXPECT_THAT(knees(scores), ElementsAre(1));
}

TEST(Front, TheSubsetContainsTheExtremePointsAndTheCompromise) {
  Scores scores{2};
  for (int i = 0; i <= 100; ++i) scores.add(std::array{i / 100.0, std::pow(1 - i / 100.0, 3)});
  const auto chosen = select_representatives(scores, 5);
  ASSERT_EQ(chosen.size(), 5u);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_THAT(chosen, ::testing::IsSupersetOf({std::size_t{0}, std::size_t{100}, compromise(scores)}));
  EXPECT_EQ(select_representatives(line({0, 0, 1}), 3).size(), 2u);  // coincident points are selected once
  EXPECT_TRUE(select_representatives(Scores{2}, 3).empty());
}

}  // namespace
}  // namespace pkm::test
