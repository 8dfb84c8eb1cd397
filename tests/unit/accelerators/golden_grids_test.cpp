// Accelerators of the papers' mechanisms against the generic engine on the golden grids and designs: the same cells,
// the same coupling, the same volumes and derivatives of samples.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "engine/math/statistics.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/accelerators/crr_cru/golden.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"
#include "tests/unit/accelerators/hybrid/golden.hpp"
#include "tests/unit/accelerators/papers.hpp"
#include "tests/unit/workspace/own_inertia.hpp"

namespace pkm {
namespace {

using Json = nlohmann::json;

struct GoldenGrid {
  std::vector<double> design;
  LimitSpec limits;
  VoxelOptions voxels;
  std::vector<FixedCoordinate> fixed;
  std::int64_t feasible;  ///< -1: the golden number counts clearances, too
};

std::array<std::int64_t, 3> cells_of(const Json& x) { return {x[0], x[1], x[2]}; }

class GoldenGrids : public test::PaperPair {
 protected:
  std::vector<GoldenGrid> golden_grids() const {
    std::vector<GoldenGrid> all;
    const LimitSpec none = no_limits(accelerated().info());
    if (GetParam() == "4ppa-2par") {
      for (const Json& entry : testing::golden()["workspace"])
        for (const Json& grid : entry["voxel"])
          all.push_back({testing::design_of(entry),
                         testing::limits_of(entry),
                         {.cells = cells_of(grid["cells"])},
                         {},
                         grid["feasible"]});
      auto paper = testing::nominal();
      all.push_back({paper, none, {.cells = {32, 34, 60}}, {}, 12412});
      for (const auto& [name, value] : std::map<std::string, double>{{"a", 0.3}, {"b", 1}, {"l_u", 0.7}, {"l_d", 0.7}})
        paper[static_cast<std::size_t>(find_named(accelerated().info().parameters, name) -
                                       accelerated().info().parameters.data())] = value;
      all.push_back({paper, none, {.cells = {32, 34, 60}}, {}, 12564});
    } else if (GetParam() == "2t1r-p-hybrid") {
      for (const Json& entry : testing::hybrid::golden()["workspace"])
        for (const Json& grid : entry["grids"]) {
          VoxelOptions voxels{.cells = cells_of(grid["shape"]), .box = Box{}};
          for (std::size_t k = 0; k < 3; ++k) (*voxels.box)[k] = {entry["box"][k][0], entry["box"][k][1]};
          all.push_back({testing::hybrid::design_of(entry), none, voxels, {}, -1});
        }
    } else {
      for (const Json& entry : testing::crr::golden()["dci_stats"]) {
        if (entry["mechanism"] != GetParam()) continue;
        VoxelOptions voxels{.cells = cells_of(entry["n"]), .box = Box{}};
        for (std::size_t k = 0; k < 3; ++k) (*voxels.box)[k] = {entry["lo"][k], entry["hi"][k]};
        all.push_back({testing::crr::design_of(entry),
                       testing::crr::limit_spec(entry["smin"], entry["cmin"]),
                       voxels,
                       {{.coordinate = 3, .kind = FixedCoordinate::Kind::value, .value = entry["phi"]}},
                       entry["feasible"]});
      }
    }
    return all;
  }

