// A pose quantity that only this test defines: workspace analyses and statistics of it follow from the definition.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/problem/pose_statistic.hpp"
#include "engine/workspace/cellwise_voxels.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/workspace/own_inertia.hpp"

namespace pkm {
namespace {

/// Maximum speed of a joint if no coordinate of the platform is faster than 1.
constexpr PoseQuantity kJointSpeed = {
    .name = "joint_speed",
    .unit = "1",
    .meaning = "greatest speed of a joint",
    .lower = -INFINITY,
    .upper = INFINITY,
    .worst = PoseQuantity::Worst::maximum,
    .value_if_undefined = 99,
    .from_report =
        [](const PoseReport& report, double* speed) {
          *speed = report.J ? 0 : std::nan("");
          for (std::size_t i = 0; report.J && i < report.J->rows(); ++i) {
            double sum = 0;
            for (std::size_t j = 0; j < report.J->cols(); ++j) sum += std::fabs((*report.J)(i, j));
            *speed = std::fmax(*speed, sum);
          }
        },
};

WorkspacePlan plan_of(const Mechanism& mechanism) { return test::voxels(mechanism.info(), 7); }

TEST(PoseQuantity, FromReportsInVoxelsOfAnyMechanism) {
  for (const auto& mechanism : test::mechanisms()) {
    const MechanismInfo& info = mechanism->info();
    SCOPED_TRACE(info.name);
    const WorkspaceResult<double> found =
        test::survey(*mechanism, test::nominal(info), plan_of(*mechanism), {.fields = {&kJointSpeed}, .poses = true});
    EXPECT_EQ(found.feasible_cells, test::survey(*mechanism, test::nominal(info), plan_of(*mechanism)).feasible_cells);
    const std::vector<double>& speeds = found.field(kJointSpeed);
    ASSERT_EQ(static_cast<std::int64_t>(speeds.size()), found.feasible_cells);
    ASSERT_FALSE(speeds.empty());
    double sum = 0;
    for (std::size_t k = 0; k < speeds.size(); ++k) {
      double expected;
      kJointSpeed.from_report(
          mechanism->inspect(test::nominal(info), found.pose[k], info.modes.front(), no_limits(info)), &expected);
      if (!std::isfinite(expected)) expected = 99;
      ASSERT_EQ(speeds[k], expected);
      sum += expected;
    }
    Scratch scratch;
    const auto statistic = [&](const char* name) { return PoseStatistic{kJointSpeed, name}(found, scratch); };
    EXPECT_NEAR(statistic("mean") * static_cast<double>(speeds.size()) / sum, 1, 1e-12);
    EXPECT_EQ(statistic("max"), *std::ranges::max_element(speeds));
    EXPECT_GE(statistic("max"), statistic("p95"));
    EXPECT_EQ(PoseStatistic({kJointSpeed, "mean"})(WorkspaceResult<double>(), scratch), 99);
  }
}

TEST(PoseQuantity, FromReportsNotInColumns) {
  for (const auto& mechanism : test::mechanisms()) {
    if (!mechanism->columns()) continue;
    try {
      prepare_workspace(*mechanism, test::columns(mechanism->info()), {.fields = {&kJointSpeed}});
      FAIL() << "accepted";
    } catch (const std::invalid_argument& refusal) {
      EXPECT_STREQ(refusal.what(),
                   "columns do not compute greatest speed of a joint; set workspace.method = \"voxels\"");
    }
  }
}

TEST(PoseQuantity, FromInertiaInVoxelsAndColumnsWithDerivatives) {
  int compared = 0;
  for (const auto& mechanism : test::mechanisms()) {
    if (!mechanism->dynamics()) continue;
    const MechanismInfo& info = mechanism->info();
    SCOPED_TRACE(info.name);
    const std::vector<double> design = test::nominal(info);
    const FieldRequest request{.fields = {&test::kOwnInertia, &kCouplingIndex}, .poses = true};
    WorkspacePlan plan = plan_of(*mechanism);
    const VoxelMap map = voxel_map(*mechanism, design, plan);
    VoxelOptions voxels = *plan.voxels();
    voxels.box.emplace();
    for (std::size_t i = 0; i < 3; ++i) (*voxels.box)[i] = {map.lower[i], map.upper[i]};
    const WorkspaceResult<double> own = test::survey(*mechanism, design, plan, request);
    WorkspaceResult<double> plain;
    evaluate_once<double>(*prepare_cellwise_voxels(*mechanism, plan, voxels, request), design, plain);
    Scratch scratch;
    for (const char* joint : {"1", "2", "worst", "mean"}) {
      const PoseStatistic mean{test::kOwnInertia, "mean", joint};
      EXPECT_NEAR(mean(own, scratch) / mean(plain, scratch), 1, 1e-9) << joint;
      EXPECT_GT(mean(own, scratch), 0);
    }
    EXPECT_EQ(own.field(test::kOwnInertia).size(), own.field(kCouplingIndex).size());
    if (!mechanism->columns()) continue;
    const auto evaluator = prepare_workspace(*mechanism, test::columns(info), request);
    if (!evaluator->gradients()) continue;
    WorkspaceResult<double> values;
    WorkspaceResult<Dual4> slopes;
    evaluate_once<double>(*evaluator, design, values);
    const std::vector<Dual4> parameters(design.begin(), design.end());
    evaluate_once<Dual4>(*evaluator, parameters, slopes);
    const PoseStatistic mean{test::kOwnInertia, "mean", "worst"};
    EXPECT_EQ(mean(slopes, scratch).a, mean(values, scratch));
    // At the lightest pose, far from where the inertia tends to infinity.
    const std::vector<double>& first = values.field(test::kOwnInertia);
    const auto lightest = static_cast<std::size_t>(std::ranges::min_element(first) - first.begin());
    const MotionState<double> state{values.pose[lightest], AxisVector<double>(info.coordinates.size())};
    PoseDynamics<double> dynamics;
    mechanism->dynamics()->equations(design, info.modes.front(), {&state, 1}, {&dynamics, 1});
    const AxisMatrix<double> M_q = joint_inertia(dynamics);
    for (std::size_t i = 0; i < info.joints.size(); ++i)
      EXPECT_NEAR(values.field(test::kOwnInertia, i)[lightest] / M_q(i, i), 1, 1e-9) << i;
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

}  // namespace
}  // namespace pkm
