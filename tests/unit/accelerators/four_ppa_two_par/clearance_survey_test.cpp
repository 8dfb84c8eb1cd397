// Workspace analyses of 4PPa-2PaR with a minimum clearance: against the plain pose test, each other and equivalent
// limits.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/clear_volume.hpp"
#include "engine/accelerators/four_ppa_two_par/voxels.hpp"
#include "engine/math/statistics.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/clear_designs.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/plain_pose.hpp"
#include "tests/unit/generic/plain_loop.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

TEST(FourPpaClearance, VoxelsEqualThePlainLoop) {
  Uniform uniform(5);
  std::int64_t total = 0, cut = 0;
  for (int i = 0; i < 40; ++i) {
    const ClearanceCase c = i % 2
                                ? random_clearance_case(uniform)
                                : ClearanceCase{with(exotics()[i / 2 % 4].changes), exotics()[i / 2 % 4].min_clearance};
    const double y = i % 3 == 2 ? c.p[kL0] * uniform(0.2, 0.8) : c.p[kL0] / 2;
    const WorkspacePlan plan = voxels(clearance(c.min_clearance), {13, 16, 18}, at_y(y));
    const auto g = geometry(std::span<const double>(c.p));
    const auto l = limits(g, plan.limits);
    const VoxelGrid grid(plan.voxels()->cells, default_box(g));
    const VoxelMap plain = test_every_cell(grid, [&](double x, double z, double theta) {
      const auto [s, co] = sincos(theta);
      return feasible(g, l, x, y, z, s, co);
    });
    WorkspaceResult<double> expected;
    summarise(grid, plain, expected);
    const VoxelMap map = voxel_map(four_ppa(), c.p, plan);
    FieldRequest request;
    request.add(kConditioning);
    const auto found = survey(c.p, plan, request);
    EXPECT_EQ(map.feasible, plain.feasible) << i;
    EXPECT_EQ(found.feasible_cells, expected.feasible_cells) << i;
    EXPECT_EQ(found.touches_box, expected.touches_box) << i;
    double counted = 0;  // a sample may stand for its mirror images too
    for (const double w : found.weight) counted += w / found.cell_volume;
    EXPECT_NEAR(counted, static_cast<double>(expected.feasible_cells), 1e-6) << i;
    EXPECT_EQ(found.weight.size(), found.field(kConditioning).size()) << i;
    auto without = plan;
    without.limits = no_limits_of_four_ppa();
    total += found.feasible_cells;
    cut += survey(c.p, without).feasible_cells - found.feasible_cells;
  }
  EXPECT_GT(total, 5000);
  EXPECT_GT(cut, 5000);
}

TEST(FourPpaClearance, SlidersAloneAreABoundOfTheirSpacing) {
  FieldRequest request;
  request.add(kConditioning);
  for (const double min_clearance : {0.0, 0.02}) {
    LimitSpec equal = no_limits_of_four_ppa();
    equal.given[kHMin] = 0.03 + 0.08 / 2 + min_clearance / 2;
    for (const FixedCoordinate& fixed_y : {in_the_middle(), at_y(0.4), over_y()}) {
      const auto found = survey(nominal(), columns(clearance(min_clearance), fixed_y), request);
      const auto expected = survey(nominal(), columns(equal, fixed_y), request);
      EXPECT_EQ(found.volume, expected.volume);
      EXPECT_EQ(found.error, expected.error);
      EXPECT_EQ(found.weight, expected.weight);
      EXPECT_EQ(found.field(kConditioning), expected.field(kConditioning));
      EXPECT_LT(found.volume, survey(nominal(), columns(no_limits_of_four_ppa(), fixed_y)).volume);
    }
    EXPECT_EQ(survey(nominal(), voxels(clearance(min_clearance), {32, 34, 60})).feasible_cells,
              survey(nominal(), voxels(equal, {32, 34, 60})).feasible_cells);
  }
}