  WorkspacePlan plan_of(const GoldenGrid& grid) const {
    return {.method = grid.voxels, .fixed = grid.fixed, .limits = grid.limits};
  }
};

TEST_P(GoldenGrids, HaveTheSameCells) {
  const auto grids = golden_grids();
  ASSERT_GT(grids.size(), 1u);
  for (const GoldenGrid& grid : grids) {
    const WorkspacePlan plan = plan_of(grid);
    const VoxelMap map = voxel_map(accelerated(), grid.design, plan);
    WorkspacePlan same_box = plan;
    VoxelOptions voxels = grid.voxels;
    voxels.box = Box{};
    for (std::size_t k = 0; k < 3; ++k) (*voxels.box)[k] = {map.lower[k], map.upper[k]};
    same_box.method = voxels;
    EXPECT_TRUE(voxel_map(generic(), grid.design, same_box).feasible == map.feasible);
    EXPECT_GT(std::ranges::count(map.feasible, 1), 0);
    const WorkspaceResult<double> survey = test::survey(accelerated(), grid.design, plan);
    EXPECT_EQ(survey.feasible_cells, std::ranges::count(map.feasible, 1));
    if (grid.feasible >= 0) {
      EXPECT_EQ(survey.feasible_cells, grid.feasible);
    }
    EXPECT_NEAR(survey.volume, test::survey(generic(), grid.design, same_box).volume, 1e-12 * survey.volume);
  }
}

/// Of 4PPa-2PaR, whose accelerator knows clearances: the others' are the generic engine's.
TEST_P(GoldenGrids, HaveTheSameCellsUnderAClearance) {
  std::int64_t cut = 0, left = 0;
  for (const double least : {0.0, 0.0041, 0.0207})  // at round numbers, rounding decides of some cells
    for (GoldenGrid& grid : golden_grids()) {
      const auto all = std::ranges::count(voxel_map(generic(), grid.design, plan_of(grid)).feasible, 1);
      for (std::size_t i = 0; i < grid.limits.given.size(); ++i)
        if (accelerated().info().limits[i].group == "clearance") grid.limits.given[i] = least;
      const VoxelMap here = voxel_map(generic(), grid.design, plan_of(grid)),
                     there = voxel_map(accelerated(), grid.design, plan_of(grid));
      EXPECT_TRUE(here.feasible == there.feasible) << least;
      const auto count = std::ranges::count(here.feasible, 1);
      EXPECT_EQ(test::survey(accelerated(), grid.design, plan_of(grid)).feasible_cells, count);
      cut += all - count;
      left += count;
    }
  EXPECT_GT(cut, 0);
  EXPECT_GT(left, 0);
}

TEST_P(GoldenGrids, HaveTheSameCoupling) {
  if (!accelerated().dynamics()) GTEST_SKIP() << "no masses";
  for (const GoldenGrid& grid : golden_grids()) {
    const FieldRequest request{.fields = {&kCouplingIndex, &kInertiaCondition}};
    const WorkspaceResult<double> here = test::survey(generic(), grid.design, plan_of(grid), request),
                                  there = test::survey(accelerated(), grid.design, plan_of(grid), request);
    ASSERT_EQ(here.weight.size(), there.weight.size());
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(weighted_mean(here.weight, here.field(kCouplingIndex, i)),
                  weighted_mean(there.weight, there.field(kCouplingIndex, i)), 1e-10);
      EXPECT_NEAR(weighted_standard_deviation(here.weight, here.field(kCouplingIndex, i)),
                  weighted_standard_deviation(there.weight, there.field(kCouplingIndex, i)), 1e-8);
      EXPECT_NEAR(weighted_quantile(here.weight, here.field(kCouplingIndex, i), 0.95),
                  weighted_quantile(there.weight, there.field(kCouplingIndex, i), 0.95), 1e-8);
    }
    EXPECT_NEAR(weighted_mean(here.weight, here.field(kInertiaCondition)),
                weighted_mean(there.weight, there.field(kInertiaCondition)), 1e-10);
  }
}

/// Of random designs with and without limits, as far as the generic engine's error estimate promises.
TEST_P(GoldenGrids, HaveTheSameExactVolumesForRandomDesigns) {
  const MechanismInfo& info = accelerated().info();
  Stream random(13, 0, 0, Stream::Use::start);
  WorkspacePlan plan = test::columns(info);
  Scratch scratch;
  WorkspaceResult<double> mine, theirs;
  int compared = 0, exact = 0;
  for (int i = 0; i < 100; ++i) {
    const std::vector<double> design = i == 0 ? test::nominal(info) : test::random_design(info, random);
    plan.limits = i % 2 == 0 ? no_limits(info) : test::random_limits(info, random);
    for (std::size_t k = 0; k < info.limits.size(); ++k)
      if (info.limits[k].group == "clearance") plan.limits.given[k].reset();
    prepare_workspace(generic(), plan, {})->evaluate(design, scratch, mine);
    prepare_workspace(accelerated(), plan, {})->evaluate(design, scratch, theirs);
    SCOPED_TRACE("design " + std::to_string(i));
    EXPECT_NEAR(mine.volume, theirs.volume, (1e-7 + mine.error + theirs.error) * theirs.volume + 1e-12);
    compared += theirs.volume > 0;
    exact += theirs.volume > 0 && mine.error < 1e-7;
  }
  EXPECT_GT(compared, 30);
  EXPECT_GT(exact, 0.95 * compared);
}

/// Along four directions of all parameters. The nodes of the two differ.
TEST_P(GoldenGrids, HaveTheSameDerivativesOfSamples) {
  const MechanismInfo& info = accelerated().info();
  if (GetParam() != "3crr-r-cru") GTEST_SKIP() << "the mean is infinite, or takes more nodes along other coordinates";
  // Far from where limbs stretch and fold, and inertia runs to infinity.
  static const std::map<std::string, double> limits = {{"s_min", 0.3}, {"c_min", 0.2}};
  WorkspacePlan plan = test::columns(info, {.nodes = {24, 24}});
  for (std::size_t i = 0; i < info.limits.size(); ++i)
    if (const auto limit = limits.find(info.limits[i].name); limit != limits.end())
      plan.limits.given[i] = limit->second;
  Stream random(17, 0, 0, Stream::Use::start);
  std::vector<Dual4> moving;  // beside the nominal design, where nothing is symmetric
  for (const double p : test::nominal(info)) {
    moving.emplace_back(p * (1 + 0.02 * random.u01()));
    for (int k = 0; k < 4; ++k) moving.back().v[k] = (2 * random.u01() - 1) * p;
  }
  const FieldRequest request{.fields = {&test::kOwnInertia}};
  WorkspaceResult<Dual4> mine, theirs;
  evaluate_once<Dual4>(*prepare_workspace(generic(), plan, request), moving, mine);
  evaluate_once<Dual4>(*prepare_workspace(accelerated(), plan, request), moving, theirs);
  for (std::size_t joint = 0; joint < info.joints.size(); ++joint) {
    const Dual4 here = weighted_mean(mine.weight, mine.field(test::kOwnInertia, joint)),
                there = weighted_mean(theirs.weight, theirs.field(test::kOwnInertia, joint));
    EXPECT_GT(there.a, 0);
    EXPECT_NEAR(here.a / there.a, 1, 1e-6);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(here.v[k] / there.a, there.v[k] / there.a, 1e-6) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(All, GoldenGrids, test::kPapers, [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
