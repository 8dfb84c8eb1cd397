#include "engine/results/local_optima.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

namespace pkm {
namespace {

using ::testing::ElementsAre;

/// A stage with three converged starts, which differ in the variables a and b.
StageRecord stage_with(const std::array<std::array<double, 2>, 3>& designs, const std::array<double, 3>& objectives,
                       double derivative_by_b) {
  StageRecord stage;
  stage.table = EvaluationTable({2, 1, 0, 0});
  stage.table.extend(3);
  for (std::size_t row = 0; row < 3; ++row) {
    std::ranges::copy(designs[row], stage.table.design(row).begin());
    stage.table.objectives[row] = objectives[row];
    stage.table.status[row] = Status::feasible;
    const auto at = static_cast<std::int64_t>(row);
    stage.starts.push_back({"start", at, 1, at, "converged", "", 1e-8});
  }
  stage.optimality = OptimalityRecord{1e-8, {}, {{"a", "m", 1e-9, 0}, {"b", "m", derivative_by_b, 0}}};
  return stage;
}

std::vector<std::size_t> numbers(const StageRecord& stage) {
  ProblemRecord problem;
  problem.variables = {{"a", "m", 0, 1, 0}, {"b", "m", 0, 1, 0}};
  problem.objectives = {{"f", "1", "", Direction::minimise}};
  return number_optima(problem, stage);
}

TEST(LocalOptima, DesignsThatDifferInAVariableWithoutInfluenceAreOneOptimum) {
  const std::array<std::array<double, 2>, 3> designs = {{{0.5, 0.1}, {0.5, 0.9}, {0.5, 0.4}}};
  EXPECT_THAT(numbers(stage_with(designs, {1, 1 + 1e-9, 1 + 2e-9}, 0)), ElementsAre(1, 1, 1));
  EXPECT_THAT(numbers(stage_with(designs, {1, 1 + 1e-9, 1.01}, 0)), ElementsAre(1, 1, 2));  // another objective
  EXPECT_THAT(numbers(stage_with(designs, {1, 1 + 1e-9, 1 + 2e-9}, 1e-10)), ElementsAre(1, 2, 3));
  const std::array<std::array<double, 2>, 3> others = {{{0.5, 0.1}, {0.5001, 0.1}, {0.6, 0.1}}};
  EXPECT_THAT(numbers(stage_with(others, {1, 1 + 1e-9, 1 + 2e-9}, 0)), ElementsAre(1, 1, 2));
}

}  // namespace
}  // namespace pkm
