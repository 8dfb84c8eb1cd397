// Contract of workspace fields (the data of pictures and exports): they agree with the workspace analysis, for every
// mechanism and each of its sweeps; and the isosurface computed from them encloses the feasible cells.
#include <gtest/gtest.h>

#include <map>

#include "engine/core/catalogue.hpp"
#include "engine/core/team.hpp"
#include "engine/export/isosurface.hpp"
#include "engine/math/statistics.hpp"
#include "engine/problem/pose_options.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/export/enclosed_volume.hpp"

namespace pkm {
namespace {

class WorkspaceFieldsContract : public testing::TestWithParam<MechanismList::value_type> {
 protected:
  const Mechanism& mechanism() const { return *GetParam(); }
  const MechanismInfo& info() const { return mechanism().info(); }
  std::vector<double> parameters() const { return test::nominal(info()); }
  std::vector<Sweep> sweeps() const { return test::sweeps(mechanism()); }
  /// Voxel plan of a sweep with 12, 13 and 14 cells along its axes, each multiplied by `finer`.
  WorkspacePlan plan(const Sweep& sweep, std::int64_t finer = 1) const {
    WorkspacePlan plan = test::voxels(info(), sweep, 0);
    VoxelOptions& voxels = std::get<VoxelOptions>(plan.method);
    for (std::size_t i = 0; i < sweep.swept.size(); ++i) voxels.cells[i] = finer * (12 + static_cast<std::int64_t>(i));
    return plan;
  }
  WorkspacePlan default_plan() const { return plan(info().sweeps.front()); }
  WorkspaceFields fields(const WorkspacePlan& plan) const {
    return workspace_fields(mechanism(), parameters(), plan, "");
  }
  /// The plan with a box slightly smaller than the bounding box of the feasible cells: each face cuts some off.
  WorkspacePlan cut(WorkspacePlan plan) const {
    const WorkspaceFields whole = fields(plan);
    const VoxelGrid grid = whole.grid();
    Box& box = std::get<VoxelOptions>(plan.method).box.emplace();
    box.fill({1e9, -1e9});
    for (std::size_t cell = 0; cell < whole.cells(); ++cell) {
      if (!(whole.field("feasible").values[cell] > 0)) continue;
      const Pose<double> pose = whole.pose(cell);
      for (std::size_t i = 0; i < 3; ++i) {
        const double at = pose[static_cast<std::size_t>(whole.axes[i].coordinate)];
        auto& [lower, upper] = box[i];
        lower = std::fmin(lower, at + 0.7 * grid.step[i]);
        upper = std::fmax(upper, at - 0.7 * grid.step[i]);
      }
    }
    return plan;
  }
};

TEST_P(WorkspaceFieldsContract, FeasibleCellsEqualTheVoxelMapAndTheSignsOfMargins) {
  for (const Sweep& sweep : sweeps()) {
    SCOPED_TRACE(test::words(info(), sweep));
    const WorkspaceFields found = fields(plan(sweep));
    const VoxelMap map = voxel_map(mechanism(), parameters(), plan(sweep));
    const auto& feasible = found.field("feasible").values;
    ASSERT_EQ(feasible.size(), map.feasible.size());
    std::int64_t cells = 0;
    const WorkspaceField& conditioning = found.field("conditioning");
    const bool conditioned = !info().characteristic_length.empty();
    for (std::size_t cell = 0; cell < feasible.size(); ++cell) {
      ASSERT_EQ(feasible[cell], map.feasible[cell]) << cell;
      ASSERT_EQ(found.field("margin").values[cell] > 0, feasible[cell] > 0) << cell;
      ASSERT_EQ(std::isnan(conditioning.values[cell]), feasible[cell] == 0 || !conditioned) << cell;
      cells += map.feasible[cell];
    }
    EXPECT_GT(100 * cells, std::ssize(feasible));
    const WorkspaceResult<double> survey = test::survey(mechanism(), parameters(), plan(sweep));
    EXPECT_EQ(cells, survey.feasible_cells);
    EXPECT_NEAR(found.volume / survey.volume, 1, 1e-12);
    EXPECT_EQ(found.volume_unit, unit_of_product(info(), sweep.swept));
    ASSERT_EQ(found.fixed.size(), sweep.fixed.size());
    for (std::size_t i = 0; i < sweep.fixed.size(); ++i) EXPECT_EQ(found.fixed[i].coordinate, sweep.fixed[i]);
  }
}

TEST_P(WorkspaceFieldsContract, FixedCoordinatesHaveDefaultValuesUnlessThePlanGivesValues) {
  for (const Sweep& sweep : sweeps()) {
    SCOPED_TRACE(test::words(info(), sweep));
    if (sweep.fixed.empty()) continue;
    const WorkspaceFields found = fields(plan(sweep));
    WorkspacePlan with_values = plan(sweep);
    for (std::size_t i = 0; i < sweep.fixed.size(); ++i) {
      const double value = *mechanism().default_value(parameters(), sweep.fixed[i]);
      EXPECT_EQ(found.fixed[i].lower, value);
      with_values.fixed[i] = {sweep.fixed[i], FixedCoordinate::Kind::value, value};
    }
    EXPECT_EQ(fields(with_values).field("feasible").values, found.field("feasible").values);
    EXPECT_NE(fields(with_values).fixed_note, found.fixed_note);
  }
}

TEST_P(WorkspaceFieldsContract, ColumnPlansAreSampledByVoxels) {
  if (!mechanism().columns()) GTEST_SKIP() << "no columns";
  const WorkspaceFields found = fields(test::columns(info()));
  for (const WorkspaceAxis& axis : found.axes) EXPECT_EQ(axis.cells, kPictureCells);
  EXPECT_GT(found.volume, 0);
  if (info().sweeps.front().integrates) {
    WorkspacePlan integrated = test::columns(info());
    integrated.fixed[0].kind = FixedCoordinate::Kind::integrated;
    const WorkspaceFields fixed = fields(integrated);
    EXPECT_EQ(fixed.fixed[0].lower, found.fixed[0].lower);
    EXPECT_NE(fixed.fixed_note, found.fixed_note);
    EXPECT_EQ(fixed.volume, found.volume);
  }
}

TEST_P(WorkspaceFieldsContract, ConditioningAndCouplingHaveTheMeansOfTheWorkspaceAnalysis) {
  if (info().characteristic_length.empty()) GTEST_SKIP() << "no conditioning";
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0;
    std::size_t n = 0;
    for (const double value : values)
      if (!std::isnan(value)) sum += value, ++n;
    return sum / static_cast<double>(n);
  };
  for (const Sweep& sweep : sweeps()) {
    SCOPED_TRACE(test::words(info(), sweep));
    FieldRequest request;
    request.add(kConditioning);
    const WorkspaceFields found = fields(plan(sweep));
    const WorkspaceResult<double> survey = test::survey(mechanism(), parameters(), plan(sweep), request);
    EXPECT_NEAR(mean(found.field("conditioning").values), weighted_mean(survey.weight, survey.field(kConditioning)),
                1e-9);
    EXPECT_EQ(found.find("dci_1") != nullptr, mechanism().dynamics() != nullptr);
    if (!mechanism().dynamics()) continue;
    FieldRequest inertia;
    inertia.fields = {&kCouplingIndex, &kInertiaCondition};
    const WorkspaceResult<double> coupled = test::survey(mechanism(), parameters(), plan(sweep), inertia);
    Scratch scratch;
    std::vector<std::string> limbs = {"worst"};
    for (std::size_t i = 1; i <= info().joints.size(); ++i) limbs.push_back(std::to_string(i));
    for (const std::string& limb : limbs)
      EXPECT_NEAR(mean(found.field("dci_" + limb).values),
                  weighted_mean(coupled.weight, reduced_field(coupled, kCouplingIndex, limb, scratch)), 1e-9)
          << limb;
    EXPECT_NEAR(mean(found.field("inertia_condition").values),
                weighted_mean(coupled.weight, coupled.field(kInertiaCondition)), 1e-9);
  }
}

TEST_P(WorkspaceFieldsContract, JointsEqualTheInverseKinematics) {
  const WorkspaceFields found = fields(default_plan());
  for (std::size_t cell = 0; cell < found.cells(); ++cell) {
    if (!(found.field("feasible").values[cell] > 0)) continue;
    const auto report = mechanism().inspect(parameters(), found.pose(cell), info().modes.front(), no_limits(info()));
    for (std::size_t i = 0; i < info().joints.size(); ++i)
      ASSERT_EQ(found.field(info().joints[i].name).values[cell], (*report.joints)[i]) << cell;
  }
}

TEST_P(WorkspaceFieldsContract, BitsDoNotDependOnThreads) {
  const WorkspaceFields alone = fields(default_plan());
  WorkspaceFields shared;
  with_team(3, [&] { shared = fields(default_plan()); });
  ASSERT_EQ(shared.fields.size(), alone.fields.size());
  for (std::size_t f = 0; f < alone.fields.size(); ++f)
    for (std::size_t cell = 0; cell < alone.cells(); ++cell) {
      const double a = alone.fields[f].values[cell], b = shared.fields[f].values[cell];
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << alone.fields[f].name << " of cell " << cell;
    }
}

TEST_P(WorkspaceFieldsContract, InvalidParametersAreRejected) {
  auto wrong = parameters();
  wrong[0] = info().parameters[0].lower - 1;
  EXPECT_THROW(workspace_fields(mechanism(), wrong, default_plan(), ""), std::invalid_argument);
}

/// Expects a closed, consistently oriented surface: every edge belongs to two triangles, with opposite directions.
void expect_closed(const Isosurface& surface) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const auto& [a, b, c] : surface.triangles)
    for (const auto& edge : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) ++runs[edge];
  for (const auto& [edge, times] : runs) {
    ASSERT_EQ(times, 1) << edge.first << ' ' << edge.second;
    ASSERT_EQ(runs.count({edge.second, edge.first}), 1u) << edge.first << ' ' << edge.second;
  }
}

