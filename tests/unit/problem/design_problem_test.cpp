// The problem of a study beyond what the contract suites and the optimisers' tests see of it.
#include "engine/problem/design_problem.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "engine/mechanisms/all.hpp"
#include "tests/unit/contracts/nominal.hpp"

namespace pkm {
namespace {

/// Parameter 0 is the only variable and the objective; its stand-in has the given slope.
DesignProblem with_slope(double slope) {
  ProblemParts parts;
  parts.mechanism = all_mechanisms().front();
  const Parameter& p = parts.mechanism->info().parameters[0];
  parts.parameters = test::nominal(parts.mechanism->info());
  parts.space = DesignSpace({{p.name, p.unit, p.lower, p.upper}});
  parts.varies = {0};
  parts.plan = SurveyPlan{.method = ColumnOptions{}, .held = {}, .limits = no_limits(parts.mechanism->info())};
  parts.objectives.push_back({.name = "first",
                              .unit = p.unit,
                              .meaning = p.meaning,
                              .direction = Direction::minimise,
                              .quantity = make_quantity([](const auto& design) { return design.parameters[0]; },
                                                        [slope](const auto& design) {
                                                          auto stand_in = design.parameters[0] * 2.0;
                                                          stand_in.v[0] = slope;
                                                          return stand_in;
                                                        })});
  return DesignProblem(parts);
}

TEST(DesignProblem, ValuesAreTheQuantitysAndSlopesTheStandInsOwn) {
  const DesignProblem problem = with_slope(3);
  Scratch scratch;
  EvaluationTable table(problem.shape(Detail::derivatives));
  table.extend(1);
  problem.evaluate(std::vector{0.5}, scratch, table.slot(0));
  EXPECT_EQ(table.status[0], Status::feasible);
  EXPECT_EQ(table.objectives[0], 0.5);
  EXPECT_EQ(table.slopes, (std::vector{1.0, 3.0}));
}

TEST(DesignProblem, ASlopeThatIsNoNumberFailsTheDesignThatAskedForIt) {
  for (const double slope : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const DesignProblem problem = with_slope(slope);
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
