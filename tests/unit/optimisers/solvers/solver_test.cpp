// Solver stages with NLopt and Ipopt: optima, limits, results and rejected options.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/unit/optimisers/solvers/solve.hpp"

namespace pkm::test {
namespace {

using ::testing::HasSubstr;

Status best_status(const Outcome& outcome) {
  return outcome.table.status[static_cast<std::size_t>(outcome.result.best_row)];
}

TEST(Solvers, FindTheConstrainedOptimumOfTheWeldedBeam) {
  const auto problem = welded_beam();
  for (const auto& [optimiser, changes, max_evaluations] :
       {std::tuple<std::string, Changes, std::size_t>{"nlopt", {{"algorithm", "slsqp"}}, 60},
        {"nlopt", {{"algorithm", "mma"}, {"evaluations", std::int64_t{3000}}}, 3000},
        {"nlopt", {{"algorithm", "ccsaq"}, {"evaluations", std::int64_t{3000}}}, 3000},
        {"ipopt", {}, 60}}) {
    const Outcome outcome = solve(optimiser, problem, changes, {kBeam});
    const std::string name = optimiser + (changes.empty() ? "" : " " + to_text(changes[0].second));
    EXPECT_EQ(best_status(outcome), Status::feasible) << name;
    EXPECT_NEAR(best_value(outcome), 1.7248523, 1e-6) << name;
    EXPECT_LE(outcome.table.size(), max_evaluations) << name;
    ASSERT_EQ(outcome.result.starts.size(), 1u);
    EXPECT_LT(outcome.result.starts[0].optimality, max_evaluations == 60 ? 1e-6 : 1e-3) << name;
  }
}

TEST(Solvers, FindACornerExactly) {
  const auto problem = corner_optimum();
  for (const std::string algorithm :
       {"slsqp", "mma", "ccsaq", "lbfgs", "bobyqa", "sbplx", "crs2", "direct_l", "mlsl"}) {
    const Outcome outcome = solve("nlopt", problem, {{"algorithm", algorithm}, {"evaluations", std::int64_t{3000}}},
                                  {{0.5, 0.5, 0.5, 0.5}});
    EXPECT_NEAR(best_value(outcome), 1, algorithm == "crs2" ? 1e-3 : 1e-9) << algorithm;
  }
  const Outcome outcome = solve("ipopt", problem, {}, {{0.5, 0.5, 0.5, 0.5}});
  EXPECT_EQ(best_value(outcome), 1);  // exactly on the bounds, which Ipopt only approaches
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
    const Outcome augmented = solve(
        "nlopt", problem, {{"algorithm", "auglag"}, {"inner", inner}, {"evaluations", std::int64_t{20000}}}, {kBeam});
    EXPECT_EQ(best_status(augmented), Status::feasible) << inner;
    EXPECT_NEAR(best_value(augmented), 1.7249, 0.02) << inner;
  }
}

TEST(Solvers, DerivativeFreeAlgorithmsEvaluateNoDerivatives) {
  const FunctionProblem problem(box(2, 0, 1), 0, [](std::span<const double> x, std::span<double>) {
    return (x[0] - 0.25) * (x[0] - 0.25) +
           (x[1] - 0.5) * (x[1] - 0.5);  // no derivatives: the function accepts doubles only
  });
  const Outcome outcome = solve("nlopt", problem, {{"algorithm", "bobyqa"}}, {{0.9, 0.9}});
  EXPECT_NEAR(best_value(outcome), 0, 1e-12);
  EXPECT_TRUE(outcome.table.derivatives.empty());
}

TEST(Solvers, StopAtTheirLimitAndReportIt) {
  const auto problem = welded_beam();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome limited = solve(optimiser, problem, {{"evaluations", std::int64_t{5}}}, {kBeam});
    EXPECT_EQ(limited.table.size(), 5u);
    EXPECT_EQ(limited.result.starts[0].stop, "evaluation limit");
    EXPECT_EQ(limited.result.reason, StopReason::evaluations);
    const Outcome timed = solve(optimiser, problem, {{"time", 0.0}, {"multistart", std::int64_t{2}}}, {kBeam});
    EXPECT_EQ(timed.table.size(), 3u);  // each start design is evaluated
    EXPECT_EQ(timed.result.starts[2].stop, "time limit");
    EXPECT_EQ(timed.result.reason, StopReason::time);
  }
}

TEST(Solvers, ReturnTheStartIfItIsTheBest) {
  const auto problem = corner_optimum();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, problem, {}, {{0, 1, 1, 1}});
    EXPECT_EQ(outcome.result.best_row, 0);
    EXPECT_EQ(best_value(outcome), 1);
    EXPECT_EQ(outcome.result.starts[0].optimality, 0);
  }
}

TEST(Solvers, ReturnTheSmallestViolationIfNothingIsFeasible) {
  const auto problem = infeasible_everywhere();
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, problem, {{"evaluations", std::int64_t{200}}}, {{1.2, 1.0}});
    EXPECT_EQ(best_status(outcome), Status::infeasible);
    EXPECT_LE(violation(outcome.table.margin_row(static_cast<std::size_t>(outcome.result.best_row))), 0.54);
  }
}

