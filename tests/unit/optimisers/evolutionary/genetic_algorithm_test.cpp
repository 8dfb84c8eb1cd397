#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {
namespace {

using Changes = std::vector<std::pair<std::string, OptionValue>>;

double best_of(const Outcome& outcome) {
  return outcome.table.objectives[static_cast<std::size_t>(outcome.result.best_row)];
}

// Number of evaluations until a feasible design reaches `target` (minimised).
std::size_t evaluations_to(const Outcome& outcome, double target) {
  for (std::size_t row = 0; row < outcome.table.size(); ++row)
    if (outcome.table.status[row] == Status::feasible && outcome.table.objectives[row] <= target) return row + 1;
  return outcome.table.size() + 1;
}

const Changes kPaperOptions = {{"population", std::int64_t{20}},
                               {"selection", std::string("linear-ranking")},
                               {"crossover", std::string("scattered")},
                               {"crossover_probability", 0.7},
                               {"mutation", std::string("uniform")},
                               {"mutation_probability", 0.002},
                               {"replacement", std::string("generational")},
                               {"unique", false}};

TEST(GeneticAlgorithm, FindsACornerExactlyWithDefaults) {
  const auto problem = corner_optimum();
  const auto optimiser = make(entry("ga"), problem);
  std::vector<std::size_t> evaluations;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Outcome outcome = run(*optimiser, problem, seed);
    EXPECT_NEAR(best_of(outcome), 1.0, 1e-12) << "seed " << seed;
    std::size_t row = 0;
    while (row < outcome.table.size() && outcome.table.objectives[row] < 1 - 1e-4) ++row;
    evaluations.push_back(row + 1);
  }
  std::nth_element(evaluations.begin(), evaluations.begin() + 10, evaluations.end());
  EXPECT_LE(evaluations[10], 98u);  // CMA-ES needs as many on a similar problem
}

TEST(GeneticAlgorithm, SolvesASmoothFunctionFromEverySeed) {
  const auto problem = sphere(4);
  const auto optimiser = make(entry("ga"), problem);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Outcome outcome = run(*optimiser, problem, seed);
    EXPECT_LE(evaluations_to(outcome, 1e-4), 900u) << "seed " << seed;
    EXPECT_LT(best_of(outcome), 1e-9) << "seed " << seed;
  }
}

TEST(GeneticAlgorithm, SolvesActiveConstraintsFromEverySeed) {
  const auto problem = welded_beam();
  const auto optimiser = make(entry("ga"), problem, {{"generations", std::int64_t{400}}});
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    EXPECT_LE(evaluations_to(run(*optimiser, problem, seed), 1.724852 * 1.001), 8000u) << "seed " << seed;
}

TEST(GeneticAlgorithm, EveryOperatorImprovesTheInitialPopulation) {
  const auto problem = sphere(4);
  for (const std::string option : {"selection", "crossover", "mutation", "start", "replacement"}) {
    const auto& specs = entry("ga").options;
    const auto spec = std::find_if(specs.begin(), specs.end(), [&](const auto& s) { return s.name == option; });
    ASSERT_NE(spec, specs.end()) << option;
    for (const std::string& word : spec->choices) {
      const auto optimiser = make(entry("ga"), problem, {{option, word}});
      const Outcome outcome = run(*optimiser, problem);
      const auto start = static_cast<std::size_t>(outcome.recorder.best_rows.front());
      EXPECT_LT(best_of(outcome), 0.05 * outcome.table.objectives[start]) << option << " = " << word;
    }
  }
}

TEST(GeneticAlgorithm, EvaluatesNoDesignTwice) {
  const auto problem = corner_optimum();
  for (const bool unique : {true, false}) {
    const Outcome outcome = run(*make(entry("ga"), problem, {{"unique", unique}}), problem);
    std::set<std::vector<double>> designs;
    for (std::size_t row = 0; row < outcome.table.size(); ++row) {
      const auto design = std::as_const(outcome.table).design(row);
      EXPECT_TRUE(designs.emplace(design.begin(), design.end()).second) << "row " << row;
    }
  }
}

TEST(GeneticAlgorithm, PaperOperatorsReuseParentsAndStallBeforeTheOptimum) {
  const auto problem = corner_optimum();
  const auto optimiser = make(entry("ga"), problem, kPaperOptions);
  std::vector<double> optima;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Outcome outcome = run(*optimiser, problem, seed);
    EXPECT_EQ(outcome.result.reason, StopReason::generations);
    EXPECT_EQ(outcome.recorder.numbers.back(), 100);
    EXPECT_LT(outcome.table.size(), 800u);  // children equal to a parent are not evaluated again
    for (const auto& population : outcome.recorder.populations) EXPECT_EQ(population.size(), 20u);
    optima.push_back(best_of(outcome));
  }
  std::nth_element(optima.begin(), optima.begin() + 10, optima.end());
  EXPECT_LT(optima[10], 0.999);
  EXPECT_GT(optima[10], 0.8);
}

