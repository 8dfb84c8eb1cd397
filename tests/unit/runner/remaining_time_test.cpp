// Tests of RemainingTime with simulated times.
#include "engine/runner/remaining_time.hpp"

#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

Study study_of_text(const std::string& stages) {
  return read_study_toml(
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.2, max = 0.3 }\nb = { min = 0.8, max = 1.0 }\n"
      "[[objective]]\ntype = \"workspace-volume\"\n" +
          stages,
      "s.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}
const std::string kSearch = "[[stage]]\noptimiser = \"ga\"\npopulation = 10\ngenerations = 99\n";  // 1000 evaluations
const std::string kSolver = "[[stage]]\noptimiser = \"nlopt\"\nstart = \"none\"\nevaluations = 100\nmultistart = 3\n";

TEST(RemainingTime, IncludesLaterStagesAndFinalSteps) {
  const RunCost cost{
      .plain = 0.01, .with_derivatives = 0.1, .final_steps = 2, .long_steps = {{"a step", 4}, {"another", 1}}};
  const Study s = study_of_text(kSearch + kSolver);
  const std::int64_t limit = s.stages[1].optimiser->evaluation_limit(*s.problem);
  RemainingTime remaining(s, cost, 1);
  EXPECT_FALSE(remaining.update(0, 990, 10, 0.1));  // too early for an estimate
  const auto found = remaining.update(0, 800, 200, 2);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 800 * 0.01 + 0.1 * static_cast<double>(limit) + 7, 1e-9);
}

TEST(RemainingTime, IsWithinAFactorOfTwoIfEvaluationsBecomeSlower) {
  RemainingTime remaining(study_of_text(kSearch), {.plain = 1e-3, .with_derivatives = 0, .final_steps = 3}, 1);
  double seconds = 0;
  std::vector<double> at(1001);
  for (int i = 1; i <= 1000; ++i) at[static_cast<std::size_t>(i)] = seconds += i < 300 ? 0.01 : 0.018;
  const double end = seconds + 3;
  for (int i = 10; i <= 1000; i += 10) {
    const double now = at[static_cast<std::size_t>(i)];
    const auto found = remaining.update(0, 1000 - i, i, now);
    if (now < 2) continue;
    ASSERT_TRUE(found);
    EXPECT_GT(*found, 0.5 * (end - now)) << i;
    EXPECT_LT(*found, 2 * (end - now)) << i;
  }
}

TEST(RemainingTime, OfASolverStageNeverIncreases) {
  const RunCost cost{.plain = 1e-3, .with_derivatives = 1e-3, .final_steps = 0.1};
  RemainingTime remaining(study_of_text(kSolver), cost, 1);
  double seconds = 0, last = 1e30;
  for (int made = 1; made <= 300; ++made) {
    seconds += made < 120 ? 0.02 : 0.06;  // evaluations become slower
    const auto found = remaining.update(0, 300 - made, made, seconds);
    if (!found) continue;
    EXPECT_LE(*found, last) << made;
    last = *found;
  }
  EXPECT_LT(last, 1);
}

TEST(RemainingTime, IgnoresReplayedEvaluations) {
  RemainingTime remaining(study_of_text(kSearch), {}, 1);
  for (int i = 1; i <= 50; ++i) EXPECT_FALSE(remaining.update(0, 1000 - 10 * i, 0, 0.1 * i));  // 5 s of replay
  remaining.update(0, 490, 10, 6);
  const auto found = remaining.update(0, 480, 20, 7);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 480 * 0.1, 1e-9);
}

}  // namespace
}  // namespace pkm
