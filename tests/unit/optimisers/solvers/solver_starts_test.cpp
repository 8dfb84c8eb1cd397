// Multistart runs of NLopt and Ipopt: concurrent runs, exceptions, stops and resuming.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "tests/unit/optimisers/solvers/solve.hpp"

namespace pkm::test {
namespace {

/// Two minima: 0 at x = 0.8, and 0.25 at x = -0.8 (about).
FunctionProblem two_minima() {
  return {box(1, -1.5, 1.5), 0, [](auto x, auto) {
            const auto y = x[0] * x[0] - 0.64;
            const auto z = x[0] - 0.8;
            return y * y + 0.1 * z * z;
          }};
}

TEST(Solvers, EveryStartHasItsOwnEvaluations) {
  const auto problem = two_minima();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, problem, {{"multistart", std::int64_t{6}}}, {{-0.7}, {0.7}});
    const auto& starts = outcome.result.starts;
    ASSERT_EQ(starts.size(), 8u);
    std::int64_t next = 0;
    bool left = false, right = false;
    for (const StartOutcome& start : starts) {
      EXPECT_EQ(start.first_row, next);
      next += start.rows;
      EXPECT_EQ(start.stop, "converged");
      const bool ended_worse = start.message.ends_with("; ended worse than a design on the way, which is kept");
      EXPECT_TRUE(ended_worse || start.optimality < 1e-6) << start.message << start.optimality;
      const double x = outcome.table.designs[static_cast<std::size_t>(start.end_row)];
      left = left || x < 0;
      right = right || x > 0;
    }
    EXPECT_EQ(static_cast<std::size_t>(next), outcome.table.size());
    EXPECT_TRUE(left && right);
    EXPECT_EQ(starts[0].origin, "given");
    EXPECT_EQ(starts[2].origin, "Sobol point 1");
    EXPECT_EQ(outcome.table.designs[0], -0.7);  // bit-identical to the start design
    EXPECT_NEAR(best_value(outcome), 0, 1e-15);
  }
}

/// Throws at the evaluation of row `at`.
class ThrowingEvaluator final : public Evaluator {
 public:
  explicit ThrowingEvaluator(std::size_t at) : at_(at) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override {
    if (table.size() > at_) throw std::runtime_error("the evaluator failed");
    ParallelEvaluator(1).evaluate(problem, table, first);
  }

 private:
  std::size_t at_;
};

TEST(Solvers, ExceptionsPassThroughTheLibraries) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"})
    for (const std::size_t at : {std::size_t{0}, std::size_t{3}}) {
      ThrowingEvaluator evaluator(at);
      try {
        run(*make(entry(optimiser), problem), problem, 1, 1 << 30, &evaluator, {kBeam});
        ADD_FAILURE() << optimiser << ": nothing thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "the evaluator failed");
      }
    }
}

TEST(Solvers, ADeviationFromTheRecordRestartsTheStart) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const auto stage = make(entry(optimiser), problem, {{"multistart", std::int64_t{2}}});
    const Outcome uninterrupted = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
    const std::int64_t in_second = uninterrupted.result.starts[1].first_row + 7;
    Outcome stopped = run(*stage, problem, 4, in_second, nullptr, {kBeam});
    ASSERT_EQ(stopped.recorder.starts.size(), 1u);
    // Simulates different rounding on another processor: the fifth point of the second start differs in one bit.
    double& x = stopped.table.designs[static_cast<std::size_t>(uninterrupted.result.starts[1].first_row + 4) * 4];
    x = std::nextafter(x, 1e9);
    const Outcome again = resume(*stage, problem, 4, stopped, 1 << 30, {kBeam});
    EXPECT_TRUE(same_bits(uninterrupted.table, again.table)) << optimiser;
    EXPECT_TRUE(same_starts(uninterrupted.result.starts, again.result.starts)) << optimiser;
    ASSERT_EQ(again.recorder.warnings.size(), 1u);
    EXPECT_EQ(
        again.recorder.warnings[0],
        "Start 2 (Sobol point 1) deviated from its recorded evaluations, as can happen on another processor; it was "
        "restarted.");
    EXPECT_TRUE(resume(*stage, problem, 4, run(*stage, problem, 4, in_second, nullptr, {kBeam}), 1 << 30, {kBeam})
                    .recorder.warnings.empty());
  }
}

TEST(Solvers, ConcurrentStartsAreBitIdenticalToConsecutiveOnes) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const auto stage = make(entry(optimiser), problem, {{"multistart", std::int64_t{6}}});
    const Outcome uninterrupted = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
    for (const int threads : {2, 3, 7}) {
      ParallelEvaluator parallel(threads);
      with_team(threads, [&] {
        EXPECT_TRUE(same_bits(uninterrupted, run(*stage, problem, 4, 1 << 30, &parallel, {kBeam})))
            << optimiser << ", " << threads << " threads";
      });
    }
  }
}

