// Exact volumes of the component that holds the home pose, beside closed forms and voxels.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/core/error.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/workspace/connectivity.hpp"

namespace pkm {
namespace {

WorkspacePlan columns_at(const MechanismInfo& info, const std::array<double, 3>& home) {
  WorkspacePlan plan = test::columns(info);
  plan.home = home;
  return plan;
}

// reference: areas of the circular sectors in closed form; a gap separates the first two components, and the
// singularity y = 0 the others
TEST(HomeColumns, OfTwoTelescopesHaveTheReferenceAreas) {
  const struct { double a, area; } known[] = {{1, 1.440827656219}, {0.5, 3.619396585115}};
  for (const auto& [a, area] : known)
    for (const double side : {1.0, -1.0}) {
      const auto mechanism = test::two_telescopes(a, 1.8, 1.5);
      const std::vector<double> design = test::nominal(mechanism->info());
      const WorkspacePlan plan = columns_at(mechanism->info(), {0.1, 1.2 * side, 0});
      const WorkspaceResult<double> found = test::survey(*mechanism, design, plan, {});
      EXPECT_NEAR(found.volume, area / 2, 1e-7 * area) << a;
      EXPECT_LT(found.error, 1e-3) << a;
      EXPECT_TRUE(found.is_sampled);
      EXPECT_TRUE(found.weight.empty());
      const WorkspaceResult<double> samples =
          test::survey(*mechanism, design, plan, {.fields = {&kConditioning}, .poses = true});
      EXPECT_NEAR(samples.volume, found.volume, 1e-9);
      double sum = 0;
      for (std::size_t i = 0; i < samples.weight.size(); ++i) {
        sum += samples.weight[i];
        EXPECT_GT(samples.pose[i][1] * side, 0);
      }
      EXPECT_NEAR(sum, area / 2, 1e-3 * area) << a;
      EXPECT_EQ(samples.field(kConditioning).size(), samples.weight.size());
    }
}

TEST(HomeColumns, HaveDerivatives) {
  for (const double a : {1.0, 0.5}) {
    const auto mechanism = test::two_telescopes(a, 1.8, 1.5);
    const std::vector<double> design = test::nominal(mechanism->info());
    const auto evaluator = prepare_workspace(*mechanism, columns_at(mechanism->info(), {0.1, 1.2, 0}), {});
    ASSERT_TRUE(evaluator->gradients());
    std::vector<Dual4> duals(design.begin(), design.end());
    for (std::size_t i = 0; i < 3; ++i) duals[i] = Dual4::variable(design[i], static_cast<int>(i));
    WorkspaceResult<Dual4> found;
    evaluate_once<Dual4>(*evaluator, duals, found);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto at = [&](double change) {
        std::vector<double> changed = design;
        changed[i] += change;
        WorkspaceResult<double> result;
        evaluate_once<double>(*evaluator, changed, result);
        return result.volume;
      };
      EXPECT_NEAR(found.volume.v[static_cast<int>(i)], (at(1e-4) - at(-1e-4)) / 2e-4, 1e-4) << a << ' ' << i;
    }
  }
}

TEST(HomeColumns, OfASingleComponentHaveTheWholeVolume) {
  const Mechanism& mechanism = *test::described("rotary-delta");
  const std::vector<double> design = test::nominal(mechanism.info());
  const WorkspaceResult<double> whole =
      test::survey(mechanism, design, test::columns(mechanism.info()), {.fields = {&kConditioning}});
  const WorkspaceResult<double> found =
      test::survey(mechanism, design, columns_at(mechanism.info(), {0, 0, -0.5}), {.fields = {&kConditioning}});
  EXPECT_EQ(found.volume, whole.volume);
  EXPECT_EQ(found.error, whole.error);
  EXPECT_EQ(found.field(kConditioning), whole.field(kConditioning));
}

TEST(HomeColumns, OfRotationsHaveTheReferenceAngle) {
  const auto mechanism = read_mechanism_toml(test::symmetric_3_rpr("\"phi\""), "3-rpr.toml");
  const std::vector<double> design = test::nominal(mechanism->info());
  // reference: the law of cosines for the length of a leg
  const WorkspaceResult<double> found =
      test::survey(*mechanism, design, columns_at(mechanism->info(), {std::numbers::pi / 3, 0, 0}), {});
  EXPECT_NEAR(found.volume, (101.536959 - 28.457998) * std::numbers::pi / 180, 1e-7);
}

TEST(HomeColumns, OfSeveralComponentsInSpaceAgreeWithVoxels) {
  const Mechanism& mechanism = *test::described("orthoglide");
  const std::vector<double> design = test::nominal(mechanism.info());
  const WorkspacePlan plan = columns_at(mechanism.info(), {0, 0, 0});
  const WorkspaceResult<double> found = test::survey(mechanism, design, plan, {});
  const double whole = test::survey(mechanism, design, test::columns(mechanism.info()), {}).volume;
  WorkspacePlan cells = test::voxels(mechanism.info(), 60);
  cells.home = plan.home;
  const double counted = test::survey(mechanism, design, cells, {}).volume;
  EXPECT_LT(counted, 0.995 * whole);
  EXPECT_NEAR(found.volume, counted, 4e-3 * whole);
}

TEST(HomeColumns, OfThreeCoordinatesThatASingularityCutsAreFailures) {
  const auto mechanism = read_mechanism_toml(test::symmetric_3_rpr("\"x\", \"y\", \"phi\""), "3-rpr.toml");
  try {
    test::survey(*mechanism, {0.2}, columns_at(mechanism->info(), {0, 0, std::numbers::pi / 3}), {});
    ADD_FAILURE();
  } catch (const DesignError& reason) {
    EXPECT_EQ(std::string(reason.what()).find("the component that holds the home pose ends at a singularity, "), 0U);
  }
}

TEST(HomeColumns, OfADesignWithoutAFeasibleHomePoseAreFailures) {
  const auto mechanism = test::two_telescopes(0.5, 1.8, 1.5);
  const std::vector<double> design = test::nominal(mechanism->info());
  EXPECT_THROW(test::survey(*mechanism, design, columns_at(mechanism->info(), {0, 0, 0}), {}), DesignError);
  EXPECT_THROW(test::survey(*mechanism, design, columns_at(mechanism->info(), {0, 1.79, 0}), {}), DesignError);
}

}  // namespace
}  // namespace pkm
