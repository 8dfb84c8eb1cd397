// Laws of the slopes of every objective and every design-level constraint of the catalogues, with every mechanism whose
// surveys have derivatives. A new entry is tested without a change here.
#include <algorithm>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/contracts/everything.hpp"
#include "tests/unit/contracts/slopes.hpp"

namespace pkm {
namespace {

/// Random designs: 1000 in the campaign.
const unsigned kDesigns = [] {
  const char* const asked = std::getenv("PKM_SLOPE_DESIGNS");
  return asked ? static_cast<unsigned>(std::stoul(asked)) : 100U;
}();

class SlopeContract : public testing::TestWithParam<std::shared_ptr<const Mechanism>> {
 protected:
  void SetUp() override {
    if (!GetParam()->columns()) GTEST_SKIP() << "voxels have no derivatives";
    const auto surveyor = prepare_survey(*GetParam(), plan(), {});
    if (!surveyor->slopes()) GTEST_SKIP() << surveyor->why_no_slopes();
  }
  const MechanismInfo& info() const { return GetParam()->info(); }
  SurveyPlan plan(const ColumnOptions& columns = {}) const { return test::columns(info(), columns); }

  /// Compares random designs with a workspace under random limits.
  void compare(SurveyPlan p, test::Of of, double excluded, unsigned designs = kDesigns, double exact = 1e-7) const {
    test::SlopeComparison comparison(exact);
    unsigned compared = 0;
    for (unsigned k = 0; compared < designs && k < 4 * designs; ++k) {
      Stream random(1, 0, k, Stream::Use::start);
      p.limits = test::random_limits(info(), random);
      const std::vector<double> design = test::random_design(info(), random);
      if (!(test::survey(*GetParam(), design, p).volume > 0)) continue;
      std::vector<double> direction;
      for (std::size_t i = 0; i < design.size(); ++i) direction.push_back(2 * random.u01() - 1);
      SCOPED_TRACE("design " + std::to_string(k));
      comparison.compare(test::everything(GetParam(), p, of), design, direction);
      ++compared;
    }
    comparison.expect(static_cast<int>(designs), excluded);
  }
};

TEST_P(SlopeContract, VolumesAndMarginsEqualDifferencesOfTheExactRule) {
  compare(plan({.tolerance = 1e-13}), test::Of::volume, 0.005);  // what is left changes with the number of nodes
}

/// To 3e-7: where two breaks of the workspace nearly coincide, differences may agree and still see both at once.
TEST_P(SlopeContract, EveryQuantityEqualsDifferencesOfARuleWithFixedNodes) {
  // fewer samples, fewer kinks
  compare(plan({.nodes = {6, 6}}), test::Of::kinematics, 0.02, kDesigns, 3e-7);
}

/// Coupling indices have kinks wherever an off-diagonal element of M_q passes 0 at a sample, and there are hundreds of
/// samples. To 5e-6, because a break at which the integrand only changes its formula is not followed: the slope of the
/// integral is the same, that of a rule with few nodes differs by its error.
TEST_P(SlopeContract, QuantitiesOfInertiaEqualDifferences) {
  compare(plan({.nodes = {8, 8}}), test::Of::inertia, 0.6, std::max(4U, kDesigns / 80), 5e-6);
}

/// Designs and limits far beyond what is sensible, among them many without a workspace.
TEST_P(SlopeContract, AreFiniteEverywhereAndZeroWithoutAWorkspace) {
  int empty = 0, usable = 0;
  for (unsigned k = 0; k < 2 * kDesigns; ++k) {
    SCOPED_TRACE("design " + std::to_string(k));
    Stream random(2, 0, k, Stream::Use::start);
    SurveyPlan p = plan({.nodes = {3, 3}});
    p.limits = test::random_limits(info(), random);
    const LimitSpec absurd = test::absurd_limits(info());
    for (std::size_t i = 0; i < info().limits.size(); ++i)  // some at one end of their range or the other
      if (random.chance(0.1) && test::has_slopes(info().limits[i]))
        p.limits.given[i] = random.chance(0.5) ? info().limits[i].inactive : *absurd.given[i];
    std::vector<double> design = test::nominal(info());
    for (std::size_t i = 0; i < design.size(); ++i) {
      const Parameter& of = info().parameters[i];
      if (random.chance(0.2)) continue;  // round numbers meet each other
      design[i] = std::clamp(design[i] * 3 * random.u01(), of.lower, of.upper);
    }
    const DesignProblem problem =
        test::everything(GetParam(), p, k % 50 == 0 ? test::Of::inertia : test::Of::kinematics);
    const std::vector<double> slopes = problem.slopes(design, problem.parts().varies);
    for (std::size_t i = 0; i < slopes.size(); ++i) {
      const std::size_t row = i / (1 + design.size()), objectives = problem.objectives().size();
      ASSERT_TRUE(std::isfinite(slopes[i]))
          << (row < objectives ? problem.objectives()[row].name : problem.margins()[row - objectives].name);
    }
    const bool none = test::survey(*GetParam(), design, p).volume == 0;
    ++(none ? empty : usable);
    if (none) {
      const std::size_t width = 1 + design.size();
      for (std::size_t i = 0; i < problem.objectives().size() * width; ++i)
        EXPECT_EQ(i % width == 0 ? 0 : slopes[i], 0) << problem.objectives()[i / width].name;
    }
  }
  EXPECT_GT(empty, static_cast<int>(kDesigns / 10));
  EXPECT_GT(usable, static_cast<int>(kDesigns / 20));
}

TEST_P(SlopeContract, SurveysWithDerivativesHaveTheBitsOfThoseWithout) {
  for (unsigned k = 0; k < 100; ++k) {
    SCOPED_TRACE("design " + std::to_string(k));
    Stream random(3, 0, k, Stream::Use::start);
    SurveyPlan p = k % 4 == 3 ? plan({.nodes = {5, 7}}) : plan();
    p.limits = test::random_limits(info(), random);
    const std::vector<double> design = test::random_design(info(), random);
    const auto surveyor = prepare_survey(*GetParam(), p, test::no_inertia(*GetParam()));
    Scratch scratch;
    Survey<double> plain, values;
    surveyor->survey(design, scratch, plain);
    std::vector<Dual4> moving(design.begin(), design.end());
    for (int i = 0; i < 4; ++i) moving[static_cast<std::size_t>(i)].v[i] = 1;
    Survey<Dual4> survey;
    surveyor->slopes()->survey(moving, scratch, survey);
    copy_values(survey, values);
    EXPECT_EQ(values.volume, plain.volume);
    EXPECT_EQ(values.columns, plain.columns);
    EXPECT_EQ(values.error, plain.error);
    EXPECT_EQ(values.weight, plain.weight);
    EXPECT_EQ(values.of(kConditioning), plain.of(kConditioning));
  }
}

/// What an optimiser gets, with and without slopes.
TEST_P(SlopeContract, EvaluationsWithSlopesHaveTheBitsOfThoseWithout) {
  for (unsigned k = 0; k < 30; ++k) {
    Stream random(4, 0, k, Stream::Use::start);
    SurveyPlan p = plan({.nodes = {4, 4}});
    p.limits = test::random_limits(info(), random);
    const DesignProblem problem = test::everything(GetParam(), p);
    const std::vector<double> design = test::random_design(info(), random);
    EvaluationTable plain(problem.shape(Detail::complete)), sloped(problem.shape(Detail::derivatives));
    Scratch scratch;
    for (EvaluationTable* table : {&plain, &sloped}) {
      table->extend(1);
      problem.evaluate(design, scratch, table->slot(0));
    }
    EXPECT_EQ(sloped.status, plain.status);
    EXPECT_EQ(sloped.objectives, plain.objectives);
    EXPECT_EQ(sloped.margins, plain.margins);
    EXPECT_EQ(sloped.slopes, problem.slopes(design, problem.parts().varies));
    // one parameter at a time, so that each is in another place of its pass
    const std::size_t width = 1 + design.size();
    for (std::size_t i = 0; i < design.size(); ++i) {
      const std::vector<double> alone = problem.slopes(design, std::vector<std::size_t>{i});
      for (std::size_t q = 0; 2 * q < alone.size(); ++q) {
        EXPECT_EQ(alone[2 * q], sloped.slopes[q * width]);
        EXPECT_EQ(alone[2 * q + 1], sloped.slopes[q * width + 1 + i]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, SlopeContract, testing::ValuesIn(test::mechanisms()),
                         [](const auto& mechanism) { return test::test_name(mechanism.param->info().name); });

}  // namespace
}  // namespace pkm
