// NLopt and Ipopt as stages: optima, limits, what is kept, and resuming.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include "engine/optimisers/solvers/optimality.hpp"
#include "tests/unit/optimisers/known_problems.hpp"
#include "tests/unit/optimisers/stage.hpp"

namespace pkm::test {
namespace {

using Changes = std::vector<std::pair<std::string, OptionValue>>;
using ::testing::HasSubstr;

double best_value(const Outcome& outcome) {
  return outcome.table.objectives[static_cast<std::size_t>(outcome.result.best_row)];
}
Status best_status(const Outcome& outcome) {
  return outcome.table.status[static_cast<std::size_t>(outcome.result.best_row)];
}

Outcome solve(const std::string& optimiser, const Problem& problem, const Changes& changes,
              const std::vector<std::vector<double>>& starts, std::uint64_t seed = 1) {
  return run(*make(entry(optimiser), problem, changes), problem, seed, 1 << 30, nullptr, starts);
}

/// Two minima: 0 at x = 0.8, and 0.25 at x = -0.8 (about).
FunctionProblem two_valleys() {
  return {box(1, -1.5, 1.5), 0, [](auto x, auto) {
            const auto y = x[0] * x[0] - 0.64;
            const auto z = x[0] - 0.8;
            return y * y + 0.1 * z * z;
          }};
}

const std::vector<double> kBeam = {0.5, 3, 9, 0.5};

TEST(Solvers, FindTheWeldedBeamsOptimumWithItsConstraints) {
  const auto problem = welded_beam();
  for (const auto& [optimiser, changes, most] :
       {std::tuple<std::string, Changes, std::size_t>{"nlopt", {{"algorithm", "slsqp"}}, 60},
        {"nlopt", {{"algorithm", "mma"}, {"evaluations", std::int64_t{3000}}}, 3000},
        {"nlopt", {{"algorithm", "ccsaq"}, {"evaluations", std::int64_t{3000}}}, 3000},
        {"ipopt", {}, 60}}) {
    const Outcome outcome = solve(optimiser, problem, changes, {kBeam});
    const std::string who = optimiser + (changes.empty() ? "" : " " + to_text(changes[0].second));
    EXPECT_EQ(best_status(outcome), Status::feasible) << who;
    EXPECT_NEAR(best_value(outcome), 1.7248523, 1e-6) << who;
    EXPECT_LE(outcome.table.size(), most) << who;
    ASSERT_EQ(outcome.result.starts.size(), 1u);
    EXPECT_LT(outcome.result.starts[0].optimality, most == 60 ? 1e-6 : 1e-3) << who;
  }
}

TEST(Solvers, FindACornerExactly) {
  const auto problem = corner();
  for (const std::string algorithm :
       {"slsqp", "mma", "ccsaq", "lbfgs", "bobyqa", "sbplx", "crs2", "direct_l", "mlsl"}) {
    const Outcome outcome = solve("nlopt", problem, {{"algorithm", algorithm}, {"evaluations", std::int64_t{3000}}},
                                  {{0.5, 0.5, 0.5, 0.5}});
    EXPECT_NEAR(best_value(outcome), 1, algorithm == "crs2" ? 1e-3 : 1e-9) << algorithm;
  }
  const Outcome outcome = solve("ipopt", problem, {}, {{0.5, 0.5, 0.5, 0.5}});
  EXPECT_EQ(best_value(outcome), 1);  // on the bounds themselves, where Ipopt only comes near
  EXPECT_EQ(outcome.result.reason, StopReason::tolerance);
}

TEST(Solvers, SearchGloballyWithoutDerivatives) {
  const auto problem = welded_beam();
  const Outcome outcome =
      solve("nlopt", problem, {{"algorithm", "isres"}, {"evaluations", std::int64_t{30000}}}, {kBeam});
  EXPECT_EQ(best_status(outcome), Status::feasible);
  EXPECT_NEAR(best_value(outcome), 1.7249, 0.02);
  EXPECT_TRUE(std::isnan(outcome.result.starts[0].optimality));
  for (const std::string inner : {"lbfgs", "bobyqa"}) {
    const Outcome around = solve(
        "nlopt", problem, {{"algorithm", "auglag"}, {"inner", inner}, {"evaluations", std::int64_t{20000}}}, {kBeam});
    EXPECT_EQ(best_status(around), Status::feasible) << inner;
    EXPECT_NEAR(best_value(around), 1.7249, 0.02) << inner;
  }
}

TEST(Solvers, WithoutGradientsEvaluateNone) {
  const FunctionProblem problem(box(2, 0, 1), 0, [](std::span<const double> x, std::span<double>) {
    return (x[0] - 0.25) * (x[0] - 0.25) + (x[1] - 0.5) * (x[1] - 0.5);  // has no derivatives to give
  });
  const Outcome outcome = solve("nlopt", problem, {{"algorithm", "bobyqa"}}, {{0.9, 0.9}});
  EXPECT_NEAR(best_value(outcome), 0, 1e-12);
  EXPECT_TRUE(outcome.table.slopes.empty());
}

TEST(Solvers, EveryStartHasItsOwnEvaluations) {
  const auto problem = two_valleys();
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
      const bool elsewhere = start.message.ends_with("; ended worse than a design on the way, which is kept");
      EXPECT_TRUE(elsewhere || start.optimality < 1e-6) << start.message << start.optimality;
      const double x = outcome.table.designs[static_cast<std::size_t>(start.end_row)];
      left = left || x < 0;
      right = right || x > 0;
    }
    EXPECT_EQ(static_cast<std::size_t>(next), outcome.table.size());
    EXPECT_TRUE(left && right);
    EXPECT_EQ(starts[0].origin, "given");
    EXPECT_EQ(starts[2].origin, "Sobol point 1");
    EXPECT_EQ(outcome.table.designs[0], -0.7);  // its own bits
    EXPECT_NEAR(best_value(outcome), 0, 1e-15);
  }
}

