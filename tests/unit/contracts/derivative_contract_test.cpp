// Contract of derivatives: every objective and design-level constraint of the catalogues, for every mechanism whose
// workspace analyses have derivatives. New catalogue entries are tested automatically.
#include <algorithm>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/contracts/catalogue_problem.hpp"
#include "tests/unit/contracts/derivative_comparison.hpp"

namespace pkm {
namespace {

/// Number of random designs; 1000 in the campaign.
const unsigned kDesigns = [] {
  const char* const given = std::getenv("PKM_SLOPE_DESIGNS");
  return given ? static_cast<unsigned>(std::stoul(given)) : 100U;
}();

class DerivativeContract : public testing::TestWithParam<MechanismList::value_type> {
 protected:
  void SetUp() override {
    if (!GetParam()->columns()) GTEST_SKIP() << "voxels have no derivatives";
    const auto evaluator = prepare_workspace(*GetParam(), plan(), {});
    if (!evaluator->gradients()) GTEST_SKIP() << evaluator->why_no_derivatives();
  }
  const MechanismInfo& info() const { return GetParam()->info(); }
  WorkspacePlan plan(const ColumnOptions& columns = {}) const { return test::columns(info(), columns); }

  /// Compares random designs that have a workspace, with random limits, with finite differences.
  void compare(WorkspacePlan p, test::Of of, double excluded, unsigned designs = kDesigns,
               double tolerance = 1e-7) const {
    test::DerivativeComparison comparison(tolerance);
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

TEST_P(DerivativeContract, VolumesAndMarginsEqualFiniteDifferencesOfTheAdaptiveRule) {
  compare(plan({.tolerance = 1e-13}), test::Of::volume, 0.005);  // excluded: the number of nodes changes
}

/// Tolerance 3e-7: if two critical values of the workspace nearly coincide, differences may agree although their steps
/// contain both.
TEST_P(DerivativeContract, AllQuantitiesEqualFiniteDifferencesOfARuleWithFixedNodes) {
  // fewer samples, fewer kinks
  compare(plan({.nodes = {6, 6}}), test::Of::kinematics, 0.02, kDesigns, 3e-7);
}

/// Coupling indices have a kink wherever an off-diagonal element of M_q changes sign at one of the hundreds of samples.
/// Tolerance 5e-6: the quadrature does not track breakpoints at which only the formula of the integrand changes. They
/// do not affect the derivative of the integral, but that of a rule with few nodes, by its quadrature error.
TEST_P(DerivativeContract, InertiaQuantitiesEqualFiniteDifferences) {
  compare(plan({.nodes = {8, 8}}), test::Of::inertia, 0.6, std::max(4U, kDesigns / 80), 5e-6);
}

/// Designs and limits far outside reasonable values; many of them have an empty workspace.
TEST_P(DerivativeContract, AreFiniteEverywhereAndZeroForAnEmptyWorkspace) {
  int empty = 0, usable = 0;
  for (unsigned k = 0; k < 2 * kDesigns; ++k) {
    SCOPED_TRACE("design " + std::to_string(k));
    Stream random(2, 0, k, Stream::Use::start);
    WorkspacePlan p = plan({.nodes = {3, 3}});
    p.limits = test::random_limits(info(), random);
    const LimitSpec infeasible = test::infeasible_limits(info());
    for (std::size_t i = 0; i < info().limits.size(); ++i)  // some limits inactive, some infeasible
      if (random.chance(0.1) && test::has_derivatives(info().limits[i]))
        p.limits.given[i] = random.chance(0.5) ? info().limits[i].inactive : *infeasible.given[i];
    std::vector<double> design = test::nominal(info());
    for (std::size_t i = 0; i < design.size(); ++i) {
      const Parameter& of = info().parameters[i];
      if (random.chance(0.2)) continue;  // keep nominal values: round numbers give degenerate cases
      design[i] = std::clamp(design[i] * 3 * random.u01(), of.lower, of.upper);
    }
    const DesignProblem problem =
        test::everything(GetParam(), p, k % 50 == 0 ? test::Of::inertia : test::Of::kinematics);
    const std::vector<double> derivatives = problem.derivatives(design, problem.parts().varies);
    for (std::size_t i = 0; i < derivatives.size(); ++i) {
      const std::size_t row = i / (1 + design.size()), objectives = problem.objectives().size();
      ASSERT_TRUE(std::isfinite(derivatives[i]))
          << (row < objectives ? problem.objectives()[row].name : problem.margins()[row - objectives].name);
    }
    const bool none = test::survey(*GetParam(), design, p).volume == 0;
    ++(none ? empty : usable);
    if (none) {
      const std::size_t width = 1 + design.size();
      for (std::size_t i = 0; i < problem.objectives().size() * width; ++i)
        EXPECT_EQ(i % width == 0 ? 0 : derivatives[i], 0) << problem.objectives()[i / width].name;
    }
  }
  EXPECT_GT(empty, static_cast<int>(kDesigns / 10));
  EXPECT_GT(usable, static_cast<int>(kDesigns / 20));
}

TEST_P(DerivativeContract, WorkspaceAnalysesHaveTheSameBitsWithAndWithoutDerivatives) {
  for (unsigned k = 0; k < 100; ++k) {
    SCOPED_TRACE("design " + std::to_string(k));
    Stream random(3, 0, k, Stream::Use::start);
    WorkspacePlan p = k % 4 == 3 ? plan({.nodes = {5, 7}}) : plan();
    p.limits = test::random_limits(info(), random);
    const std::vector<double> design = test::random_design(info(), random);
    const auto evaluator = prepare_workspace(*GetParam(), p, test::request_without_inertia(*GetParam()));
    Scratch scratch;
    WorkspaceResult<double> plain, values;
    evaluator->evaluate(design, scratch, plain);
    std::vector<Dual4> duals(design.begin(), design.end());
    for (int i = 0; i < 4; ++i) duals[static_cast<std::size_t>(i)].v[i] = 1;
    WorkspaceResult<Dual4> survey;
    evaluator->gradients()->evaluate(duals, scratch, survey);
    copy_values(survey, values);
    EXPECT_EQ(values.volume, plain.volume);
    EXPECT_EQ(values.columns, plain.columns);
    EXPECT_EQ(values.error, plain.error);
    EXPECT_EQ(values.weight, plain.weight);
    EXPECT_EQ(values.field(kConditioning), plain.field(kConditioning));
  }
}

/// Evaluations as the optimisers receive them.
TEST_P(DerivativeContract, EvaluationsHaveTheSameBitsWithAndWithoutDerivatives) {
  for (unsigned k = 0; k < 30; ++k) {
    Stream random(4, 0, k, Stream::Use::start);
    WorkspacePlan p = plan({.nodes = {4, 4}});
    p.limits = test::random_limits(info(), random);
    const DesignProblem problem = test::everything(GetParam(), p);
    const std::vector<double> design = test::random_design(info(), random);
    EvaluationTable plain(problem.shape(Detail::complete)), with_derivatives(problem.shape(Detail::derivatives));
    Scratch scratch;
    for (EvaluationTable* table : {&plain, &with_derivatives}) {
      table->extend(1);
      problem.evaluate(design, scratch, table->slot(0));
    }
    EXPECT_EQ(with_derivatives.status, plain.status);
    EXPECT_EQ(with_derivatives.objectives, plain.objectives);
    EXPECT_EQ(with_derivatives.margins, plain.margins);
    EXPECT_EQ(with_derivatives.derivatives, problem.derivatives(design, problem.parts().varies));
    // One parameter at a time: each has another position in its block of four directions.
    const std::size_t width = 1 + design.size();
    for (std::size_t i = 0; i < design.size(); ++i) {
      const std::vector<double> alone = problem.derivatives(design, std::vector<std::size_t>{i});
      for (std::size_t q = 0; 2 * q < alone.size(); ++q) {
        EXPECT_EQ(alone[2 * q], with_derivatives.derivatives[q * width]);
        EXPECT_EQ(alone[2 * q + 1], with_derivatives.derivatives[q * width + 1 + i]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, DerivativeContract, testing::ValuesIn(test::mechanisms()),
                         [](const auto& mechanism) { return test::test_name(mechanism.param->info().name); });

}  // namespace
}  // namespace pkm
