// Derivatives of a design problem; other aspects are covered by the contract suites and the tests of the optimisers.
#include "engine/problem/design_problem.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "engine/config/built_in_mechanisms.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

/// Parameter 0 is the only variable and the objective; the smooth approximation has the given derivative.
DesignProblem with_derivative(double derivative) {
  ProblemParts parts;
  parts.mechanism = all_mechanisms().front();
  const Parameter& p = parts.mechanism->info().parameters[0];
  parts.parameters = test::nominal(parts.mechanism->info());
  parts.space = DesignSpace({{p.name, p.unit, p.lower, p.upper}});
  parts.varies = {0};
  parts.plan = WorkspacePlan{.method = ColumnOptions{}, .fixed = {}, .limits = no_limits(parts.mechanism->info())};
  parts.objectives.push_back({.name = "first",
                              .unit = p.unit,
                              .meaning = p.meaning,
                              .direction = Direction::minimise,
                              .quantity = make_quantity([](const auto& design) { return design.parameters[0]; },
                                                        [derivative](const auto& design) {
                                                          auto approximation = design.parameters[0] * 2.0;
                                                          approximation.v[0] = derivative;
                                                          return approximation;
                                                        })});
  return DesignProblem(parts);
}

TEST(DesignProblem, StoresExactValuesAndDerivativesOfTheSmoothApproximation) {
  const DesignProblem problem = with_derivative(3);
  Scratch scratch;
  EvaluationTable table(problem.shape(Detail::derivatives));
  table.extend(1);
  problem.evaluate(std::vector{0.5}, scratch, table.slot(0));
  EXPECT_EQ(table.status[0], Status::feasible);
  EXPECT_EQ(table.objectives[0], 0.5);
  EXPECT_EQ(table.derivatives, (std::vector{1.0, 3.0}));
}

TEST(DesignProblem, NonFiniteDerivativeFailsAnEvaluationWithDerivatives) {
  for (const double value : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const DesignProblem problem = with_derivative(value);
    for (const Detail detail : {Detail::complete, Detail::derivatives}) {
      Scratch scratch;
      EvaluationTable table(problem.shape(detail));
      table.extend(1);
      problem.evaluate(std::vector{0.5}, scratch, table.slot(0));
      EXPECT_EQ(table.status[0], detail == Detail::derivatives ? Status::failed : Status::feasible);
    }
  }
}

}  // namespace
}  // namespace pkm