TEST(Solvers, StopAtTheirLimitAndSayWhichOne) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome few = solve(optimiser, problem, {{"evaluations", std::int64_t{5}}}, {kBeam});
    EXPECT_EQ(few.table.size(), 5u);
    EXPECT_EQ(few.result.starts[0].stop, "evaluation limit");
    EXPECT_EQ(few.result.reason, StopReason::evaluations);
    const Outcome brief = solve(optimiser, problem, {{"time", 0.0}, {"multistart", std::int64_t{2}}}, {kBeam});
    EXPECT_EQ(brief.table.size(), 3u);  // every start is evaluated
    EXPECT_EQ(brief.result.starts[2].stop, "time limit");
    EXPECT_EQ(brief.result.reason, StopReason::time);
  }
}

TEST(Solvers, KeepTheStartWhereItIsTheBest) {
  const auto problem = corner();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, problem, {}, {{0, 1, 1, 1}});
    EXPECT_EQ(outcome.result.best_row, 0);
    EXPECT_EQ(best_value(outcome), 1);
    EXPECT_EQ(outcome.result.starts[0].optimality, 0);
  }
}

TEST(Solvers, AnInfeasibleProblemKeepsTheLeastViolationSeen) {
  const auto problem = infeasible_everywhere();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, problem, {{"evaluations", std::int64_t{200}}}, {{1.2, 1.0}});
    EXPECT_EQ(best_status(outcome), Status::infeasible);
    EXPECT_LE(violation(outcome.table.margin_row(static_cast<std::size_t>(outcome.result.best_row))), 0.54);
  }
}

TEST(Solvers, DoNotConvergeWhereNothingCanBeEvaluated) {
  const FunctionProblem nowhere(box(1, -2, -1), 0, [](auto x, auto) { return sqrt(x[0]); });
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, nowhere, {{"evaluations", std::int64_t{200}}}, {{-1.5}});
    EXPECT_EQ(best_status(outcome), Status::failed);
    EXPECT_EQ(outcome.result.starts[0].stop, "failed") << optimiser;
    if (optimiser == "nlopt") {  // which takes it for an optimum
      EXPECT_EQ(outcome.result.starts[0].message, "none of its designs could be evaluated");
    }
  }
}

/// Throws at the evaluation of row `at`.
class Throwing final : public Evaluator {
 public:
  explicit Throwing(std::size_t at) : at_(at) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override {
    if (table.size() > at_) throw std::runtime_error("the evaluator broke");
    ParallelEvaluator(1).evaluate(problem, table, first);
  }

 private:
  std::size_t at_;
};

TEST(Solvers, AnExceptionGetsThroughTheLibraries) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"})
    for (const std::size_t at : {std::size_t{0}, std::size_t{3}}) {
      Throwing evaluator(at);
      try {
        run(*make(entry(optimiser), problem), problem, 1, 1 << 30, &evaluator, {kBeam});
        ADD_FAILURE() << optimiser << ": nothing thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "the evaluator broke");
      }
    }
}

