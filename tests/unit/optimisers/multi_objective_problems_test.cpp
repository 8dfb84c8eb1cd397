// Checks the known Pareto fronts of the test problems: their formulas, their published extents, and that no sampled
// design dominates them.
#include "tests/unit/optimisers/multi_objective_problems.hpp"

#include <gtest/gtest.h>

#include "engine/math/hypervolume.hpp"
#include "engine/math/random.hpp"

namespace pkm::test {
namespace {

std::vector<FrontProblem> all_problems() {
  std::vector<FrontProblem> all = unconstrained_problems();
  for (FrontProblem& known : constrained_problems()) all.push_back(std::move(known));
  return all;
}

TEST(MultiObjectiveProblems, FrontsSatisfyTheirFormulas) {
  const auto convex = [](double f) { return 1 - std::sqrt(f); };
  const auto concave = [](double f) { return 1 - f * f; };
  const auto disconnected = [](double f) { return 1 - std::sqrt(f) - f * std::sin(10 * kPi * f); };
  const std::vector<std::function<double(double)>> formulas = {convex, concave, disconnected, convex, concave};
  const std::vector<FrontProblem> problems = zdt_problems();
  ASSERT_EQ(problems.size(), formulas.size());
  for (std::size_t i = 0; i < problems.size(); ++i)
    for (std::size_t at = 0; at < problems[i].front.size(); at += 2)
      EXPECT_NEAR(problems[i].front[at + 1], formulas[i](problems[i].front[at]), 1e-14) << problems[i].name;
  const FrontProblem sphere = dtlz2();
  for (std::size_t at = 0; at < sphere.front.size(); at += 3)
    EXPECT_NEAR(std::hypot(sphere.front[at], sphere.front[at + 1], sphere.front[at + 2]), 1, 1e-14);
}

TEST(MultiObjectiveProblems, FrontsHaveThePublishedExtents) {
  const auto expect_extents = [](const FrontProblem& known, std::array<double, 2> first, std::array<double, 2> second,
                                 double accuracy) {
    for (const std::size_t end : {0, 1}) {
      EXPECT_NEAR(extent(known, 0)[end], first[end], accuracy) << known.name;
      EXPECT_NEAR(extent(known, 1)[end], second[end], accuracy) << known.name;
    }
  };
  const std::vector<FrontProblem> problems = zdt_problems();
  expect_extents(problems[0], {0, 1}, {0, 1}, 0);
  expect_extents(problems[2], {0, 0.8518328654}, {-0.7733690, 1}, 1e-3);  // within the sampling step
  expect_extents(problems[4], {0.2807753191, 1}, {0, 0.9211652}, 1e-5);
  expect_extents(bnh(), {0, 136}, {4, 50}, 0);
  expect_extents(srn(), {10.1, 223}, {-217.74, 2.61}, 0.1);
  expect_extents(tnk(), {0.0416, 1.0384}, {0.0416, 1.0384}, 1e-3);
  expect_extents(osy(), {-274, -42}, {4, 76}, 1e-12);
}

TEST(MultiObjectiveProblems, NoDesignDominatesAKnownFront) {
  for (const FrontProblem& known : all_problems()) {
    const std::size_t objectives = known.objectives();
    const std::vector<double> reference = reference_point(known);
    const double front = hypervolume(known.front, objectives, reference);
    std::vector<double> with_designs = known.front;
    Scratch scratch;
    EvaluationTable table(known.problem.shape());
    table.extend(1);
    for (std::uint32_t i = 0; i < 20000; ++i) {
      Stream stream(1, 0, i, Stream::Use::start);
      std::vector<double> design(known.problem.space().dimension());
      for (std::size_t k = 0; k < design.size(); ++k) design[k] = known.problem.space().from_unit(k, stream.u01());
      known.problem.evaluate(design, scratch, table.slot(0));
      if (table.status[0] != Status::feasible) continue;
      for (std::size_t at = 0; at < known.front.size(); at += objectives) {
        bool dominated = true;
        for (std::size_t k = 0; k < objectives; ++k) dominated = dominated && table.objectives[k] < known.front[at + k];
        ASSERT_FALSE(dominated) << known.name << ", design " << i;
      }
      with_designs.insert(with_designs.end(), table.objectives.begin(), table.objectives.end());
    }
    // Designs between the samples of the front may add a little hypervolume.
    EXPECT_NEAR(hypervolume(with_designs, objectives, reference), front, 0.01 * front) << known.name;
  }
}

}  // namespace
}  // namespace pkm::test
