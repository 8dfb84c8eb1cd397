// Statistics of failed evaluations by reason.
#include "engine/problem/failures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/config/real_studies.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;
using testing::read_real;

/// The objective fails for a < 0.25, the constraint for b > 0.9.
Study study() {
  return read_real(R"text([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.2, max = 0.3 }
b = { min = 0.8, max = 1.0 }
[[objective]]
type = "expression"
name = "root"
expression = "sqrt(a - 0.25)"
[[constraint]]
type = "expression"
name = "log_of_b"
expression = "log(0.9 - b)"
max = 0
[[stage]]
optimiser = "ga"
)text");
}

EvaluationTable evaluated(const Study& of, const std::vector<std::pair<double, double>>& designs) {
  EvaluationTable table(of.problem->shape());
  Scratch scratch;
  for (const auto& [a, b] : designs) {
    const std::size_t row = table.extend(1);
    table.design(row)[0] = a;
    table.design(row)[1] = b;
    of.problem->evaluate(table.design(row), scratch, table.slot(row));
  }
  return table;
}

TEST(Failures, AreCountedByReason) {
  const Study of = study();
  const EvaluationTable table =
      evaluated(of, {{0.3, 0.85}, {0.2, 0.85}, {0.21, 0.85}, {0.3, 0.95}, {0.22, 0.85}, {0.2, 0.96}});
  const Failures found = collect_failures({&table, &table}, of.problem.get());
  EXPECT_EQ(found.evaluations, 12u);
  EXPECT_EQ(found.failed, 10u);
  EXPECT_EQ(found.examined, 10u);
  ASSERT_EQ(found.reasons.size(), 2u);
  EXPECT_EQ(found.reasons[0].count + found.reasons[1].count, 10u);
  EXPECT_EQ(failures_text(found),
            "10 of 12 evaluations failed: 6 because, for example, root is not a finite number; 4 because, for example, "
            "log_of_b is not a finite number");
}

TEST(Failures, ReasonsThatDifferOnlyInNumbersAreMerged) {
  const Study of = read_real(R"([mechanism]
type = "3crr-r-cru"
[variables]
l_11 = { min = 0.01, max = 0.5 }
l_12 = { min = 0.01, max = 0.5 }
[[motion]]
name = "turn"
follow = false
type = "points"
points = [{ x = "160 mm", y = "160 mm", z = "200 mm", phi = 0 }, { x = "130 mm", phi = "60 deg", time = 1 }]
[[objective]]
type = "peak-force"
motion = "turn"
[[stage]]
optimiser = "ga"
)");
  const EvaluationTable table = evaluated(of, {{0.02, 0.02}, {0.03, 0.03}, {0.17, 0.225}, {0.04, 0.04}});
  const Failures found = collect_failures({&table}, of.problem.get());
  ASSERT_EQ(found.failed, 3u);
  ASSERT_EQ(found.reasons.size(), 1u);
  EXPECT_EQ(found.reasons[0].count, 3u);
  EXPECT_THAT(found.reasons[0].example,
              HasSubstr("peak-force: the motion turn leaves the reach of the mechanism at t = "));
}

TEST(Failures, AtMost64AreExamined) {
  const Study of = study();
  EvaluationTable table = evaluated(of, std::vector<std::pair<double, double>>(100, {0.2, 0.85}));
  EXPECT_EQ(collect_failures({&table}, of.problem.get()).examined, 64u);
  EXPECT_THAT(failures_text(collect_failures({&table}, of.problem.get())),
              HasSubstr("100 of 100 evaluations failed, of which 64 were examined: 64 because"));
  for (float& seconds : table.seconds) seconds = 0.6F;
  EXPECT_EQ(collect_failures({&table}, of.problem.get()).examined, 2u)
      << "slow evaluations are repeated for one second only";
  EXPECT_EQ(failures_text(collect_failures({&table}, nullptr)), "100 of 100 evaluations failed");
  EXPECT_EQ(failures_text(collect_failures({}, nullptr)), "");
}

}  // namespace
}  // namespace pkm