TEST(Solvers, ALeftPathBeginsItsStartAnew) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const auto stage = make(entry(optimiser), problem, {{"multistart", std::int64_t{2}}});
    const Outcome straight = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
    const std::int64_t in_second = straight.result.starts[1].first_row + 7;
    Outcome stopped = run(*stage, problem, 4, in_second, nullptr, {kBeam});
    ASSERT_EQ(stopped.recorder.starts.size(), 1u);
    // As if another processor had rounded otherwise: the fifth point of the second start differs in one bit.
    double& x = stopped.table.designs[static_cast<std::size_t>(straight.result.starts[1].first_row + 4) * 4];
    x = std::nextafter(x, 1e9);
    const Outcome again = resume(*stage, problem, 4, stopped, 1 << 30, {kBeam});
    EXPECT_TRUE(same_bits(straight.table, again.table)) << optimiser;
    EXPECT_TRUE(same_starts(straight.result.starts, again.result.starts)) << optimiser;
    ASSERT_EQ(again.recorder.warnings.size(), 1u);
    EXPECT_EQ(again.recorder.warnings[0],
              "Start 2 (Sobol point 1) left the path on record, as solvers may on another processor; it began anew.");
    EXPECT_TRUE(resume(*stage, problem, 4, run(*stage, problem, 4, in_second, nullptr, {kBeam}), 1 << 30, {kBeam})
                    .recorder.warnings.empty());
  }
}

TEST(Solvers, SideBySideIsTheSameAsOneAfterTheOther) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const auto stage = make(entry(optimiser), problem, {{"multistart", std::int64_t{6}}});
    const Outcome straight = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
    for (const int threads : {2, 3, 7}) {
      ParallelEvaluator parallel(threads);
      with_team(threads, [&] {
        EXPECT_TRUE(same_bits(straight, run(*stage, problem, 4, 1 << 30, &parallel, {kBeam})))
            << optimiser << ", " << threads << " threads";
      });
    }
  }
}

/// Takes its time, so that starts are at work at once.
class Slow final : public Evaluator {
 public:
  explicit Slow(int threads) : inner_(threads) {}
  void evaluate(const Problem& problem, EvaluationTable& table, std::size_t first) override {
    std::this_thread::sleep_for(std::chrono::microseconds(300));
    inner_.evaluate(problem, table, first);
  }

 private:
  ParallelEvaluator inner_;
};

TEST(Solvers, WhatOtherStartsHadFoundIsNotLostByAStop) {
  const auto problem = welded_beam();
  const auto stage = make(entry("nlopt"), problem, {{"multistart", std::int64_t{6}}});
  const Outcome straight = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
  std::size_t most_ahead = 0;
  for (const std::int64_t last : {0, 5, 20, 60, 90}) {
    Slow parallel(3);
    Outcome stopped;
    with_team(3, [&] { stopped = run(*stage, problem, 4, last, &parallel, {kBeam}); });
    ASSERT_EQ(stopped.result.reason, StopReason::interrupted);
    for (const StartAhead& start : stopped.result.ahead) {
      most_ahead = std::max(most_ahead, start.table.size());
      const StartOutcome& end = straight.result.starts[static_cast<std::size_t>(start.number)];
      ASSERT_LE(static_cast<std::int64_t>(start.table.size()), end.rows);
      EXPECT_TRUE(
          same_bits(start.table, straight.table.slice(static_cast<std::size_t>(end.first_row),
                                                      static_cast<std::size_t>(end.first_row) + start.table.size())));
      if (start.outcome) {
        EXPECT_EQ(start.outcome->rows, end.rows);
      }
    }
    const Outcome again = resume(*stage, problem, 4, stopped, 1 << 30, {kBeam});
    EXPECT_TRUE(same_bits(straight, again)) << "stopped after " << last;
    // Stopped again before anything is new: what is known stays known.
    const Outcome twice = resume(*stage, problem, 4, stopped, 0, {kBeam});
    EXPECT_GE(twice.result.ahead.size(), stopped.result.ahead.size());
    EXPECT_TRUE(same_bits(straight, resume(*stage, problem, 4, twice, 1 << 30, {kBeam})));
  }
  EXPECT_GT(most_ahead, 0u);
}

TEST(Solvers, EndedStartsAreTakenFromTheRecordAsTheyAre) {
  // A start that the clock ended cannot be repeated; what it came to is on record and stays.
  const auto problem = welded_beam();
  const auto stage = make(entry("nlopt"), problem, {{"time", 1e-9}, {"multistart", std::int64_t{3}}});
  const Outcome straight = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
  const auto unhurried = make(entry("nlopt"), problem, {{"multistart", std::int64_t{3}}});
  Outcome ended = straight;
  ended.recorder.starts = straight.result.starts;
  EXPECT_TRUE(
      same_starts(resume(*unhurried, problem, 4, ended, 1 << 30, {kBeam}).result.starts, straight.result.starts));
}

TEST(Solvers, AHigherLimitGoesOnWhereTheLowerOneStopped) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Changes starts = {{"multistart", std::int64_t{2}}};
    Changes few = starts;
    few.emplace_back("evaluations", std::int64_t{9});
    Outcome limited = solve(optimiser, problem, few, {kBeam}, 4);
    ASSERT_EQ(limited.table.size(), 27u);
    limited.recorder.starts = limited.result.starts;
    const auto stage = make(entry(optimiser), problem, starts);
    const Outcome straight = run(*stage, problem, 4, 1 << 30, nullptr, {kBeam});
    EXPECT_TRUE(same_bits(straight, resume(*stage, problem, 4, limited, 1 << 30, {kBeam}))) << optimiser;
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

