// Fronts as they are found: their most diverse designs, their evenness, and the indicators of a keeper.
#include "engine/optimisers/front_keeper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "engine/optimisers/diversity.hpp"
#include "tests/unit/optimisers/trade_off_problems.hpp"

namespace pkm::test {
namespace {

using ::testing::ElementsAre;

Scores line(std::initializer_list<double> at) {
  Scores scores{2};
  for (const double t : at) scores.add(std::array{t, 1 - t});
  return scores;
}

TEST(Diversity, TheMostCrowdedGoesFirst) {
  // 0.62 has a room of 0.13 x 0.12. Without it 0.5 has most, 0.25 x 0.3, then 0.75 and 0.2.
  const Scores scores = line({0, 0.5, 0.62, 0.2, 0.75, 1});
  EXPECT_THAT(most_diverse(scores, 5), ElementsAre(0, 5, 1, 4, 3, 2));
  EXPECT_THAT(most_diverse(scores, 3), ElementsAre(0, 5, 1, 4, 3, 2));  // 0.75 has 0.5 x 0.25 once 0.2 is gone
}

TEST(Diversity, EndsStayInEveryNumberOfScores) {
  std::mt19937 engine(5);
  for (const std::size_t objectives : {2u, 3u, 4u}) {
    Scores scores{objectives};
    for (int i = 0; i < 60; ++i) {
      std::vector<double> point;
      double square = 0;
      for (std::size_t k = 0; k < objectives; ++k) {
        point.push_back(1 + static_cast<double>(engine() % 1000));
        square += point.back() * point.back();
      }
      for (double& x : point) x /= std::sqrt(square);
      scores.add(point);
    }
    const auto order = most_diverse(scores, 20);
    for (std::size_t k = 0; k < objectives; ++k) {
      std::uint32_t best = 0;
      for (std::uint32_t i = 1; i < scores.size(); ++i)
        if (scores[i][k] < scores[best][k]) best = i;
      EXPECT_THAT(std::vector(order.begin(), order.begin() + 20), ::testing::Contains(best)) << objectives;
    }
    auto sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
  }
}

TEST(Diversity, ThinnedFrontsAreMoreEven) {
  std::mt19937 engine(3);
  Scores scores{3};
  for (int i = 0; i < 600; ++i) {
    const double a = static_cast<double>(engine()) / 4294967296.0 * 1.5,
                 b = static_cast<double>(engine()) / 4294967296.0 * 1.5;
    scores.add(std::array{std::cos(a) * std::cos(b), std::cos(a) * std::sin(b), std::sin(a)});
  }
  const auto order = most_diverse(scores, 60);
  Scores first{3}, thinned{3};
  for (std::size_t i = 0; i < 60; ++i) {
    first.add({scores[i], 3});
    thinned.add({scores[order[i]], 3});
  }
  EXPECT_LT(spread(thinned), 0.5 * spread(first));
}

TEST(Diversity, EvenFrontsHaveNoSpread) {
  EXPECT_NEAR(spread(line({0, 0.25, 0.5, 0.75, 1})), 0, 1e-15);
  EXPECT_GT(spread(line({0, 0.1, 0.5, 0.6, 1})), 0.1);
  EXPECT_TRUE(std::isnan(spread(line({0, 1}))));
}

/// Objectives as given, in directions of their own; infeasible where asked for.
class Given : public ::testing::Test {
 protected:
  std::vector<std::int64_t> add(std::initializer_list<std::array<double, 2>> rows, Status status = Status::feasible) {
    std::vector<std::int64_t> added;
    for (const auto& values : rows) {
      const std::size_t row = table_.extend(1);
      std::ranges::copy(values, table_.slot(row).objectives.begin());
      table_.status[row] = status;
      added.push_back(static_cast<std::int64_t>(row));
    }
    return added;
  }
  FunctionProblem problem_{box(1, 0, 1),
                           {Direction::maximise, Direction::minimise},
                           0,
                           [](std::span<const double>, std::span<double>, std::span<double>) {}};
  EvaluationTable table_{problem_.shape()};
};

TEST_F(Given, OnlyFeasibleDesignsCount) {
  FrontKeeper keeper({}, problem_, table_);
  EXPECT_FALSE(keeper.add(add({{9, 0}}, Status::infeasible)));
  EXPECT_EQ(keeper.compromise_row(), -1);
  EXPECT_TRUE(std::isnan(keeper.front().hypervolume));
  EXPECT_TRUE(keeper.add(add({{2, 5}})));
  EXPECT_TRUE(keeper.front().reference.empty());  // one design has no range
  EXPECT_TRUE(keeper.add(add({{4, 7}})));
  EXPECT_THAT(keeper.front().rows, ElementsAre(2, 1));  // the best by the first objective first
}

TEST_F(Given, TheReferenceIsATenthBeyondTheFirstFeasibleDesigns) {
  FrontKeeper keeper({.settled = 3}, problem_, table_);
  keeper.add(add({{2, 5}, {4, 7}}));
  EXPECT_TRUE(keeper.front().reference.empty());
  EXPECT_FALSE(keeper.add(add({{3, 15}})));  // dominated, but from now on there is a reference
  EXPECT_THAT(keeper.front().reference, ElementsAre(2 - 0.1 * 2, 15 + 0.1 * 10));
  const auto fixed = keeper.front().reference;
  const double before = keeper.front().hypervolume;
  EXPECT_NEAR(before, (4 - 1.8) * (16 - 7) + (2 - 1.8) * (7 - 5), 1e-12);
  keeper.add(add({{5, 1}, {0, 0}}));
  EXPECT_EQ(keeper.front().reference, fixed);
  EXPECT_NEAR(keeper.front().hypervolume, (5 - 1.8) * (16 - 1), 1e-12);  // (0, 0) is worse than the corner
}

TEST_F(Given, TheReferenceWaitsForARangeAndRowsCountOnce) {
  FrontKeeper keeper({}, problem_, table_);
  const auto rows = add({{2, 5}, {3, 5}});
  keeper.add(rows);
  keeper.add(rows);
  EXPECT_TRUE(keeper.front().reference.empty());  // the second objective has no range yet
  keeper.add(add({{4, 6}}));
  EXPECT_EQ(keeper.front().reference.size(), 2u);
  EXPECT_FALSE(std::isnan(keeper.front().hypervolume));
}

TEST_F(Given, ReferencesCanBeGiven) {
  FrontKeeper keeper(
      {.limit = 0, .reference = {{"f0", 1}, {"f1", 10}}, .front = {{{"f0", 4}, {"f1", 2}}, {{"f0", 3}, {"f1", 1}}}},
      problem_, table_);
  keeper.add(add({{3, 4}}));
  EXPECT_DOUBLE_EQ(keeper.front().hypervolume, 2 * 6);
  // Ranges of the reference front are 1 and 1: (1, 2) short of its first point, (0, 3) of its second.
  EXPECT_DOUBLE_EQ(keeper.front().igd_plus, (std::sqrt(5.0) + 3) / 2);
}

}  // namespace
}  // namespace pkm::test
