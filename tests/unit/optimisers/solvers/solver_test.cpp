// NLopt and Ipopt as stages: optima, limits, what is kept, what is refused.
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

/// A gradient of 0 is compared with a difference before it counts as convergence.
TEST(Solvers, DoNotConvergeWhereAGradientOfZeroIsWrong) {
  const auto f = [](auto x) { return x[0] + 2.0 * x[1] + 3.0; };
  const FunctionProblem wrong(box(2, 0, 1), 0, [f](auto x, auto) { return decltype(x[0] + 0.0)(value_of(f(x))); });
  for (const std::string optimiser : {"nlopt", "ipopt"}) {
    const Outcome outcome = solve(optimiser, wrong, {}, {{0.5, 0.5}});
    EXPECT_EQ(outcome.result.starts[0].stop, "failed") << optimiser;
    EXPECT_EQ(outcome.result.starts[0].message, "the gradient is 0 at the start, but the objective changes beside it");
    EXPECT_TRUE(std::isnan(outcome.result.starts[0].optimality));
    EXPECT_EQ(outcome.result.starts[0].rows, static_cast<std::int64_t>(outcome.table.size()));
    EXPECT_GE(outcome.table.size(), 3u);
  }
  // stationary starts, and those on bounds, have converged
  const auto bowl = [](auto x, auto) { return (x[0] - 0.5) * (x[0] - 0.5) * (1.5 + x[0]) + x[1] * 0.0; };
  for (const FunctionProblem& problem : {FunctionProblem(box(2, 0, 1), 0, bowl),
                                         FunctionProblem(box(2, 0.5, 1), 0, [](auto x, auto) { return x[0] * 0.0; })}) {
    const Outcome outcome = solve("nlopt", problem, {{"algorithm", "slsqp"}}, {{0.5, 0.5}});
    EXPECT_EQ(outcome.result.starts[0].stop, words(StopReason::tolerance));
    EXPECT_EQ(outcome.result.starts[0].optimality, 0);
  }
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

}  // namespace
}  // namespace pkm::test
