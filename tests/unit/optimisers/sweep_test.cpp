#include <gtest/gtest.h>

#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {
namespace {

TEST(Sweep, VariesOneVariableAtATimeAroundTheStart) {
  const auto problem = sphere(2);
  const auto optimiser = make(entry("sweep"), problem, {{"points", std::int64_t{3}}});
  const Outcome outcome = run(*optimiser, problem, 1, 100, nullptr, {{0.25, 2.0}});
  EXPECT_EQ(outcome.table.designs, (std::vector<double>{0.25, 2, -5, 2, 1, 2, 7, 2, 0.25, -5, 0.25, 1, 0.25, 7}));
  EXPECT_EQ(outcome.recorder.first_rows, (std::vector<std::size_t>{0, 1, 4}));
  EXPECT_EQ(outcome.recorder.populations[1], (std::vector<std::int64_t>{1, 2, 3}));
  EXPECT_EQ(outcome.result.best_row, 5);
  EXPECT_EQ(outcome.result.reason, StopReason::exhausted);
  EXPECT_EQ(optimiser->evaluation_limit(problem), 7);
}

TEST(Sweep, WithoutAStartTheCentreOfTheSpaceIsUsed) {
  const auto problem = sphere(2);
  EXPECT_EQ(run(*make(entry("sweep"), problem), problem, 1, 0).table.designs, (std::vector<double>{1, 1}));
}

TEST(Sweep, FullFactorialHasEveryCombinationInBoundedGenerations) {
  const auto problem = sphere(3);
  const auto optimiser =
      make(entry("sweep"), problem, {{"design", std::string("full-factorial")}, {"points", std::int64_t{13}}});
  const Outcome outcome = run(*optimiser, problem);
  ASSERT_EQ(outcome.table.size(), 2197u);
  EXPECT_EQ(outcome.recorder.sizes, (std::vector<std::size_t>{1000, 2000, 2197}));
  for (std::size_t row = 0; row < 2197; ++row) {
    const std::size_t digits[3] = {row / 169, row / 13 % 13, row % 13};
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(outcome.table.designs[3 * row + i], -5.0 + static_cast<double>(digits[i]), 1e-12);
  }
  EXPECT_EQ(optimiser->evaluation_limit(problem), 2197);
}

TEST(Sweep, VariablesWithAStepHaveNoDuplicateValues) {
  const auto problem = sphere(1, 4);  // -5, -1, 3, 7
  const Outcome outcome = run(*make(entry("sweep"), problem), problem, 1, 100, nullptr, {{3.0}});
  EXPECT_EQ(outcome.table.designs, (std::vector<double>{3, -5, -1, 3, 7}));
}

TEST(Sweep, RejectsTooManyCombinations) {
  const auto problem = sphere(6);
  try {
    make(entry("sweep"), problem, {{"design", std::string("full-factorial")}, {"points", std::int64_t{100}}});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(),
                 "points = 100 with 6 variables gives 1e+12 designs; a full-factorial sweep has at most 1e+08");
  }
}

}  // namespace
}  // namespace pkm::test