TEST_P(WorkspaceFieldsContract, SurfaceIsClosedOrientedOutwardsAndEnclosesTheVoxelVolume) {
  const auto [first, last] = std::pair(sweeps().front(), sweeps().back());
  // The generic cell-by-cell evaluator treats all sweeps alike: test the first and the last, of one coordinate.
  for (const Sweep& sweep : mechanism().voxels() ? sweeps() : std::vector<Sweep>{first, last})
    for (const bool is_cut : {false, true}) {
      SCOPED_TRACE(test::words(info(), sweep) + (is_cut ? ", cut by a box" : ""));
      WorkspacePlan fine = plan(sweep, 2);
      if (is_cut) std::get<VoxelOptions>(fine.method).box = cut(plan(sweep)).box();
      const WorkspaceFields found = fields(fine);
      if (sweep.swept.size() < 3) {
        EXPECT_TRUE(surface_unsupported(names_of(found.axes)));
        EXPECT_THROW(isosurface(found), std::invalid_argument);
        break;
      }
      EXPECT_EQ(found.touches_box, is_cut);
      const PoseMargin margin(mechanism(), parameters(), fine.limits);
      const Isosurface coarse = isosurface(found), surface = isosurface(found, &margin);
      EXPECT_NEAR(test::enclosed_volume(coarse) / test::enclosed_volume(surface), 1, 0.06);
      EXPECT_EQ(coarse.triangles, surface.triangles);
      ASSERT_GT(surface.triangles.size(), 100u);
      ASSERT_EQ(surface.inside.size(), surface.vertices.size());
      expect_closed(surface);
      // The voxel volume counts boundary cells either completely or not at all.
      EXPECT_NEAR(test::enclosed_volume(surface) / found.volume, 1, 0.06);
      const VoxelGrid grid = found.grid();
      Scratch scratch;
      for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
        ASSERT_GE(margin(found.pose(surface.inside[v]), scratch), -1e-12) << v;
        for (std::size_t i = 0; i < 3; ++i) {
          ASSERT_LE(std::fabs(surface.vertices[v][i] - surface.inside[v][i]), 1.0001 * grid.step[i]) << v;
          ASSERT_GE(surface.vertices[v][i], grid.lower[i]);
          ASSERT_LE(surface.vertices[v][i], grid.upper[i]);
        }
      }
    }
}

INSTANTIATE_TEST_SUITE_P(All, WorkspaceFieldsContract, testing::ValuesIn(test::mechanisms()),
                         [](const auto& mechanism) { return test::test_name(mechanism.param->info().name); });

}  // namespace
}  // namespace pkm