TEST(FourPpaClearance, LowerBarsBesideThePlatformAreABoundOfBeta) {
  const auto p = with({{kD, 0.05}, {kDd, 0.2}, {kRd, 0.005}, {kRp, 0.005}});
  LimitSpec equal = no_limits_of_four_ppa();
  equal.given[kHMin] = 0.07 + 0.01;
  equal.given[kBetaMin] = asin((0.02 + 0.005 + 0.005) / (0.2 - 0.05));
  const double expected = survey(p, columns(equal)).volume;
  EXPECT_NEAR(survey(p, columns(clearance(0.02))).volume, expected, 1e-10 * expected);
  EXPECT_NEAR(survey(p, voxels(clearance(0.02), {60, 60, 60})).volume, expected, 0.02 * expected);
}

TEST(FourPpaClearance, ALargerClearanceNeverLeavesMore) {
  for (const Exotic& e : exotics()) {
    double before = survey(with(e.changes), columns(no_limits_of_four_ppa())).volume;
    for (const double share : {0.0, 0.8, 1.0, 1.1, 10.0}) {
      const auto found = survey(with(e.changes), columns(clearance(share * e.min_clearance), in_the_middle(), 1e-2));
      EXPECT_LE(found.volume, before * (1 + 1e-3)) << share;
      before = found.volume;
    }
    EXPECT_EQ(before, 0);
  }
}

/// Volumes by columns under a limit that cuts columns.
TEST(FourPpaClearance, ColumnsAgreeWithFineVoxels) {
  for (const Exotic& e : exotics()) {
    const auto p = with(e.changes);
    const auto g = geometry(std::span<const double>(p));
    auto l = limits(g, clearance(e.min_clearance));
    ASSERT_TRUE(reduce_clearance(g, l)) << e.min_clearance;
    for (const double y : {p[kL0] / 2, 0.45}) {
      const FixedCoordinate fixed_y = at_y(y);
      LimitSpec folded = no_limits_of_four_ppa();
      folded.given[kHMin] = l.h_min;
      const double uncut = survey(p, columns(folded, fixed_y)).volume;
      const auto found = survey(p, columns(clearance(e.min_clearance), fixed_y, 1e-2));
      EXPECT_LT(found.volume, uncut * (y == p[kL0] / 2 ? 1 - found.error : 1 + 1e-9)) << e.min_clearance;
      EXPECT_LT(found.error, 0.02);
      const double cells = survey(p, voxels(clearance(e.min_clearance), {120, 120, 120}, fixed_y)).volume;
      EXPECT_NEAR(found.volume, cells, 0.006 * uncut) << e.min_clearance << " at " << y;
    }
  }
}

TEST(FourPpaClearance, TheErrorIsEstimatedHonestly) {
  for (const Exotic& e : {exotics()[1], exotics()[2]}) {
    const auto p = with(e.changes);
    const auto best = survey(p, columns(clearance(e.min_clearance), in_the_middle(), kFinestClearTolerance));
    EXPECT_LE(best.error, 2 * kFinestClearTolerance);
    for (const double tolerance : {1e-2, 1e-3}) {
      const auto rough = survey(p, columns(clearance(e.min_clearance), in_the_middle(), tolerance));
      EXPECT_LE(std::fabs(rough.volume / best.volume - 1), rough.error + best.error);
      EXPECT_LT(rough.columns, best.columns);
    }
    const auto finer = survey(p, columns(clearance(e.min_clearance), in_the_middle(), 1e-9));
    EXPECT_EQ(finer.volume, best.volume) << "a finer tolerance is not aimed at";
    WorkspacePlan nodes = columns(clearance(e.min_clearance));
    column_options(nodes).nodes = {40, 40};
    const auto fixed = survey(p, nodes);
    EXPECT_NEAR(fixed.volume / best.volume, 1, 2e-3);
    EXPECT_EQ(fixed.error, 0);
  }
}

