// Pictures of workspaces say what surveys say, for every mechanism and each of its sweeps.
#include <gtest/gtest.h>

#include <map>

#include "engine/core/team.hpp"
#include "engine/math/statistics.hpp"
#include "engine/problem/inertia_options.hpp"
#include "engine/report/isosurface.hpp"
#include "tests/unit/contracts/nominal.hpp"

namespace pkm {
namespace {

class WorkspaceFieldsContract : public testing::TestWithParam<std::shared_ptr<const Mechanism>> {
 protected:
  const Mechanism& mechanism() const { return *GetParam(); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::vector<double> parameters() const { return test::nominal(info()); }
  /// Of a sweep, 12 x 13 x 14 cells.
  SurveyPlan plan(const Sweep& sweep) const {
    SurveyPlan plan = test::plan(info(), sweep, Method::voxels);
    plan.cells = {12, 13, 14};
    return plan;
  }
  WorkspaceFields fields(const SurveyPlan& plan) const { return workspace_fields(mechanism(), parameters(), plan, ""); }
  /// A box inside the workspace's hull, on all sides of which feasible cells are cut off.
  SurveyPlan cut(SurveyPlan plan) const {
    const WorkspaceFields whole = fields(plan);
    const VoxelGrid grid = whole.grid();
    plan.box.emplace();
    for (std::size_t i = 0; i < 3; ++i) (*plan.box)[i] = {1e9, -1e9};
    for (std::size_t cell = 0; cell < whole.cells(); ++cell) {
      if (!(whole.field("feasible").values[cell] > 0)) continue;
      const Pose<double> pose = whole.pose(cell);
      const double at[4] = {pose.x, pose.y, pose.z, pose.angle};
      for (std::size_t i = 0; i < 3; ++i) {
        auto& [lower, upper] = (*plan.box)[i];
        lower = std::fmin(lower, at[whole.axes[i].coordinate] + 0.7 * grid.step[i]);
        upper = std::fmax(upper, at[whole.axes[i].coordinate] - 0.7 * grid.step[i]);
      }
    }
    return plan;
  }
};

TEST_P(WorkspaceFieldsContract, FeasibleCellsAreThoseOfTheVoxelMapAndMarginsAgree) {
  for (const Sweep& sweep : sweeps_of(info())) {
    SCOPED_TRACE("held coordinate " + std::to_string(sweep.held));
    const WorkspaceFields found = fields(plan(sweep));
    const VoxelMap map = mechanism().voxel_map(parameters(), plan(sweep));
    const auto& feasible = found.field("feasible").values;
    ASSERT_EQ(feasible.size(), map.feasible.size());
    std::int64_t cells = 0;
    const WorkspaceField& conditioning = found.field("conditioning");
    for (std::size_t cell = 0; cell < feasible.size(); ++cell) {
      ASSERT_EQ(feasible[cell], map.feasible[cell]) << cell;
      ASSERT_EQ(found.field("margin").values[cell] > 0, feasible[cell] > 0) << cell;
      ASSERT_EQ(std::isnan(conditioning.values[cell]), feasible[cell] == 0) << cell;
      cells += map.feasible[cell];
    }
    EXPECT_GT(cells, 20);
    const Survey<double> survey = test::survey(mechanism(), parameters(), plan(sweep));
    EXPECT_EQ(cells, survey.feasible_cells);
    EXPECT_NEAR(found.volume / survey.volume, 1, 1e-12);
    EXPECT_EQ(found.volume_unit, sweep.volume_unit);
    EXPECT_EQ(found.held.coordinate, sweep.held);
  }
}

TEST_P(WorkspaceFieldsContract, MapsAreHeldAtTheMiddleUnlessThePlanSaysAValue) {
  for (const Sweep& sweep : sweeps_of(info())) {
    SCOPED_TRACE("held coordinate " + std::to_string(sweep.held));
    const double middle = mechanism().middle(parameters(), sweep.held);
    const WorkspaceFields found = fields(plan(sweep));
    EXPECT_EQ(found.held.lower, middle);
    SurveyPlan said = plan(sweep);
    said.held.kind = HeldCoordinate::Kind::value;
    said.held.value = middle;
    EXPECT_EQ(fields(said).field("feasible").values, found.field("feasible").values);
    EXPECT_NE(fields(said).held_note, found.held_note);
  }
}

TEST_P(WorkspaceFieldsContract, ColumnsArePicturedByVoxels) {
  const WorkspaceFields found = fields(test::plan(info(), Method::columns));
  for (const WorkspaceAxis& axis : found.axes) EXPECT_EQ(axis.cells, kPictureCells);
  EXPECT_GT(found.volume, 0);
  if (info().held_can_integrate) {
    SurveyPlan integrated = test::plan(info(), Method::columns);
    integrated.held.kind = HeldCoordinate::Kind::integrated;
    const WorkspaceFields middle = fields(integrated);
    EXPECT_EQ(middle.held.lower, found.held.lower);
    EXPECT_NE(middle.held_note, found.held_note);
    EXPECT_EQ(middle.volume, found.volume);
  }
}

TEST_P(WorkspaceFieldsContract, ConditioningAndCouplingHaveTheStatisticsOfSurveys) {
  if (info().characteristic_length.empty()) GTEST_SKIP() << "no conditioning";
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0;
    std::size_t n = 0;
    for (const double value : values)
      if (!std::isnan(value)) sum += value, ++n;
    return sum / static_cast<double>(n);
  };
  for (const Sweep& sweep : sweeps_of(info())) {
    SCOPED_TRACE("held coordinate " + std::to_string(sweep.held));
    Demand demand;
    demand.conditioning = true;
    const WorkspaceFields found = fields(plan(sweep));
    const Survey<double> survey = test::survey(mechanism(), parameters(), plan(sweep), demand);
    EXPECT_NEAR(mean(found.field("conditioning").values), weighted_mean(survey.weight, survey.conditioning), 1e-9);
    EXPECT_EQ(found.find("dci_1") != nullptr, info().has_dynamics);
    if (!info().has_dynamics) continue;
    Demand inertia;
    inertia.dci = inertia.inertia_condition = true;
    const Survey<double> coupled = test::survey(mechanism(), parameters(), plan(sweep), inertia);
    for (const char* const limb : {"1", "2", "3", "4", "worst"})
      EXPECT_NEAR(mean(found.field(std::string("dci_") + limb).values),
                  weighted_mean(coupled.weight, coupling_of(coupled, limb)), 1e-9)
          << limb;
    EXPECT_NEAR(mean(found.field("inertia_condition").values), weighted_mean(coupled.weight, coupled.inertia_condition),
                1e-9);
  }
}

TEST_P(WorkspaceFieldsContract, JointsAreThoseOfTheInverseKinematics) {
  const WorkspaceFields found = fields(plan(sweeps_of(info()).front()));
  for (std::size_t cell = 0; cell < found.cells(); ++cell) {
    if (!(found.field("feasible").values[cell] > 0)) continue;
    const auto report = mechanism().inspect(parameters(), found.pose(cell), info().modes.front(), no_limits(info()));
    for (std::size_t i = 0; i < 4; ++i)
      ASSERT_EQ(found.field(info().joints[i]).values[cell], (*report.joints)[i]) << cell;
  }
}

TEST_P(WorkspaceFieldsContract, BitsDoNotDependOnThreads) {
  const WorkspaceFields alone = fields(plan(sweeps_of(info()).front()));
  WorkspaceFields shared;
  with_team(3, [&] { shared = fields(plan(sweeps_of(info()).front())); });
  ASSERT_EQ(shared.fields.size(), alone.fields.size());
  for (std::size_t f = 0; f < alone.fields.size(); ++f)
    for (std::size_t cell = 0; cell < alone.cells(); ++cell) {
      const double a = alone.fields[f].values[cell], b = shared.fields[f].values[cell];
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << alone.fields[f].name << " of cell " << cell;
    }
}

TEST_P(WorkspaceFieldsContract, ParametersOfNoMechanismAreRefused) {
  auto wrong = parameters();
  wrong[0] = info().parameters[0].lower - 1;
  EXPECT_THROW(workspace_fields(mechanism(), wrong, plan(sweeps_of(info()).front()), ""), std::invalid_argument);
}

/// Every edge lies in two triangles, which run along it in opposite directions.
void expect_closed(const Isosurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const auto& [a, b, c] : surface.triangles)
    for (const auto& edge : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) ++runs[edge];
  for (const auto& [edge, times] : runs) {
    ASSERT_EQ(times, 1) << edge.first << ' ' << edge.second;
    ASSERT_EQ(runs.count({edge.second, edge.first}), 1u) << edge.first << ' ' << edge.second;
  }
}

TEST_P(WorkspaceFieldsContract, SurfaceIsClosedFacesOutwardsAndEnclosesWhatCellsCount) {
  for (const Sweep& sweep : sweeps_of(info()))
    for (const bool is_cut : {false, true}) {
      SCOPED_TRACE("held coordinate " + std::to_string(sweep.held) + (is_cut ? ", cut by a box" : ""));
      SurveyPlan fine = is_cut ? cut(plan(sweep)) : plan(sweep);
      for (auto& cells : fine.cells) cells *= 2;
      const WorkspaceFields found = fields(fine);
      EXPECT_EQ(found.touches_box, is_cut);
      const PoseMargin margin(mechanism(), parameters(), fine.limits);
      const Isosurface coarse = isosurface(found), surface = isosurface(found, &margin);
      EXPECT_NEAR(coarse.volume() / surface.volume(), 1, 0.06);
      EXPECT_EQ(coarse.triangles, surface.triangles);
      ASSERT_GT(surface.triangles.size(), 100u);
      ASSERT_EQ(surface.cell.size(), surface.vertices.size());
      expect_closed(surface);
      // Cells along the surface count whole or not at all.
      EXPECT_NEAR(surface.volume() / found.volume, 1, 0.06);
      const VoxelGrid grid = found.grid();
      for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        ASSERT_GT(found.field("feasible").values[surface.cell[v]], 0) << v;
        const Pose<double> pose = found.pose(surface.cell[v]);
        const double at[4] = {pose.x, pose.y, pose.z, pose.angle};
        for (std::size_t i = 0; i < 3; ++i) {
          ASSERT_LE(std::fabs(surface.vertices[v][i] - at[found.axes[i].coordinate]), 1.0001 * grid.step[i]) << v;
          ASSERT_GE(surface.vertices[v][i], grid.lower[i]);
          ASSERT_LE(surface.vertices[v][i], grid.upper[i]);
        }
      }
    }
}

INSTANTIATE_TEST_SUITE_P(All, WorkspaceFieldsContract, testing::ValuesIn(all_mechanisms()),
                         [](const auto& mechanism) { return test::test_name(mechanism.param->info().name); });

}  // namespace
}  // namespace pkm