TEST(Solvers, IpoptReadsNoOptionFile) {
  const auto problem = corner();
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(std::filesystem::temp_directory_path());
  std::ofstream("ipopt.opt") << "max_iter 1\n";
  const Outcome outcome = solve("ipopt", problem, {}, {{0.5, 0.5, 0.5, 0.5}});
  std::filesystem::remove("ipopt.opt");
  std::filesystem::current_path(before);
  EXPECT_EQ(best_value(outcome), 1);
}

std::string refusal(const std::string& optimiser, const Changes& changes) {
  try {
    make(entry(optimiser), corner(), changes);
    return "";
  } catch (const std::invalid_argument& reason) {
    return reason.what();
  }
}

TEST(Solvers, RefuseOptionsThatTheirLibraryDoesNotTake) {
  const auto ipopt = [](const std::string& name, const Setting& value) {
    return refusal("ipopt", {{"options", NamedSettings{{name, value}}}});
  };
  EXPECT_EQ(ipopt("tol", 1e-10), "");
  EXPECT_EQ(ipopt("mu_strategy", "monotone"), "");
  EXPECT_EQ(ipopt("acceptable_iter", std::int64_t{0}), "");
  EXPECT_EQ(ipopt("acceptable_iter", 0.5),
            "Ipopt's option acceptable_iter = 0.5, which must be an integer in Ipopt's range for it");
  EXPECT_EQ(ipopt("max_soc", std::int64_t{4}), "");
  EXPECT_EQ(ipopt("max_soc", std::int64_t{4294967300}),  // 4 in 32 bits
            "Ipopt's option max_soc = 4294967300, which must be an integer in Ipopt's range for it");
  EXPECT_EQ(ipopt("tolerance", 1e-10), "Ipopt has no option 'tolerance'");
  EXPECT_EQ(ipopt("mu_stratgy", "adaptive"), "Ipopt has no option 'mu_stratgy'; did you mean 'mu_strategy'?");
  EXPECT_EQ(ipopt("tol", -1.0), "Ipopt's option tol = -1, which must be a number in Ipopt's range for it");
  EXPECT_EQ(ipopt("mu_strategy", "fast"),
            "Ipopt's option mu_strategy = \"fast\", which must be one of Ipopt's words for it");
  EXPECT_EQ(ipopt("max_iter", std::int64_t{5}), "Ipopt's option max_iter is set by the stage and cannot be changed");
  EXPECT_THAT(refusal("nlopt", {{"population", std::int64_t{30}}}),
              HasSubstr("population = 30 for the algorithm slsqp, which has none; those with a population are isres"));
}

TEST(Optimality, NonNegativeLeastSquares) {
  // x free in the first component, at 0 in the second
  const auto x = non_negative_least_squares({{1, 0, 0}, {0, 1, 0}}, {2, -3, 5});
  EXPECT_DOUBLE_EQ(x[0], 2);
  EXPECT_EQ(x[1], 0);
  // dependent columns: any split will do, the fit is exact
  const auto twice = non_negative_least_squares({{1, 1}, {2, 2}, {0, 1}}, {3, 4});
  EXPECT_NEAR(twice[0] + 2 * twice[1], 3, 1e-14);
  EXPECT_NEAR(twice[2], 1, 1e-14);
  EXPECT_TRUE(non_negative_least_squares({}, {1, 2}).empty());
}

TEST(Optimality, MultipliersAreWhatRelaxingGains) {
  // max x + 2y with 1 - x - y >= 0 on [0, 1]^2: at (0, 1), where relaxing the margin by e gains... nothing: y <= 1
  // holds
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
  const Optimality found = optimality(problem, std::as_const(table).design(0), table.slope_row(0));
  EXPECT_NEAR(found.optimality, 0, 1e-14);
  ASSERT_EQ(found.margins.size(), 1u);
  EXPECT_NEAR(found.margins[0].multiplier, 2, 1e-14);
  ASSERT_EQ(found.bounds.size(), 1u);
  EXPECT_EQ(found.bounds[0].variable, 0u);
  EXPECT_FALSE(found.bounds[0].upper);
  EXPECT_NEAR(found.bounds[0].multiplier, 1, 1e-14);  // a lower bound of -e: y gains e, x loses e

  table.design(0)[0] = 0.5;  // inside: the gradient is left, relative to the objective
  table.design(0)[1] = 0.25;
  ParallelEvaluator(1).evaluate(problem, table, 0);
  EXPECT_NEAR(optimality(problem, std::as_const(table).design(0), table.slope_row(0)).optimality, 4, 1e-14);
}

}  // namespace
}  // namespace pkm::test