/// Slow evaluations, so that several starts run concurrently.
class SlowEvaluator final : public Evaluator {
 public:
  explicit SlowEvaluator(int threads) : inner_(threads) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override {
    std::this_thread::sleep_for(std::chrono::microseconds(300));
    inner_.evaluate(problem, table, first);
  }

 private:
  ParallelEvaluator inner_;
};

TEST(Solvers, AStopKeepsTheEvaluationsOfConcurrentStarts) {
  const auto problem = welded_beam();
  const auto stage = make(entry("nlopt"), problem, {{"multistart", std::int64_t{6}}});
  const Outcome uninterrupted = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
  std::size_t max_unmerged_rows = 0;
  for (const std::int64_t last : {0, 5, 20, 60, 90}) {
    SlowEvaluator parallel(3);
    Outcome stopped;
    with_team(3, [&] { stopped = run(*stage, problem, 4, last, &parallel, {kBeam}); });
    ASSERT_EQ(stopped.result.reason, StopReason::interrupted);
    for (const UnmergedRun& start : stopped.result.ahead) {
      max_unmerged_rows = std::max(max_unmerged_rows, start.table.size());
      const StartOutcome& end = uninterrupted.result.starts[static_cast<std::size_t>(start.number)];
      ASSERT_LE(static_cast<std::int64_t>(start.table.size()), end.rows);
      EXPECT_TRUE(same_bits(start.table,
                            uninterrupted.table.slice(static_cast<std::size_t>(end.first_row),
                                                      static_cast<std::size_t>(end.first_row) + start.table.size())));
      if (start.outcome) {
        EXPECT_EQ(start.outcome->rows, end.rows);
      }
    }
    const Outcome again = resume(*stage, problem, 4, stopped, 1 << 30, {kBeam});
    EXPECT_TRUE(same_bits(uninterrupted, again)) << "stopped after " << last;
    // A second stop before any new evaluation loses nothing.
    const Outcome twice = resume(*stage, problem, 4, stopped, 0, {kBeam});
    EXPECT_GE(twice.result.ahead.size(), stopped.result.ahead.size());
    EXPECT_TRUE(same_bits(uninterrupted, resume(*stage, problem, 4, twice, 1 << 30, {kBeam})));
  }
  EXPECT_GT(max_unmerged_rows, 0u);
}

TEST(Solvers, FinishedStartsAreRestoredFromTheRecord) {
  // A start that ended by its time limit cannot be reproduced: its recorded outcome is kept.
  const auto problem = welded_beam();
  const auto stage = make(entry("nlopt"), problem, {{"time", 1e-9}, {"multistart", std::int64_t{3}}});
  const Outcome uninterrupted = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
  const auto unlimited = make(entry("nlopt"), problem, {{"multistart", std::int64_t{3}}});
  Outcome ended = uninterrupted;
  ended.recorder.starts = uninterrupted.result.starts;
  EXPECT_TRUE(
      same_starts(resume(*unlimited, problem, 4, ended, 1 << 30, {kBeam}).result.starts, uninterrupted.result.starts));
}

TEST(Solvers, AHigherEvaluationLimitResumesTheStarts) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Changes starts = {{"multistart", std::int64_t{2}}};
    Changes few = starts;
    few.emplace_back("evaluations", std::int64_t{9});
    Outcome limited = solve(optimiser, problem, few, {kBeam}, 4);
    ASSERT_EQ(limited.table.size(), 27u);
    limited.recorder.starts = limited.result.starts;
    const auto stage = make(entry(optimiser), problem, starts);
    const Outcome uninterrupted = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
    EXPECT_TRUE(same_bits(uninterrupted, resume(*stage, problem, 4, limited, 1 << 30, {kBeam}))) << optimiser;
  }
}

TEST(Solvers, IpoptSolvesInSeveralThreads) {
  std::vector<std::thread> threads;
  std::vector<double> found(4);
  for (std::size_t i = 0; i < found.size(); ++i)
    threads.emplace_back([&, i] {
      const auto problem = welded_beam();
      for (int repeat = 0; repeat < 5; ++repeat) found[i] = best_value(solve("ipopt", problem, {}, {kBeam}));
    });
  for (auto& thread : threads) thread.join();
  for (const double value : found) EXPECT_NEAR(value, 1.7248523, 1e-6);
}

}  // namespace
}  // namespace pkm::test
