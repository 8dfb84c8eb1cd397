// Which plans the accelerators of 4PPa-2PaR serve; the generic engine serves the others.
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/accelerators.hpp"
#include "engine/accelerators/four_ppa_two_par/model.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

bool serves(const WorkspacePlan& plan, const FieldRequest& request = {}) {
  static const Accelerators closed = accelerators();
  return plan.columns() ? closed.columns->serves(plan, *plan.columns(), request)
                        : closed.voxels->serves(plan, *plan.voxels(), request);
}

const LimitSpec& none() {
  static const LimitSpec limits = no_limits(four_ppa().info());
  return limits;
}

std::vector<WorkspacePlan> usual_plans() {
  return {columns(none()),           columns(none(), at_y(0.4)),           columns(none(), over_y()),
          voxels(none(), {4, 5, 6}), voxels(none(), {4, 5, 6}, at_y(0.4)), voxels(none(), {4, 5, 6}, over_y(3))};
}

TEST(FourPpaAccelerators, ServeTheUsualSweepInTheLowerMode) {
  for (WorkspacePlan plan : usual_plans()) {
    EXPECT_TRUE(serves(plan));
    EXPECT_TRUE(serves(plan, {.fields = {&kCouplingIndex}, .mode = "lower,lower"}));
    EXPECT_FALSE(serves(plan, {.fields = {&kCouplingIndex}, .mode = "upper,upper"}));
    plan.limits.given[kClearanceMin] = 0.01;
    EXPECT_TRUE(serves(plan));
    plan.limits.obstacles = {{"post", SolidBox{{0.4, 1, -0.5}, {0.1, 0.1, 0.1}}}};
    EXPECT_FALSE(serves(plan));
    plan.limits.given[kClearanceMin].reset();
    EXPECT_TRUE(serves(plan)) << "obstacles count under a clearance alone";
    plan.fixed.clear();
    plan.swept = {3, 0, 2};
    EXPECT_TRUE(serves(plan));
    plan.swept = {0, 1, 2};
    EXPECT_FALSE(serves(plan));
  }
}

// A sample stands for mirrored poses, too, in which the two sliders of a rail change places.
TEST(FourPpaAccelerators, ServeDriveTrainsThatAreEqualOnEachRail) {
  for (const WorkspacePlan& plan : usual_plans()) {
    EXPECT_TRUE(serves(plan, {.fields = {&kCouplingIndex}, .rotors = {1, 1, 2, 2}}));
    EXPECT_FALSE(serves(plan, {.fields = {&kCouplingIndex}, .rotors = {1, 1, 2, 3}}));
    EXPECT_TRUE(serves(plan, {.fields = {&kConditioning}, .rotors = {1, 1, 2, 3}}));
  }
}

TEST(FourPpaAccelerators, ServeColumnsWithoutBoxAndNodesOnOnePlane) {
  WorkspacePlan nodes = columns(none());
  column_options(nodes).nodes = {12, 12};
  EXPECT_TRUE(serves(nodes));
  nodes.fixed = {over_y()};
  EXPECT_FALSE(serves(nodes));
  WorkspacePlan boxed = columns(none());
  column_options(boxed).box = Box{{{0.3, 0.5}, {-1, -0.5}, {-0.5, 0.5}}};
  EXPECT_FALSE(serves(boxed));
  WorkspacePlan boxed_voxels = voxels(none(), {4, 5, 6});
  voxel_options(boxed_voxels).box = column_options(boxed).box;
  EXPECT_TRUE(serves(boxed_voxels));
}

// What the accelerators do not serve is the same with them and without.
TEST(FourPpaAccelerators, LeaveTheRestToTheGenericEngine) {
  const FieldRequest upper{.mode = "upper,upper"};
  WorkspacePlan boxed = columns(none());
  column_options(boxed).box = Box{{{0.3, 0.5}, {-1, -0.5}, {-0.5, 0.5}}};
  int compared = 0;
  for (const auto& [plan, request] : {std::pair{voxels(none(), {9, 10, 11}), upper}, {boxed, FieldRequest{}}}) {
    ASSERT_FALSE(serves(plan, request));
    WorkspaceResult<double> generic;
    evaluate_once<double>(*prepare_workspace(generic_four_ppa(), plan, request), nominal(), generic);
    EXPECT_EQ(survey(nominal(), plan, request).volume, generic.volume);
    compared += generic.volume > 0;
  }
  EXPECT_EQ(compared, 2);
}

TEST(FourPpaAccelerators, VoxelsOverYNeedANumberOfCells) {
  try {
    prepare_workspace(four_ppa(), voxels(none(), {4, 5, 6}, over_y()), {});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()), "voxels integrated over y need a number of cells for y");
  }
}

}  // namespace
}  // namespace pkm::testing