TEST(Solvers, FailIfAllEvaluationsFail) {
  const FunctionProblem failing(box(1, -2, -1), 0, [](auto x, auto) { return sqrt(x[0]); });
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, failing, {{"evaluations", std::int64_t{200}}}, {{-1.5}});
    EXPECT_EQ(best_status(outcome), Status::failed);
    EXPECT_EQ(outcome.result.starts[0].stop, "failed") << optimiser;
    if (optimiser == "nlopt") {  // which reports convergence
      EXPECT_EQ(outcome.result.starts[0].message, "all evaluations failed");
    }
  }
}

/// A zero gradient is compared with a finite difference before it counts as convergence.
TEST(Solvers, FailIfAZeroGradientIsWrong) {
  const auto f = [](auto x) { return x[0] + 2.0 * x[1] + 3.0; };
  const FunctionProblem wrong(box(2, 0, 1), 0, [f](auto x, auto) { return decltype(x[0] + 0.0)(value_of(f(x))); });
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, wrong, {}, {{0.5, 0.5}});
    EXPECT_EQ(outcome.result.starts[0].stop, "failed") << optimiser;
    EXPECT_EQ(outcome.result.starts[0].message,
              "the gradient is 0 at the start, but the objective is not constant around it");
    EXPECT_TRUE(std::isnan(outcome.result.starts[0].optimality));
    EXPECT_EQ(outcome.result.starts[0].rows, static_cast<std::int64_t>(outcome.table.size()));
    EXPECT_GE(outcome.table.size(), 3u);
  }
  // stationary starts, also on bounds, have converged
  const auto bowl = [](auto x, auto) { return (x[0] - 0.5) * (x[0] - 0.5) * (1.5 + x[0]) + x[1] * 0.0; };
  for (const FunctionProblem& problem : {FunctionProblem(box(2, 0, 1), 0, bowl),
                                         FunctionProblem(box(2, 0.5, 1), 0, [](auto x, auto) { return x[0] * 0.0; })}) {
    const Outcome outcome = solve("nlopt", problem, {{"algorithm", "slsqp"}}, {{0.5, 0.5}});
    EXPECT_EQ(outcome.result.starts[0].stop, words(StopReason::tolerance));
    EXPECT_EQ(outcome.result.starts[0].optimality, 0);
  }
}

TEST(Solvers, IpoptReadsNoOptionFile) {
  const auto problem = corner_optimum();
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(std::filesystem::temp_directory_path());
  std::ofstream("ipopt.opt") << "max_iter 1\n";
  const Outcome outcome = solve("ipopt", problem, {}, {{0.5, 0.5, 0.5, 0.5}});
  std::filesystem::remove("ipopt.opt");
  std::filesystem::current_path(before);
  EXPECT_EQ(best_value(outcome), 1);
}

std::string rejection(const std::string& optimiser, const Changes& changes) {
  try {
    make(entry(optimiser), corner_optimum(), changes);
    return "";
  } catch (const std::invalid_argument& reason) {
    return reason.what();
  }
}

TEST(Solvers, RejectInvalidLibraryOptions) {
  const auto ipopt = [](const std::string& name, const Setting& value) {
    return rejection("ipopt", {{"options", NamedSettings{{name, value}}}});
  };
  EXPECT_EQ(ipopt("tol", 1e-10), "");
  EXPECT_EQ(ipopt("mu_strategy", "monotone"), "");
  EXPECT_EQ(ipopt("acceptable_iter", std::int64_t{0}), "");
  EXPECT_EQ(ipopt("acceptable_iter", 0.5),
            "Ipopt's option acceptable_iter = 0.5 is invalid; expected an integer in the option's range");
  EXPECT_EQ(ipopt("max_soc", std::int64_t{4}), "");
  EXPECT_EQ(ipopt("max_soc", std::int64_t{4294967300}),  // 4 in 32 bits
            "Ipopt's option max_soc = 4294967300 is invalid; expected an integer in the option's range");
  EXPECT_EQ(ipopt("tolerance", 1e-10), "Ipopt has no option 'tolerance'");
  EXPECT_EQ(ipopt("mu_stratgy", "adaptive"), "Ipopt has no option 'mu_stratgy'; did you mean 'mu_strategy'?");
  EXPECT_EQ(ipopt("tol", -1.0), "Ipopt's option tol = -1 is invalid; expected a number in the option's range");
  EXPECT_EQ(ipopt("mu_strategy", "fast"),
            "Ipopt's option mu_strategy = \"fast\" is invalid; expected one of the option's values");
  EXPECT_EQ(ipopt("max_iter", std::int64_t{5}), "Ipopt's option max_iter is set by the stage and cannot be changed");
  EXPECT_THAT(rejection("nlopt", {{"population", std::int64_t{30}}}),
              HasSubstr("population = 30: the algorithm slsqp has no population; expected one of isres"));
}

}  // namespace
}  // namespace pkm::test
