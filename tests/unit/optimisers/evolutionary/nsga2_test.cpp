// Pareto fronts found by nsga2 on problems whose fronts are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/math/hypervolume.hpp"
#include "engine/optimisers/dominance.hpp"
#include "engine/problem/front.hpp"
#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/multi_objective_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {
namespace {

using Changes = std::vector<std::pair<std::string, OptionValue>>;

Outcome run_nsga2(const Problem& problem, std::int64_t population, std::int64_t generations, std::uint64_t seed,
                  Changes changes = {}) {
  changes.emplace_back("population", population);
  changes.emplace_back("generations", generations);
  return run(*make(entry("nsga2"), problem, changes), problem, seed);
}

double hypervolume_of(const FrontProblem& known, const Outcome& outcome, const std::vector<std::int64_t>& rows) {
  const Scores scores = scores_of(known.problem.objectives(), outcome.table, rows);
  return hypervolume(scores.values, known.objectives(), reference_point(known));
}

double true_hypervolume(const FrontProblem& known) {
  return hypervolume(known.front, known.objectives(), reference_point(known));
}

TEST(Nsga2, LargePopulationsAreBitIdenticalWithSeveralThreads) {
  for (const char* name : {"ga", "nsga2"}) {
    const FunctionProblem problem({{"x", "1", 0, 1}, {"y", "1", 0, 1}},
                                  std::vector(name == std::string("ga") ? 1 : 2, Direction::minimise), 1,
                                  [](std::span<const double> x, std::span<double> f, std::span<double> g) {
                                    f[0] = x[0] * x[0] + x[1];
                                    if (f.size() > 1) f[1] = (1 - x[0]) * (1 - x[0]) + x[1] * x[1];
                                    g[0] = x[1] - 0.3;
                                  });
    const auto optimiser =
        make(entry(name), problem, {{"population", std::int64_t{12000}}, {"generations", std::int64_t{2}}});
    const Outcome alone = run(*optimiser, problem);
    for (const int threads : {2, 5})
      with_team(threads, [&] { EXPECT_TRUE(same_bits(run(*optimiser, problem), alone)) << name << ' ' << threads; });
  }
}

TEST(Nsga2, FindsTheFrontsOfTheZdtProblems) {
  for (const FrontProblem& known : zdt_problems()) {
    std::vector<double> ratios;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Outcome outcome = run_nsga2(known.problem, 100, 250, seed);
      ratios.push_back(hypervolume_of(known, outcome, outcome.recorder.populations.back()) / true_hypervolume(known));
    }
    std::sort(ratios.begin(), ratios.end());
    EXPECT_GT(ratios[1], 0.99) << known.name;
  }
}

TEST(Nsga2, FindsTheFrontOfThreeObjectives) {
  const FrontProblem known = dtlz2();
  const Outcome outcome = run_nsga2(known.problem, 100, 100, 1);
  EXPECT_GT(hypervolume_of(known, outcome, outcome.recorder.populations.back()) / true_hypervolume(known), 0.93);
  EXPECT_LT(outcome.recorder.fronts.back().spread, 0.35);
}

TEST(Nsga2, EveryArchivedDesignOfConstrainedProblemsIsFeasible) {
  for (const FrontProblem& known : {bnh(), srn(), tnk(), osy()}) {
    const Outcome outcome = run_nsga2(known.problem, 100, 100, 2);
    ASSERT_TRUE(outcome.result.front) << known.name;
    for (const std::int64_t row : outcome.result.front->rows) {
      const auto r = static_cast<std::size_t>(row);
      EXPECT_EQ(outcome.table.status[r], Status::feasible);
      EXPECT_EQ(violation(outcome.table.margin_row(r)), 0);
    }
    EXPECT_GT(hypervolume_of(known, outcome, outcome.result.front->rows) / true_hypervolume(known), 0.9) << known.name;
  }
}

TEST(Nsga2, TheArchiveHoldsAllNonDominatedEvaluations) {
  const FrontProblem known = tnk();
  const Outcome outcome = run_nsga2(known.problem, 40, 30, 3);
  std::vector<std::int64_t> feasible;
  for (std::size_t row = 0; row < outcome.table.size(); ++row)
    if (outcome.table.status[row] == Status::feasible) feasible.push_back(static_cast<std::int64_t>(row));
  const Scores scores = scores_of(known.problem.objectives(), outcome.table, feasible);
  std::vector<std::uint32_t> front;
  non_dominated_sort(scores, front);
  std::vector<std::int64_t> expected;
  for (std::size_t i = 0; i < feasible.size(); ++i)
    if (front[i] == 0) expected.push_back(feasible[i]);
  auto archived = outcome.result.front->rows;
  std::sort(archived.begin(), archived.end());
  EXPECT_EQ(archived, expected);
}

TEST(Nsga2, HypervolumeNeverDecreasesAndStallStops) {
  const FrontProblem known = zdt_problems()[0];
  const Outcome outcome = run_nsga2(known.problem, 40, 2000, 1, {{"stall", std::int64_t{10}}, {"tolerance", 1e-3}});
  EXPECT_EQ(outcome.result.reason, StopReason::stall);
  const auto& fronts = outcome.recorder.fronts;
  ASSERT_GT(fronts.size(), 20u);
  for (std::size_t g = 1; g < fronts.size(); ++g) EXPECT_GE(fronts[g].hypervolume, fronts[g - 1].hypervolume);
  EXPECT_LT(fronts.back().hypervolume / fronts[fronts.size() - 11].hypervolume, 1 + 1e-3);
}

TEST(Nsga2, TheArchiveRespectsItsMaximumSize) {
  const FrontProblem known = zdt_problems()[0];
  const Outcome outcome = run_nsga2(known.problem, 40, 60, 1, {{"archive", std::int64_t{25}}});
  for (const Front& front : outcome.recorder.fronts) EXPECT_LE(front.rows.size(), 25u);
  EXPECT_EQ(outcome.result.front->rows.size(), 25u);
}

TEST(Nsga2, ReportsTheDistanceToAGivenFront) {
  const FrontProblem known = zdt_problems()[1];
  std::vector<NamedNumbers> front;
  for (std::size_t i = 0; i < known.front.size(); i += 2)
    front.push_back({{"f0", known.front[i]}, {"f1", known.front[i + 1]}});
  const Outcome outcome = run_nsga2(known.problem, 60, 200, 1, {{"reference_front", front}});
  EXPECT_GT(outcome.recorder.fronts.front().igd_plus, 0.1);
  EXPECT_LT(outcome.recorder.fronts.back().igd_plus, 2e-3);
}

TEST(Nsga2, HandlesManyObjectives) {
  const FunctionProblem cube(box(4, 0, 1), std::vector<Direction>(5, Direction::maximise), 0, [](auto x, auto f, auto) {
    for (std::size_t k = 0; k < 4; ++k) f[k] = 1.0 * x[k];
    f[4] = 4.0 - (x[0] + x[1] + x[2] + x[3]);
  });
  const Outcome outcome = run_nsga2(cube, 40, 10, 1);
  EXPECT_TRUE(std::isnan(outcome.recorder.fronts.back().hypervolume));
  EXPECT_EQ(outcome.result.front->rows.size(), outcome.table.size());  // every design of the cube is Pareto optimal
}

}  // namespace
}  // namespace pkm::test
