// Obstacles in workspace analyses and in margins of poses: voxels of all evaluators compared with reports of single
// poses, and derivatives of margins.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/math/dual.hpp"
#include "engine/workspace/cellwise_voxels.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm {
namespace {

/// A clearance limit with three obstacles near a pose: a ball, a post and a table.
LimitSpec limits_about(const MechanismInfo& info, const Pose<double>& pose, double min_clearance) {
  LimitSpec limits = no_limits(info);
  for (std::size_t i = 0; i < info.limits.size(); ++i)
    if (info.limits[i].group == "clearance") limits.given[i] = min_clearance;
  Point3<double> at{};
  for (std::size_t i = 0; i < info.coordinates.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (info.coordinates[i].name == std::string(1, "xyz"[axis])) at[axis] = pose[i];
  const Point3<double> ball = {at[0] + 0.05, at[1] + 0.03, at[2]};
  limits.obstacles = {
      {"ball", Capsule<double>{{ball, ball}, 0.02}},
      {"post", Capsule<double>{{{at[0] - 0.1, at[1], -1}, {at[0] - 0.1, at[1], 1}}, 0.01}},
      {"table", SolidBox{{at[0], at[1] + 0.1, at[2]}, {0.2, 0.02, 0.05}}},
  };
  return limits;
}

std::vector<std::shared_ptr<const Mechanism>> with_links() {
  std::vector<std::shared_ptr<const Mechanism>> all;
  for (const std::string& name : test::mechanisms_and_files()) {
    const auto& mechanism = test::test_mechanism(name);
    const auto& limits = mechanism->info().limits;
    if (std::ranges::find(limits, "clearance", &LimitInfo::group) != limits.end()) all.push_back(mechanism);
  }
  return all;
}

TEST(Obstacles, VoxelsAgreeWithPoseReports) {
  std::int64_t cut = 0, left = 0;
  ASSERT_GE(with_links().size(), 6u);
  for (const auto& mechanism : with_links()) {
    const MechanismInfo& info = mechanism->info();
    SCOPED_TRACE(info.name);
    const std::vector<double> design = test::nominal(info);
    WorkspacePlan plan = test::voxels(info, 9);
    for (FixedCoordinate& fixed : plan.fixed) {
      fixed.kind = FixedCoordinate::Kind::value;
      fixed.value = *mechanism->default_value(design, fixed.coordinate) + 0.01;
    }
    plan.limits = limits_about(info, test::reference_pose(*mechanism), -0.01);
    const VoxelMap own = voxel_map(*mechanism, design, plan);
    const VoxelMap plain = prepare_cellwise_voxels(*mechanism, plan, *plan.voxels(), {})->map(design);
    EXPECT_EQ(own.feasible, plain.feasible);
    WorkspacePlan free = plan;
    free.limits.obstacles.clear();
    const VoxelMap without = voxel_map(*mechanism, design, free);
    for (std::size_t i = 0; i < own.feasible.size(); ++i) {
      EXPECT_LE(own.feasible[i], without.feasible[i]);
      cut += without.feasible[i] - own.feasible[i];
      left += own.feasible[i];
    }
    const WorkspaceResult<double> survey = test::survey(*mechanism, design, plan, {.fields = {&kConditioning}});
    EXPECT_EQ(survey.feasible_cells, std::ranges::count(own.feasible, 1));
  }
  EXPECT_GT(cut, 100);
  EXPECT_GT(left, 100);
}

TEST(Obstacles, AreNamedInPoseReports) {
  for (const auto& mechanism : with_links()) {
    const MechanismInfo& info = mechanism->info();
    SCOPED_TRACE(info.name);
    const Pose<double> pose = test::reference_pose(*mechanism);
    LimitSpec limits = limits_about(info, pose, -0.01);
    limits.obstacles = {{"a wall", SolidBox{{0, 0, 0}, {9, 9, 9}}}};
    const PoseReport report = mechanism->inspect(test::nominal(info), pose, info.modes.front(), limits);
    EXPECT_TRUE(report.assembles);
    EXPECT_FALSE(report.feasible);
    EXPECT_TRUE(report.reason.ends_with(" and a wall overlap")) << report.reason;
  }
}

TEST(Obstacles, HaveNoEffectWithoutClearanceLimit) {
  for (const auto& mechanism : with_links()) {
    const MechanismInfo& info = mechanism->info();
    SCOPED_TRACE(info.name);
    WorkspacePlan plan = test::voxels(info, 5);
    const std::vector<double> design = test::nominal(info);
    const VoxelMap without = voxel_map(*mechanism, design, plan);
    plan.limits.obstacles = {{"a wall", SolidBox{{0, 0, 0}, {9, 9, 9}}}};
    EXPECT_EQ(voxel_map(*mechanism, design, plan).feasible, without.feasible);
  }
}

TEST(Obstacles, MarginsHaveDerivatives) {
  int compared = 0;
  for (const auto& mechanism : with_links()) {
    const PoseMargins* const margins = mechanism->pose_margins();
    if (!margins) continue;
    const MechanismInfo& info = mechanism->info();
    SCOPED_TRACE(info.name);
    const Pose<double> pose = test::reference_pose(*mechanism);
    const LimitSpec limits = limits_about(info, pose, -0.01);
    const std::vector<double> design = test::nominal(info);
    Scratch scratch;
    for (std::size_t p = 0; p < design.size(); ++p) {
      constexpr double kStep = 1e-6;
      const auto at = [&](double by) {
        std::vector<double> moved = design, found;
        moved[p] += by;
        margins->append(std::span<const double>(moved), "", limits, {&pose, 1}, scratch, found);
        return found.back();
      };
      std::vector<Dual4> moving(design.begin(), design.end()), found;
      moving[p].v[0] = 1;
      margins->append(std::span<const Dual4>(moving), "", limits, {&pose, 1}, scratch, found);
      EXPECT_EQ(found.back().a, at(0));
      const double before = at(-kStep), after = at(kStep);
      if (std::fabs(before + after - 2 * at(0)) > 1e-10) continue;  // another link or obstacle takes over
      EXPECT_NEAR(found.back().v[0], (after - before) / (2 * kStep), 1e-6) << info.parameters[p].name;
      ++compared;
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(Obstacles, AreRefusedByColumns) {
  for (const auto& mechanism : with_links()) {
    if (!mechanism->columns()) continue;
    const MechanismInfo& info = mechanism->info();
    SCOPED_TRACE(info.name);
    WorkspacePlan plan = test::columns(info);
    plan.limits = limits_about(info, test::reference_pose(*mechanism), 0);
    try {
      prepare_workspace(*mechanism, plan, {});
      ADD_FAILURE() << "accepted";
    } catch (const std::invalid_argument& refused) {
      EXPECT_NE(std::string(refused.what()).find("has no exact columns with a clearance limit (clearance_min)"),
                std::string::npos)
          << refused.what();
    }
  }
}

}  // namespace
}  // namespace pkm
