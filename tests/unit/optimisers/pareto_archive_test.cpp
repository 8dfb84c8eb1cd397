// Crowding-distance truncation, the spacing indicator, and the Pareto archive with its indicators.
#include "engine/optimisers/pareto_archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "engine/optimisers/crowding.hpp"
#include "tests/unit/optimisers/multi_objective_problems.hpp"

namespace pkm::test {
namespace {

using ::testing::ElementsAre;

/// Scores (t, 1 - t).
Scores linear_front(std::initializer_list<double> at) {
  Scores scores{2};
  for (const double t : at) scores.add(std::array{t, 1 - t});
  return scores;
}

TEST(Crowding, RemovesTheMostCrowdedDesignFirst) {
  // 0.62 contributes the smallest area, 0.13 x 0.12. Without it 0.5 contributes most, 0.25 x 0.3, then 0.75 and 0.2.
  const Scores scores = linear_front({0, 0.5, 0.62, 0.2, 0.75, 1});
  EXPECT_THAT(order_by_crowding(scores, 5), ElementsAre(0, 5, 1, 4, 3, 2));
  // Without 0.2, 0.5 contributes 0.25 x 0.5 and 0.75 only 0.25 x 0.25.
  EXPECT_THAT(order_by_crowding(scores, 3), ElementsAre(0, 5, 1, 4, 3, 2));
}

TEST(Crowding, KeepsTheBestDesignOfEachScore) {
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
    const auto order = order_by_crowding(scores, 20);
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

TEST(Crowding, TruncatedFrontsAreMoreEvenlySpaced) {
  std::mt19937 engine(3);
  Scores scores{3};
  for (int i = 0; i < 600; ++i) {
    const double a = static_cast<double>(engine()) / 4294967296.0 * 1.5,
                 b = static_cast<double>(engine()) / 4294967296.0 * 1.5;
    scores.add(std::array{std::cos(a) * std::cos(b), std::cos(a) * std::sin(b), std::sin(a)});
  }
  const auto order = order_by_crowding(scores, 60);
  Scores untruncated{3}, truncated{3};
  for (std::size_t i = 0; i < 60; ++i) {
    untruncated.add({scores[i], 3});
    truncated.add({scores[order[i]], 3});
  }
  EXPECT_LT(spread(truncated), 0.5 * spread(untruncated));
}

TEST(Crowding, EvenlySpacedFrontsHaveZeroSpread) {
  EXPECT_NEAR(spread(linear_front({0, 0.25, 0.5, 0.75, 1})), 0, 1e-15);
  EXPECT_GT(spread(linear_front({0, 0.1, 0.5, 0.6, 1})), 0.1);
  EXPECT_TRUE(std::isnan(spread(linear_front({0, 1}))));
}

/// A table of designs with given objectives (the first is maximised, the second minimised) and status.
class ParetoArchives : public ::testing::Test {
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

TEST_F(ParetoArchives, ContainsFeasibleDesignsOnly) {
  ParetoArchive archive({}, problem_, table_);
  EXPECT_FALSE(archive.add(add({{9, 0}}, Status::infeasible)));
  EXPECT_EQ(archive.compromise_row(), -1);
  EXPECT_TRUE(std::isnan(archive.front().hypervolume));
  EXPECT_TRUE(archive.add(add({{2, 5}})));
  EXPECT_TRUE(archive.front().reference.empty());  // a single design has no range
  EXPECT_TRUE(archive.add(add({{4, 7}})));
  EXPECT_THAT(archive.front().rows, ElementsAre(2, 1));  // sorted by the first objective, best first
}

TEST_F(ParetoArchives, AutomaticReferencePointIsATenthOfTheRangeBeyondTheWorst) {
  ParetoArchive archive({.min_feasible_designs = 3}, problem_, table_);
  archive.add(add({{2, 5}, {4, 7}}));
  EXPECT_TRUE(archive.front().reference.empty());
  EXPECT_FALSE(archive.add(add({{3, 15}})));  // dominated, but the third feasible design: the reference point is set
  EXPECT_THAT(archive.front().reference, ElementsAre(2 - 0.1 * 2, 15 + 0.1 * 10));
  const auto fixed = archive.front().reference;
  const double before = archive.front().hypervolume;
  EXPECT_NEAR(before, (4 - 1.8) * (16 - 7) + (2 - 1.8) * (7 - 5), 1e-12);
  archive.add(add({{5, 1}, {0, 0}}));
  EXPECT_EQ(archive.front().reference, fixed);
  EXPECT_NEAR(archive.front().hypervolume, (5 - 1.8) * (16 - 1), 1e-12);  // (0, 0) is worse than the reference point
}

TEST_F(ParetoArchives, ReferencePointNeedsARangeAndRowsCountOnce) {
  ParetoArchive archive({}, problem_, table_);
  const auto rows = add({{2, 5}, {3, 5}});
  archive.add(rows);
  archive.add(rows);
  EXPECT_TRUE(archive.front().reference.empty());  // the second objective has no range yet
  archive.add(add({{4, 6}}));
  EXPECT_EQ(archive.front().reference.size(), 2u);
  EXPECT_FALSE(std::isnan(archive.front().hypervolume));
}

TEST_F(ParetoArchives, ReferencePointAndFrontCanBeGiven) {
  ParetoArchive archive({.max_size = 0,
                         .reference = {{"f0", 1}, {"f1", 10}},
                         .reference_front = {{{"f0", 4}, {"f1", 2}}, {{"f0", 3}, {"f1", 1}}}},
                        problem_, table_);
  archive.add(add({{3, 4}}));
  EXPECT_DOUBLE_EQ(archive.front().hypervolume, 2 * 6);
  // The ranges of the reference front are 1 and 1. The front is worse by (1, 2) than its first point, (0, 3) than the
  // second.
  EXPECT_DOUBLE_EQ(archive.front().igd_plus, (std::sqrt(5.0) + 3) / 2);
}

}  // namespace
}  // namespace pkm::test
