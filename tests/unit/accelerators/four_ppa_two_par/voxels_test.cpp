// Voxels of 4PPa-2PaR against the plain pose test, columns and their symmetries, for random designs with and without
// limits, on and off the middle plane.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/columns.hpp"
#include "engine/accelerators/four_ppa_two_par/voxels.hpp"
#include "engine/math/statistics.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/random_cases.hpp"
#include "tests/unit/generic/plain_loop.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

/// Smallest absolute margin of a pose: cells within rounding of a boundary may differ.
double margin_at(const Case& c, double x, double z, double theta) {
  const PoseReport r = four_ppa().inspect(c.p, {x, c.y, z, theta}, "lower,lower", c.limits);
  double nearest = 1;
  for (const auto& [name, value] : r.margins) nearest = std::min(nearest, std::fabs(value));
  return nearest;
}

TEST(FourPpaVoxels, CountsFromIntervalsEqualThePlainLoop) {
  std::int64_t total = 0;
  for (const Case& c : random_cases(60, 1)) {
    const WorkspacePlan plan = voxels(c.limits, {13, 16, 18}, at_y(c.y));
    const VoxelMap map = voxel_map(four_ppa(), c.p, plan);
    const auto g = geometry(std::span<const double>(c.p));
    const auto l = limits(g, c.limits);
    const VoxelGrid grid(plan.voxels()->cells, default_box(g));
    const VoxelMap plain = test_every_cell(grid, [&](double x, double z, double theta) {
      const auto [s, co] = sincos(theta);
      return feasible(g, l, x, c.y, z, s, co);
    });
    std::int64_t counted = 0, excused = 0;
    for (std::size_t i = 0; i < plain.feasible.size(); ++i) {
      counted += map.feasible[i];
      if (map.feasible[i] == plain.feasible[i]) continue;
      const auto k = static_cast<std::int64_t>(i) % 18, j = static_cast<std::int64_t>(i) / 18 % 16,
                 a = static_cast<std::int64_t>(i) / (18 * 16);
      EXPECT_LT(margin_at(c, grid.centre(0, a), grid.centre(1, j), grid.centre(2, k)), 1e-12);
      ++excused;
    }
    EXPECT_LE(excused, 2);
    const auto found = survey(c.p, plan);
    EXPECT_EQ(found.feasible_cells, counted);
    total += counted;
  }
  EXPECT_GT(total, 20000) << "the random designs should have workspaces";
}

TEST(FourPpaVoxels, SymmetryShortcutsCountTheSameCells) {
  for (const Case& c : random_cases(30, 2)) {
    for (const std::array<std::int64_t, 3>& cells : {std::array<std::int64_t, 3>{12, 15, 20}, {13, 15, 21}}) {
      const WorkspacePlan plan = voxels(c.limits, cells);
      const VoxelMap map = voxel_map(four_ppa(), c.p, plan);
      const std::int64_t counted = std::count(map.feasible.begin(), map.feasible.end(), 1);
      EXPECT_EQ(survey(c.p, plan).feasible_cells, counted);
    }
  }
}

TEST(FourPpaVoxels, PlainPoseTestAgreesWithPoseReports) {
  Uniform uniform(3);
  for (const Case& c : random_cases(40, 3)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto l = limits(g, c.limits);
    for (int i = 0; i < 200; ++i) {
      const double x = uniform(0, c.p[kB]), z = uniform(-(c.p[kLu] + c.p[kLd] + c.p[kD]), 0),
                   theta = uniform(-kPi / 2, kPi / 2);
      const auto [s, co] = sincos(theta);
      const PoseReport r = four_ppa().inspect(c.p, {x, c.y, z, theta}, "lower,lower", c.limits);
      EXPECT_EQ(feasible(g, l, x, c.y, z, s, co), r.feasible) << r.reason;
      EXPECT_EQ(r.reason.empty(), r.feasible);
    }
  }
}

TEST(FourPpaVoxels, GivenBoxAndItsTouch) {
  const auto none = no_limits(four_ppa().info());
  WorkspacePlan plan = voxels(none, {30, 30, 30});
  voxel_options(plan).box = Box{{{-0.2, 1.0}, {-1.5, 0.1}, {-1.7, 1.7}}};
  const auto inside = survey(nominal(), plan);
  EXPECT_FALSE(inside.touches_box);
  EXPECT_NEAR(inside.volume / 0.550157374606, 1, 0.04);
  voxel_options(plan).box = Box{{{0.3, 0.5}, {-1.5, 0.1}, {-1.7, 1.7}}};
  EXPECT_TRUE(survey(nominal(), plan).touches_box);
}

TEST(FourPpaVoxels, IntegratedOverYConvergesToColumns) {
  const auto none = no_limits(four_ppa().info());
  auto p = nominal();
  const double exact = survey(p, columns(none, over_y())).volume;
  const WorkspacePlan plan = voxels(none, {48, 48, 80}, over_y(50));
  const auto found = survey(p, plan);
  EXPECT_NEAR(found.volume / exact, 1, 0.01);
  EXPECT_EQ(found.cells, 48 * 48 * 80 * 50);
}

}  // namespace
}  // namespace pkm::testing