TEST(FourPpaClearance, IntegratedOverYEqualsTheSumOverPlanes) {
  const Exotic e = exotics()[2];
  const auto p = with(e.changes);
  const auto found = survey(p, columns(clearance(e.min_clearance), over_y(), 1e-2));
  constexpr int kPlanes = 100;
  double sum = 0;
  for (int i = 0; i < kPlanes; ++i) {
    WorkspacePlan plane = columns(clearance(e.min_clearance), at_y(p[kL0] * (i + 0.5) / kPlanes));
    column_options(plane).nodes = {5, 5};
    sum += survey(p, plane).volume;
  }
  EXPECT_NEAR(found.volume, sum * p[kL0] / kPlanes, 0.01 * found.volume);
  const WorkspacePlan cells = voxels(clearance(e.min_clearance), {40, 40, 60}, over_y(40));
  EXPECT_NEAR(survey(p, cells).volume, found.volume, 0.02 * found.volume);
  // where the test never cuts, it is the quadrature of closed-form areas
  const auto wide = with({{kA, 0.3}, {kB, 0.305}, {kD, 0.3}});
  const auto g = geometry(std::span<const double>(wide));
  auto l = limits(g, clearance(0.005));
  ASSERT_TRUE(reduce_clearance(g, l));
  LimitSpec equal = no_limits_of_four_ppa();
  equal.given[kHMin] = l.h_min;
  EXPECT_NEAR(survey(wide, columns(clearance(0.005), over_y())).volume / survey(wide, columns(equal, over_y())).volume,
              1, 1e-4);
}

TEST(FourPpaClearance, ConditioningIsThatOfTheClearPoses) {
  FieldRequest request;
  request.add(kConditioning);
  for (const Exotic& e : {exotics()[0], exotics()[1]}) {
    const auto p = with(e.changes);
    const auto exact = survey(p, columns(clearance(e.min_clearance), in_the_middle(), 1e-2), request);
    double sum = 0;
    for (const double w : exact.weight) sum += w;
    EXPECT_NEAR(sum, exact.volume, 0.04 * exact.volume);  // kinks that no node knows of
    const auto cells = survey(p, voxels(clearance(e.min_clearance), {80, 80, 80}), request);
    EXPECT_NEAR(weighted_mean(cells.weight, cells.field(kConditioning)),
                weighted_mean(exact.weight, exact.field(kConditioning)), 5e-3);
  }
}

TEST(FourPpaClearance, NothingIsLeftWhereAPairIsTooNearAtEveryPose) {
  FieldRequest request;
  request.add(kConditioning);
  for (const double min_clearance : {0.05, 0.19, 100.0})
    for (const FixedCoordinate& fixed_y : {in_the_middle(), over_y(10)}) {
      const WorkspacePlan cells = voxels(clearance(min_clearance), {10, 10, 10}, fixed_y);
      for (const WorkspacePlan& plan : {columns(clearance(min_clearance), fixed_y), cells}) {
        const auto empty = survey(nominal(), plan, request);
        EXPECT_EQ(empty.volume, 0);
        EXPECT_EQ(empty.feasible_cells, 0);
        EXPECT_EQ(empty.error, 0);
        EXPECT_TRUE(empty.weight.empty());
      }
    }
}

TEST(FourPpaClearance, HasNoDerivativesAndSaysWhy) {
  const auto limited = prepare_workspace(four_ppa(), columns(clearance(0.01)), {});
  EXPECT_EQ(limited->gradients(), nullptr);
  EXPECT_EQ(
      limited->why_no_derivatives(),
      "the study limits the clearance of links (clearance_min), so that ends of columns have no closed form and the "
      "analysis has no derivatives; use an optimiser without gradients, or keep the sliders apart by h_min");
  EXPECT_NE(prepare_workspace(four_ppa(), columns(no_limits_of_four_ppa()), {})->gradients(), nullptr);
}

}  // namespace
}  // namespace pkm::testing
