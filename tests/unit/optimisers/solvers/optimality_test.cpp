// KKT residual and multipliers, and the non-negative least squares that computes them.
#include "engine/optimisers/solvers/optimality.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/non_negative_least_squares.hpp"
#include "engine/problem/evaluator.hpp"
#include "tests/unit/optimisers/known_problems.hpp"

namespace pkm::test {
namespace {

TEST(Optimality, NonNegativeLeastSquares) {
  // first component positive, second at its bound 0
  const auto x = non_negative_least_squares({{1, 0, 0}, {0, 1, 0}}, {2, -3, 5});
  EXPECT_DOUBLE_EQ(x[0], 2);
  EXPECT_EQ(x[1], 0);
  // linearly dependent columns: the solution is not unique, the fit is exact
  const auto twice = non_negative_least_squares({{1, 1}, {2, 2}, {0, 1}}, {3, 4});
  EXPECT_NEAR(twice[0] + 2 * twice[1], 3, 1e-14);
  EXPECT_NEAR(twice[2], 1, 1e-14);
  EXPECT_TRUE(non_negative_least_squares({}, {1, 2}).empty());
}

TEST(Optimality, MultipliersEqualTheGainOfRelaxedConstraints) {
  // max x + 2y subject to 1 - x - y >= 0 on [0, 2]^2: at the optimum (0, 1), relaxing the constraint by e gains 2 e
  const FunctionProblem problem(
      box(2, 0, 2), 1,
      [](auto x, auto g) {
        g[0] = 1.0 - x[0] - x[1];
        return x[0] + 2.0 * x[1];
      },
      Direction::maximise);
  EvaluationTable table(problem.shape(Detail::derivatives));
  table.extend(1);
  table.design(0)[0] = 0;
  table.design(0)[1] = 1;
  ParallelEvaluator(1).evaluate(problem, table, 0);
  const Optimality found = optimality(problem, std::as_const(table).design(0), table.derivative_row(0));
  EXPECT_NEAR(found.optimality, 0, 1e-14);
  ASSERT_EQ(found.margins.size(), 1u);
  EXPECT_NEAR(found.margins[0].multiplier, 2, 1e-14);
  ASSERT_EQ(found.bounds.size(), 1u);
  EXPECT_EQ(found.bounds[0].variable, 0u);
  EXPECT_FALSE(found.bounds[0].upper);
  EXPECT_NEAR(found.bounds[0].multiplier, 1, 1e-14);  // with the lower bound -e of x: x loses e, y gains e, f gains e

  table.design(0)[0] = 0.5;  // interior: the residual is the gradient, relative to the objective
  table.design(0)[1] = 0.25;
  ParallelEvaluator(1).evaluate(problem, table, 0);
  EXPECT_NEAR(optimality(problem, std::as_const(table).design(0), table.derivative_row(0)).optimality, 4, 1e-14);
}

}  // namespace
}  // namespace pkm::test
