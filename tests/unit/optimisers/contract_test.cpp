// The laws that every optimiser of the catalogue keeps.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {
namespace {

class OptimiserContract : public ::testing::TestWithParam<std::string> {
 protected:
  const OptimiserEntry& entry() const { return test::entry(GetParam()); }
  // A short run: laws do not need a good optimum.
  std::unique_ptr<Optimiser> make_short(const Problem& problem) const {
    std::vector<std::pair<std::string, OptionValue>> changes;
    for (const OptionSpec& spec : entry().options) {
      if (spec.name == "generations") changes.emplace_back("generations", std::int64_t{12});
      if (spec.name == "points") changes.emplace_back("points", std::int64_t{9});
    }
    return make(entry(), problem, changes);
  }
  bool searches() const { return entry().capabilities.needs_objective; }
};

TEST_P(OptimiserContract, KeepsBounds) {
  const auto problem = welded_beam();
  const Outcome outcome = run(*make_short(problem), problem);
  ASSERT_GT(outcome.table.size(), 0u);
  for (std::size_t row = 0; row < outcome.table.size(); ++row)
    EXPECT_TRUE(problem.space().contains(std::as_const(outcome.table).design(row))) << "row " << row;
}

TEST_P(OptimiserContract, DiscreteVariablesStayOnTheLattice) {
  const auto problem = sphere(3, 0.25);
  const Outcome outcome = run(*make_short(problem), problem);
  for (const double x : outcome.table.designs) EXPECT_EQ(x, -5 + 0.25 * std::nearbyint((x + 5) / 0.25));
}

TEST_P(OptimiserContract, SameSeedSameBits) {
  const auto problem = welded_beam();
  EXPECT_TRUE(same_bits(run(*make_short(problem), problem, 5), run(*make_short(problem), problem, 5)));
}

TEST_P(OptimiserContract, AnotherSeedSearchesElsewhere) {
  const auto problem = welded_beam();
  const auto optimiser = make_short(problem);
  EXPECT_EQ(same_bits(run(*optimiser, problem, 5), run(*optimiser, problem, 6)), !searches());
}

TEST_P(OptimiserContract, ThreadsDoNotMatter) {
  const auto problem = welded_beam();
  const auto optimiser = make_short(problem);
  const Outcome one = run(*optimiser, problem, 3);
  for (const int threads : {1, 2, 7}) {
    ParallelEvaluator parallel(threads);
    EXPECT_TRUE(same_bits(one, run(*optimiser, problem, 3, 1 << 30, &parallel))) << threads << " threads";
  }
}

TEST_P(OptimiserContract, StoppedAnywhereAndReplayedEqualsStraightThrough) {
  const auto problem = welded_beam();
  const auto optimiser = make_short(problem);
  const Outcome straight = run(*optimiser, problem, 9);
  for (const std::int64_t last : straight.recorder.numbers) {
    const Outcome stopped = run(*optimiser, problem, 9, last);
    if (last != straight.recorder.numbers.back()) {
      EXPECT_EQ(stopped.result.reason, StopReason::interrupted);
      EXPECT_EQ(stopped.table.size(), straight.recorder.sizes[static_cast<std::size_t>(last)]);
    }
    SerialEvaluator serial;
    ReplayEvaluator replay(serial, stopped.table);
    EXPECT_TRUE(same_bits(straight, run(*optimiser, problem, 9, 1 << 30, &replay))) << "stopped after " << last;
  }
}

TEST_P(OptimiserContract, ChainsOfResumesEqualStraightThrough) {
  const auto problem = welded_beam();
  const auto optimiser = make_short(problem);
  const Outcome straight = run(*optimiser, problem, 9);
  EvaluationTable record(problem.shape());
  for (const std::int64_t last : straight.recorder.numbers) {
    SerialEvaluator serial;
    ReplayEvaluator replay(serial, record);
    Outcome resumed = run(*optimiser, problem, 9, last, &replay);
    EXPECT_EQ(resumed.table.size(), straight.recorder.sizes[static_cast<std::size_t>(last)]);
    record = std::move(resumed.table);
  }
  EXPECT_TRUE(same_bits(straight.table, record));
}

TEST_P(OptimiserContract, ReportsEveryRowOnceInGenerationsFromZero) {
  const auto problem = sphere(3);
  const Outcome outcome = run(*make_short(problem), problem);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < outcome.recorder.numbers.size(); ++i) {
    EXPECT_EQ(outcome.recorder.numbers[i], static_cast<std::int64_t>(i));
    EXPECT_EQ(outcome.recorder.first_rows[i], seen);
    seen = outcome.recorder.sizes[i];
    for (const std::int64_t row : outcome.recorder.populations[i]) EXPECT_LT(static_cast<std::size_t>(row), seen);
  }
  EXPECT_EQ(seen, outcome.table.size());
}

TEST_P(OptimiserContract, ReturnsTheBestOfAllItSaw) {
  const auto problem = welded_beam();
  const Outcome outcome = run(*make_short(problem), problem);
  const auto best = static_cast<std::size_t>(outcome.result.best_row);
  for (std::size_t row = 0; row < outcome.table.size(); ++row)
    EXPECT_FALSE(better(outcome.table, Direction::minimise, row, best)) << "row " << row;
}

TEST_P(OptimiserContract, FindsTheLeastInfeasibleWhereNothingIsFeasible) {
  const auto problem = infeasible_everywhere();
  const Outcome outcome = run(*make(entry(), problem), problem, 1, 1 << 30, nullptr, {{1.2, 1.0}});
  const auto best = static_cast<std::size_t>(outcome.result.best_row);
  EXPECT_EQ(outcome.table.status[best], Status::infeasible);
  EXPECT_NEAR(violation(outcome.table.margin_row(best)), 0.5, searches() ? 1e-6 : 0.05);
}

TEST_P(OptimiserContract, NanIsFailedAndNeverBest) {
  const auto problem = partly_undefined();
  const Outcome outcome = run(*make(entry(), problem), problem);
  std::size_t failed = 0;
  for (std::size_t row = 0; row < outcome.table.size(); ++row) {
    const bool undefined = std::as_const(outcome.table).design(row)[0] < 0;
    EXPECT_EQ(outcome.table.status[row] == Status::failed, undefined);
    failed += undefined;
  }
  EXPECT_GT(failed, 0u);
  const double best = outcome.table.objectives[static_cast<std::size_t>(outcome.result.best_row)];
  EXPECT_NEAR(best, 1.0, searches() ? 1e-6 : 0.3);
}

TEST_P(OptimiserContract, NeverExceedsItsEvaluationLimit) {
  for (const double step : {0.0, 3.0}) {
    const auto problem = sphere(2, step);
    const auto optimiser = make(entry(), problem);
    EXPECT_LE(run(*optimiser, problem).table.size(), static_cast<std::size_t>(optimiser->evaluation_limit(problem)));
  }
}

TEST_P(OptimiserContract, EveryOptionSaysWhatItIs) {
  for (const OptionSpec& spec : entry().options) {
    EXPECT_FALSE(spec.meaning.empty()) << spec.name;
    EXPECT_LE(spec.lower, spec.upper) << spec.name;
    const auto* number = spec.initial ? std::get_if<double>(&*spec.initial) : nullptr;
    EXPECT_TRUE(!number || (*number >= spec.lower && *number <= spec.upper)) << spec.name;
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const OptimiserEntry& e : all_optimisers()) all.push_back(e.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, OptimiserContract, ::testing::ValuesIn(names()),
                         [](const auto& instance) { return instance.param; });

}  // namespace
}  // namespace pkm::test
