// Solver stages that start from a front: each result dominates its start or equals it, and lies on the true front.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "tests/unit/optimisers/multi_objective_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {
namespace {

struct Case {
  std::string optimiser, algorithm, scalarisation;
};

/// Minimises the squared distance from (0, 0, 0) and maximises the negative squared distance from (1, 0, 0), subject to
/// x2 >= 0.2 x0. On the front x1 = 0 and x2 = 0.2 x0.
FunctionProblem two_directions() {
  return {box(3, -0.5, 1.5), {Direction::minimise, Direction::maximise}, 1, [](auto x, auto f, auto g) {
            f[0] = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
            f[1] = 0.0 - ((x[0] - 1.0) * (x[0] - 1.0) + x[1] * x[1] + x[2] * x[2]);
            g[0] = x[2] - 0.2 * x[0];
          }};
}

const std::vector<std::vector<double>> kStarts = {{0.9, 0.3, 0.4}, {0.5, -0.2, 0.2}, {0.1, 0.1, 0.3}, {1.4, 0.0, 0.6}};

Outcome refine(const Problem& problem, const Case& c, const std::vector<std::vector<double>>& starts) {
  std::vector<std::pair<std::string, OptionValue>> changes = {{"start", std::string("pareto")},
                                                              {"scalarisation", c.scalarisation}};
  if (!c.algorithm.empty()) changes.emplace_back("algorithm", c.algorithm);
  const auto optimiser = make(entry(c.optimiser), problem, changes);
  ParallelEvaluator serial(1);
  Outcome outcome{EvaluationTable(problem.shape(optimiser->detail())), Recorder(), {}};
  StageInput input{problem, serial, outcome.recorder, 1};
  for (const auto& design : starts) input.starts.push_back({design, "given"});
  input.previous_front = {{1, 1}, {2, problem.objectives()[1].direction == Direction::maximise ? -3.0 : 3.0}};
  outcome.result = optimiser->minimise(input, outcome.table);
  return outcome;
}

void PrintTo(const Case& c, std::ostream* out) { *out << c.optimiser << ' ' << c.algorithm << ' ' << c.scalarisation; }

class RefinedFront : public ::testing::TestWithParam<Case> {};

TEST_P(RefinedFront, ResultsDominateTheirStartsAndAreOptimal) {
  const FunctionProblem problem = two_directions();
  const bool has_derivatives = GetParam().algorithm != "isres";
  const Outcome outcome = refine(problem, GetParam(), kStarts);
  ASSERT_EQ(outcome.result.starts.size(), kStarts.size());
  for (const StartOutcome& start : outcome.result.starts) {
    const auto row = static_cast<std::size_t>(start.end_row);
    const auto from = outcome.table.objective_row(static_cast<std::size_t>(start.first_row));
    const auto to = outcome.table.objective_row(row);
    EXPECT_EQ(outcome.table.status[row], Status::feasible);
    EXPECT_LE(to[0], from[0]);
    EXPECT_GE(to[1], from[1]);
    if (has_derivatives) {
      const auto x = std::as_const(outcome.table).design(row);
      EXPECT_NEAR(x[1], 0, 1e-5);
      EXPECT_NEAR(x[2], 0.2 * x[0], 1e-9);
      EXPECT_LT(start.optimality, 1e-6);
      EXPECT_EQ(start.stop, "converged");
    } else {
      EXPECT_TRUE(std::isnan(start.optimality));
    }
  }
}

TEST_P(RefinedFront, FrontConsistsOfTheNonDominatedResults) {
  const FunctionProblem problem = two_directions();
  const Outcome outcome = refine(problem, GetParam(), kStarts);
  ASSERT_TRUE(outcome.result.front);
  const Front& front = *outcome.result.front;
  ASSERT_FALSE(front.rows.empty());
  EXPECT_EQ(front.reference, (std::vector<double>{2, -3}));
  EXPECT_GT(front.hypervolume, 0);
  double before = -1;
  for (const std::int64_t row : front.rows) {
    const auto is_end = [row](const StartOutcome& start) { return start.end_row == row; };
    EXPECT_TRUE(std::ranges::any_of(outcome.result.starts, is_end));
    EXPECT_GT(outcome.table.objective_row(static_cast<std::size_t>(row))[0], before);
    before = outcome.table.objective_row(static_cast<std::size_t>(row))[0];
  }
  EXPECT_TRUE(std::ranges::find(front.rows, outcome.result.best_row) != front.rows.end());
}

TEST_P(RefinedFront, AnInfeasibleStartBecomesFeasible) {
  const FunctionProblem problem = two_directions();
  const Outcome outcome = refine(problem, GetParam(), {{0.5, 0.1, -0.3}});
  EXPECT_EQ(outcome.table.status[0], Status::infeasible);
  EXPECT_EQ(outcome.table.status[static_cast<std::size_t>(outcome.result.starts[0].end_row)], Status::feasible);
}

const auto kName = [](const ::testing::TestParamInfo<Case>& instance) {
  const Case& c = instance.param;
  return c.optimiser + c.algorithm + (c.scalarisation == "achievement" ? "Achievement" : "Epsilon");
};

INSTANTIATE_TEST_SUITE_P(All, RefinedFront,
                         ::testing::Values(Case{"ipopt", "", "achievement"}, Case{"ipopt", "", "epsilon-constraint"},
                                           Case{"nlopt", "slsqp", "achievement"},
                                           Case{"nlopt", "slsqp", "epsilon-constraint"},
                                           Case{"nlopt", "isres", "achievement"}),
                         kName);

TEST(RefinedFrontStart, FailsIfItCannotBeEvaluated) {
  const FunctionProblem problem(box(1, -1, 1), kMinimiseBoth, 0, [](auto x, auto f, auto) {
    f[0] = x[0] * x[0] + 0.0 * sqrt(x[0]);
    f[1] = 1.0 - x[0];
  });
  const Outcome outcome = refine(problem, {"ipopt", "", "achievement"}, {{-0.5}, {0.5}});
  EXPECT_EQ(outcome.result.starts[0].stop, "failed");
  EXPECT_EQ(outcome.result.starts[0].rows, 1);
  EXPECT_EQ(outcome.result.starts[1].stop, "converged");
  EXPECT_EQ(outcome.result.front->rows.size(), 1u);
}

TEST(RefinedFrontStart, MayWorsenObjectivesToBecomeFeasible) {
  // Minimises x0 and x1 subject to x0 + x1 >= 1.5: from the origin, both must increase.
  const FunctionProblem problem(box(2, 0, 2), kMinimiseBoth, 1, [](auto x, auto f, auto g) {
    f[0] = x[0] * 1.0;
    f[1] = x[1] * 1.0;
    g[0] = x[0] + x[1] - 1.5;
  });
  for (const char* how : {"achievement", "epsilon-constraint"}) {
    const Outcome outcome = refine(problem, {"nlopt", "slsqp", how}, {{0, 0}});
    const auto end = static_cast<std::size_t>(outcome.result.starts[0].end_row);
    EXPECT_EQ(outcome.table.status[end], Status::feasible) << how;
    EXPECT_NEAR(outcome.table.objective_row(end)[0] + outcome.table.objective_row(end)[1], 1.5, 1e-8) << how;
  }
}

TEST(RefinedFrontStart, ImprovesTheNamedObjectiveOfTheEpsilonConstraint) {
  const FunctionProblem problem = two_directions();
  const auto improvement = [&](const char* name) {
    const auto optimiser = make(entry("ipopt"), problem,
                                {{"start", std::string("pareto")},
                                 {"scalarisation", std::string("epsilon-constraint")},
                                 {"objective", std::string(name)}});
    ParallelEvaluator serial(1);
    Outcome outcome{EvaluationTable(problem.shape(optimiser->detail())), Recorder(), {}};
    StageInput input{problem, serial, outcome.recorder, 1, {{kStarts[1], "given"}}, {{1, 1}, {}}};
    outcome.result = optimiser->minimise(input, outcome.table);
    const auto end = outcome.table.objective_row(static_cast<std::size_t>(outcome.result.starts[0].end_row));
    const auto start = outcome.table.objective_row(0);
    return std::array{start[0] - end[0], end[1] - start[1]};
  };
  const auto first = improvement("f0"), second = improvement("f1");
  EXPECT_NEAR(first[1], 0, 1e-9);  // the other objective stays constant
  EXPECT_NEAR(second[0], 0, 1e-9);
  EXPECT_GT(first[0], 0.05);
  EXPECT_GT(second[1], 0.05);
}

}  // namespace
}  // namespace pkm::test
