// Voxels of 4PPa-2PaR in unusual boxes and grids.
#include <gtest/gtest.h>

#include "engine/math/portable.hpp"
#include "engine/workspace/voxel_grid.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"

namespace pkm::testing {
namespace {

WorkspaceResult<double> surveyed(const WorkspacePlan& plan) { return survey(nominal(), plan); }

TEST(FourPpaVoxelBox, PosesBeyondAQuarterTurnDoNotCount) {
  WorkspacePlan quarter = voxels(no_limits(four_ppa().info()), {16, 17, 30}), half = quarter;
  voxel_options(quarter).box = Box{{{0, 0.8}, {-1.3, -0.15}, {-kPi / 2, kPi / 2}}};
  voxel_options(half).box = Box{{{0, 0.8}, {-1.3, -0.15}, {-kPi, kPi}}};
  voxel_options(half).cells[2] = 60;
  EXPECT_GT(surveyed(quarter).feasible_cells, 0);
  EXPECT_EQ(surveyed(half).feasible_cells, surveyed(quarter).feasible_cells);
  voxel_options(half).box = Box{{{0, 0.8}, {-1.3, -0.15}, {kPi / 2 + 0.01, kPi}}};
  EXPECT_EQ(surveyed(half).feasible_cells, 0);
  std::int64_t in_map = 0;
  for (const auto cell : voxel_map(four_ppa(), nominal(), half).feasible) in_map += cell;
  EXPECT_EQ(in_map, 0);
}

TEST(FourPpaVoxelBox, ARowOfMoreCellsThan32BitsHold) {
  WorkspacePlan plan = voxels(no_limits(four_ppa().info()), {8, 8, 2});
  voxel_options(plan).box = Box{{{0.39, 0.41}, {-0.81, -0.80}, {-0.01, 0.01}}};  // inside the workspace
  ASSERT_EQ(surveyed(plan).feasible_cells, 128);
  voxel_options(plan).cells = {4096, 4096, 2};
  EXPECT_EQ(surveyed(plan).feasible_cells, std::int64_t{1} << 25);
  voxel_options(plan).cells = {65536, 65536, 2};
  const WorkspaceResult<double> survey = surveyed(plan);
  EXPECT_EQ(survey.feasible_cells, std::int64_t{1} << 33);
  EXPECT_NEAR(survey.volume, 0.02 * 0.01 * 0.02, 1e-18);
}

}  // namespace
}  // namespace pkm::testing