TEST(GeneticAlgorithm, ElitesSurviveGenerationalReplacement) {
  const auto problem = sphere(4);
  const auto optimiser =
      make(entry("ga"), problem, {{"replacement", std::string("generational")}, {"elite", std::int64_t{2}}});
  const Outcome outcome = run(*optimiser, problem);
  for (std::size_t g = 0; g < outcome.recorder.populations.size(); ++g)
    EXPECT_EQ(outcome.recorder.populations[g].front(), outcome.recorder.best_rows[g]);
  EXPECT_EQ(outcome.table.size(), 20u + 100 * 18);
}

TEST(GeneticAlgorithm, StartsFromGivenDesignsProjectedOntoTheSpace) {
  const auto problem = sphere(2, 0.5);
  const Outcome outcome = run(*make(entry("ga"), problem), problem, 1, 0, nullptr, {{0.6, 9.0}, {-5.0, 1.24}});
  EXPECT_EQ(outcome.table.designs[0], 0.5);
  EXPECT_EQ(outcome.table.designs[1], 7.0);
  EXPECT_EQ(outcome.table.designs[2], -5.0);
  EXPECT_EQ(outcome.table.designs[3], 1.0);
  EXPECT_EQ(outcome.table.size(), 20u);
}

TEST(GeneticAlgorithm, AHigherLimitContinuesTheSameRun) {
  const auto problem = welded_beam();
  const Outcome longer = run(*make(entry("ga"), problem), problem);
  // The limit of 57 evaluations is reached in generation 2, whose first children equal those of the longer run.
  for (const Changes& changes :
       {Changes{{"generations", std::int64_t{7}}}, Changes{{"evaluations", std::int64_t{57}}}}) {
    const Outcome shorter = run(*make(entry("ga"), problem, changes), problem);
    ASSERT_LT(shorter.table.size(), longer.table.size());
    EXPECT_TRUE(std::equal(shorter.table.designs.begin(), shorter.table.designs.end(), longer.table.designs.begin()));
    ParallelEvaluator serial(1);
    ReplayEvaluator replay(serial, shorter.table);
    EXPECT_TRUE(same_bits(longer, run(*make(entry("ga"), problem), problem, 1, 1 << 30, &replay)));
  }
}

TEST(GeneticAlgorithm, ReportsTheStopReason) {
  const auto problem = sphere(4);
  const auto run_with = [&](const Changes& changes) { return run(*make(entry("ga"), problem, changes), problem); };
  EXPECT_EQ(run_with({{"generations", std::int64_t{3}}}).result.reason, StopReason::generations);
  const Outcome counted = run_with({{"evaluations", std::int64_t{57}}});
  EXPECT_EQ(counted.result.reason, StopReason::evaluations);
  EXPECT_EQ(counted.table.size(), 57u);
  for (const char* name : {"ga", "nsga2"}) {  // fewer evaluations than the population
    const Outcome part = run(*make(entry(name), problem, {{"evaluations", std::int64_t{5}}}), problem);
    EXPECT_EQ(part.result.reason, StopReason::evaluations) << name;
    EXPECT_EQ(part.table.size(), 5u) << name;
  }
  const Outcome reached = run_with({{"target", 0.01}});
  EXPECT_EQ(reached.result.reason, StopReason::target);
  EXPECT_LE(best_of(reached), 0.01);
  EXPECT_LT(reached.table.size(), 900u);
  const Outcome stalled =
      run_with({{"stall", std::int64_t{8}}, {"tolerance", 0.5}, {"generations", std::int64_t{5000}}});
  EXPECT_EQ(stalled.result.reason, StopReason::stall);
  EXPECT_LT(stalled.recorder.numbers.back(), 5000);
  const auto few = sphere(2, 6);  // nine designs
  const Outcome all = run(*make(entry("ga"), few), few);
  EXPECT_EQ(all.result.reason, StopReason::exhausted);
  EXPECT_EQ(all.table.size(), 9u);
}

TEST(GeneticAlgorithm, TargetRespectsTheDirection) {
  const auto problem = corner_optimum();
  const Outcome outcome = run(*make(entry("ga"), problem, {{"target", 0.9}}), problem);
  EXPECT_EQ(outcome.result.reason, StopReason::target);
  EXPECT_GE(best_of(outcome), 0.9);
  EXPECT_LT(outcome.table.size(), 300u);
}

TEST(GeneticAlgorithm, RejectsAnEliteAsLargeAsThePopulation) {
  const auto problem = sphere(2);
  try {
    make(entry("ga"), problem, {{"elite", std::int64_t{20}}});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "elite = 20 is too large; expected less than population = 20");
  }
}

TEST(GeneticAlgorithm, DefaultPopulationGrowsWithTheNumberOfVariables) {
  EXPECT_EQ(run(*make(entry("ga"), sphere(10)), sphere(10), 1, 0).table.size(), 50u);
  EXPECT_EQ(run(*make(entry("ga"), sphere(3)), sphere(3), 1, 0).table.size(), 20u);
}

}  // namespace
}  // namespace pkm::test
