// Derivatives of what columns of files sample, against differences of the same sums. Against those of the built-in
// mechanisms: papers_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/contracts/catalogue_problem.hpp"
#include "tests/unit/contracts/derivative_comparison.hpp"

namespace pkm {
namespace {

/// What is asked of the samples of a file's columns.
struct Samples {
  const Mechanism& mechanism;
  std::unique_ptr<const WorkspaceEvaluator> evaluator;
  std::vector<PoseStatistic> statistics;
  Scratch scratch = {};

  Samples(const Mechanism& of, const WorkspacePlan& plan)
      : mechanism(of), evaluator(prepare_workspace(of, plan, test::request_of_all_fields(of))) {
    if (test::is_available(of, kConditioning))
      for (const char* const statistic : {"mean", "min"}) statistics.push_back({kConditioning, statistic});
    if (!of.dynamics()) return;
    for (const char* const statistic : {"mean", "std", "max"}) statistics.push_back({kCouplingIndex, statistic, "1"});
    statistics.push_back({kCouplingIndex, "mean", "mean"});
    statistics.push_back({kInertiaCondition, "mean"});
  }

  std::vector<Dual4> at(const std::vector<Dual4>& design) {
    WorkspaceResult<Dual4> found;
    evaluator->gradients()->evaluate(design, scratch, found);
    std::vector<Dual4> all;
    for (const PoseStatistic& statistic : statistics) all.push_back(statistic(found, scratch));
    return all;
  }
};

class SampleSlopes : public ::testing::TestWithParam<std::string> {
 protected:
  const Mechanism& mechanism() const { return *test::described(GetParam()); }
  const MechanismInfo& info() const { return mechanism().info(); }
  WorkspacePlan plan(Stream& random) const {
    WorkspacePlan plan = test::columns(info());
    plan.limits = test::random_limits(info(), random);
    return plan;
  }
};

TEST_P(SampleSlopes, EqualDifferencesOfTheSameSums) {
  int compared = 0, excluded = 0;
  for (unsigned k = 0; k < 3; ++k) {
    Stream random(1, 0, k, Stream::Use::start);
    const WorkspacePlan limited = plan(random);
    const std::vector<double> design = k == 0 ? test::nominal(info()) : test::random_design(info(), random);
    Samples samples(mechanism(), limited);
    std::vector<double> direction;
    for (const double p : design) direction.push_back((2 * random.u01() - 1) * p);
    const auto moved = [&](double t) {
      std::vector<Dual4> all(design.begin(), design.end());
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = Dual4(design[i] + t * direction[i]);
      return all;
    };
    std::vector<Dual4> moving = moved(0);
    for (std::size_t i = 0; i < moving.size(); ++i) moving[i].v[0] = direction[i];
    const std::vector<Dual4> slopes = samples.at(moving);
    std::vector<double> scale;
    for (const Dual4& slope : slopes) scale.push_back(std::fabs(slope.v[0]) + 0.1 * std::fabs(slope.a));
    const auto found = test::differences(
        [&](double t) {
          std::vector<double> values;
          for (const Dual4& value : samples.at(moved(t))) values.push_back(value.a);
          return values;
        },
        scale);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      if (!found[i]) {
        ++excluded;
        continue;
      }
      ++compared;
      EXPECT_NEAR(slopes[i].v[0], *found[i], 1e-6 * scale[i]) << "design " << k << ", quantity " << i;
    }
  }
  // Where indices have kinks at samples, steps do not agree.
  EXPECT_GT(compared, 7);
  EXPECT_LT(excluded, compared);
}

/// In whatever pass, and after whatever survey with the same scratch.
TEST_P(SampleSlopes, HaveTheBitsOfSurveysWithoutThem) {
  Stream random(2, 0, 0, Stream::Use::start);
  const std::vector<double> design = test::random_design(info(), random);
  FieldRequest request = test::request_of_all_fields(mechanism());
  request.poses = true;
  const auto evaluator = prepare_workspace(mechanism(), test::columns(info()), request);
  Scratch scratch;
  WorkspaceResult<double> plain, values;
  evaluator->evaluate(design, scratch, plain);
  ASSERT_FALSE(plain.weight.empty());
  std::vector<double> first;
  for (const int component : {0, 3, 0}) {
    std::vector<Dual4> moving(design.begin(), design.end());
    moving[0].v[component] = moving[1].v[3 - component] = 1;
    WorkspaceResult<Dual4> found;
    evaluator->gradients()->evaluate(moving, scratch, found);
    copy_values(found, values);
    EXPECT_EQ(values.volume, plain.volume);
    EXPECT_EQ(values.weight, plain.weight);
    EXPECT_EQ(values.pose, plain.pose);
    EXPECT_EQ(values.fields, plain.fields);
    std::vector<double> slopes;
    for (const Dual4& weight : found.weight) slopes.push_back(weight.v[component]);
    if (first.empty()) first = slopes;
    EXPECT_EQ(slopes, first);
    if (component == 3) evaluator->evaluate(test::nominal(info()), scratch, values);
  }
}

INSTANTIATE_TEST_SUITE_P(Files, SampleSlopes,
                         ::testing::Values("3-rpr", "3-rrr", "3crr-r-cru", "4ppa-2par", "orthoglide"),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
