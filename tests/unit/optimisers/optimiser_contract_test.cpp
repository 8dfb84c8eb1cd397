// Properties that all optimisers of the catalogue must have.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <ostream>

#include "engine/problem/ranking.hpp"
#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {
namespace {

/// An optimiser and, if it is a library, one of its algorithms.
struct Case {
  std::string optimiser, algorithm;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.optimiser << ' ' << c.algorithm; }

class OptimiserContract : public ::testing::TestWithParam<Case> {
 protected:
  const OptimiserEntry& entry() const { return test::entry(GetParam().optimiser); }
  std::vector<std::pair<std::string, OptionValue>> algorithm() const {
    if (GetParam().algorithm.empty()) return {};
    return {{"algorithm", GetParam().algorithm}};
  }
  Capabilities capabilities() const {
    Options options = default_options(entry().options);
    for (const auto& [name, value] : algorithm()) options.set(name, value);
    return entry().capabilities(options);
  }
  // A short run: the properties do not depend on reaching the optimum.
  std::unique_ptr<Optimiser> make_short(const Problem& problem) const {
    auto changes = algorithm();
    for (const OptionSpec& spec : entry().options) {
      if (spec.name == "generations") changes.emplace_back("generations", std::int64_t{12});
      if (spec.name == "points") changes.emplace_back("points", std::int64_t{9});
    }
    if (capabilities().starts) {
      changes.emplace_back("evaluations", std::int64_t{25});
      changes.emplace_back("multistart", std::int64_t{3});
    }
    return make(entry(), problem, changes);
  }
  // A problem that the optimiser can handle, with constraints if possible.
  FunctionProblem problem() const { return adapted(capabilities().constraints ? welded_beam() : corner_optimum()); }
  FunctionProblem adapted(const FunctionProblem& one) const {
    return capabilities().min_objectives > 1 ? one.with_duplicate_objective() : one;
  }
  bool searches() const { return capabilities().min_objectives > 0; }
};

TEST_P(OptimiserContract, RespectsBounds) {
  const auto problem = this->problem();
  const Outcome outcome = run(*make_short(problem), problem);
  ASSERT_GT(outcome.table.size(), 0u);
  for (std::size_t row = 0; row < outcome.table.size(); ++row)
    for (std::size_t i = 0; i < problem.space().dimension(); ++i) {
      const double value = std::as_const(outcome.table).design(row)[i];
      EXPECT_GE(value, problem.space()[i].lower) << "row " << row;
      EXPECT_LE(value, problem.space()[i].upper) << "row " << row;
    }
}

/// Properties of the optimisers that search the whole space and support discrete variables; solvers start at a design.
class SearchContract : public OptimiserContract {};

TEST_P(SearchContract, DiscreteVariablesStayOnTheLattice) {
  const auto problem = adapted(sphere(3, 0.25));
  const Outcome outcome = run(*make_short(problem), problem);
  for (const double x : outcome.table.designs) EXPECT_EQ(x, -5 + 0.25 * std::nearbyint((x + 5) / 0.25));
}

TEST_P(OptimiserContract, SameSeedIsBitIdentical) {
  const auto problem = this->problem();
  EXPECT_TRUE(same_bits(run(*make_short(problem), problem, 5), run(*make_short(problem), problem, 5)));
}

TEST_P(OptimiserContract, DifferentSeedsGiveDifferentDesigns) {
  const auto problem = this->problem();
  const auto optimiser = make_short(problem);
  EXPECT_EQ(same_bits(run(*optimiser, problem, 5), run(*optimiser, problem, 6)), !searches());
}

TEST_P(OptimiserContract, ThreadsDoNotMatter) {
  const auto problem = this->problem();
  const auto optimiser = make_short(problem);
  const Outcome one = run(*optimiser, problem, 3);
  for (const int threads : {1, 2, 7}) {
    ParallelEvaluator parallel(threads);
    with_team(threads, [&] {
      EXPECT_TRUE(same_bits(one, run(*optimiser, problem, 3, 1 << 30, &parallel))) << threads << " threads";
    });
  }
}

TEST_P(OptimiserContract, ResumingAfterAnyGenerationIsBitIdentical) {
  const auto problem = this->problem();
  const auto optimiser = make_short(problem);
  const Outcome uninterrupted = run(*optimiser, problem, 9);
  const auto& numbers = uninterrupted.recorder.numbers;
  for (std::size_t k = 0; k < numbers.size(); k += 1 + numbers.size() / 12) {  // solvers have a hundred
    const std::int64_t last = numbers[k];
    const Outcome stopped = run(*optimiser, problem, 9, last);
    if (last != uninterrupted.recorder.numbers.back()) {
      EXPECT_EQ(stopped.result.reason, StopReason::interrupted);
      EXPECT_EQ(stopped.table.size(), uninterrupted.recorder.sizes[static_cast<std::size_t>(last)]);
    }
    EXPECT_TRUE(same_bits(uninterrupted, resume(*optimiser, problem, 9, stopped))) << "stopped after " << last;
  }
}

TEST_P(OptimiserContract, RepeatedResumingIsBitIdentical) {
  const auto problem = this->problem();
  const auto optimiser = make_short(problem);
  const Outcome uninterrupted = run(*optimiser, problem, 9);
  Outcome record{EvaluationTable(problem.shape(optimiser->detail())), Recorder(), {}};
  for (const std::int64_t last : uninterrupted.recorder.numbers) {
    Outcome resumed = resume(*optimiser, problem, 9, record, last);
    EXPECT_EQ(resumed.table.size(), uninterrupted.recorder.sizes[static_cast<std::size_t>(last)]);
    record = std::move(resumed);
  }
  EXPECT_TRUE(same_bits(uninterrupted.table, record.table));
  EXPECT_TRUE(same_starts(uninterrupted.result.starts, resume(*optimiser, problem, 9, record).result.starts));
}

TEST_P(OptimiserContract, ReportsEachRowOnceInConsecutiveGenerations) {
  const auto problem = adapted(sphere(3));
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

TEST_P(OptimiserContract, ReturnsTheBestEvaluation) {
  const auto problem = this->problem();
  const Outcome outcome = run(*make_short(problem), problem);
  const auto best = static_cast<std::size_t>(outcome.result.best_row);
  const auto rank = [&](std::size_t row) { return ranked(problem.objectives(), outcome.table, row); };
  for (std::size_t row = 0; row < outcome.table.size(); ++row)
    EXPECT_FALSE(better(rank(row), rank(best))) << "row " << row;
}

TEST_P(SearchContract, MinimisesTheViolationIfNothingIsFeasible) {
  const auto problem = adapted(infeasible_everywhere());
  const Outcome outcome = run(*make(entry(), problem), problem, 1, 1 << 30, nullptr, {{1.2, 1.0}});
  const auto best = static_cast<std::size_t>(outcome.result.best_row);
  EXPECT_EQ(outcome.table.status[best], Status::infeasible);
  EXPECT_NEAR(violation(outcome.table.margin_row(best)), 0.5, searches() ? 1e-6 : 0.05);
}

TEST_P(OptimiserContract, NanIsFailedAndNeverBest) {
  const auto problem = adapted(partly_undefined());
  auto changes = algorithm();
  if (capabilities().starts) changes.emplace_back("multistart", std::int64_t{8});
  const Outcome outcome = run(*make(entry(), problem, changes), problem);
  std::size_t failed = 0;
  for (std::size_t row = 0; row < outcome.table.size(); ++row) {
    const bool undefined = std::as_const(outcome.table).design(row)[0] < 0;
    EXPECT_EQ(outcome.table.status[row] == Status::failed, undefined);
    failed += undefined;
  }
  EXPECT_GT(failed, 0u);
  const double best = outcome.table.objective_row(static_cast<std::size_t>(outcome.result.best_row))[0];
  EXPECT_NEAR(best, 1.0,
              !searches()                         ? 0.3
              : capabilities().starts             ? 0.05
              : capabilities().min_objectives > 1 ? 1e-4
                                                  : 1e-6);
}

TEST_P(OptimiserContract, NeverExceedsItsEvaluationLimit) {
  for (const double step : {0.0, 3.0}) {
    if (step > 0 && !capabilities().discrete) continue;
    const auto problem = adapted(sphere(2, step));
    auto changes = algorithm();
    if (capabilities().starts) {
      changes.emplace_back("multistart", std::int64_t{3});
      changes.emplace_back("evaluations", std::int64_t{7});
    }
    const auto optimiser = make(entry(), problem, changes);
    EXPECT_LE(run(*optimiser, problem).table.size(), static_cast<std::size_t>(optimiser->evaluation_limit(problem)));
  }
}

TEST_P(OptimiserContract, EveryOptionHasAMeaningAndAValidDefault) {
  for (const OptionSpec& spec : entry().options) {
    EXPECT_FALSE(spec.meaning.empty()) << spec.name;
    EXPECT_LE(spec.lower, spec.upper) << spec.name;
    const auto* number = spec.initial ? std::get_if<double>(&*spec.initial) : nullptr;
    EXPECT_TRUE(!number || (*number >= spec.lower && *number <= spec.upper)) << spec.name;
  }
}

/// Every optimiser with each of its algorithms; only those that start from designs (true) or search the whole space
/// (false) if `starts_from_designs` is given.
std::vector<Case> cases(std::optional<bool> starts_from_designs = {}) {
  std::vector<Case> all;
  for (const OptimiserEntry& e : all_optimisers()) {
    if (starts_from_designs && e.capabilities(default_options(e.options)).starts != *starts_from_designs) continue;
    const auto algorithm = std::ranges::find(e.options, "algorithm", &OptionSpec::name);
    if (algorithm == e.options.end())
      all.push_back({e.name, ""});
    else
      for (const std::string& choice : algorithm->choices) all.push_back({e.name, choice});
  }
  return all;
}

const auto kName = [](const ::testing::TestParamInfo<Case>& instance) {
  return instance.param.optimiser + (instance.param.algorithm.empty() ? "" : "_" + instance.param.algorithm);
};

INSTANTIATE_TEST_SUITE_P(All, OptimiserContract, ::testing::ValuesIn(cases()), kName);
INSTANTIATE_TEST_SUITE_P(All, SearchContract, ::testing::ValuesIn(cases(false)), kName);

}  // namespace
}  // namespace pkm::test
