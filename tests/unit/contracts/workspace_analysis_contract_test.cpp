// Contract of the workspace analysis, for every mechanism of the catalogue, of tests/own_mechanisms and from files, as
// far as it supports the tested capability.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/problem/expression.hpp"
#include "engine/workspace/cellwise_voxels.hpp"
#include "tests/unit/contracts/mechanism_contract.hpp"

namespace pkm {
namespace {

using test::survey;

class WorkspaceAnalysisContract : public MechanismContract {};

/// The mechanism's own, faster voxel evaluator finds the same cells as the generic one, which tests every cell.
TEST_P(WorkspaceAnalysisContract, VoxelAnalysisEqualsTestingEveryCell) {
  for (const Sweep& sweep : test::sweeps(mechanism())) {
    SCOPED_TRACE(test::words(info(), sweep));
    WorkspacePlan plan = test::voxels(info(), sweep, 11);
    plan.limits = workspace_limits(info(), plan.limits);
    const VoxelMap map = voxel_map(mechanism(), parameters(), plan);
    VoxelOptions voxels = *plan.voxels();
    voxels.box.emplace();
    for (std::size_t i = 0; i < 3; ++i) (*voxels.box)[i] = {map.lower[i], map.upper[i]};
    EXPECT_EQ(prepare_cellwise_voxels(mechanism(), plan, voxels, {})->map(parameters()).feasible, map.feasible);
    const FieldRequest request = test::request_of_all_fields(mechanism());
    const WorkspaceResult<double> fast = survey(mechanism(), parameters(), plan, request);
    WorkspaceResult<double> plain;
    evaluate_once<double>(*prepare_cellwise_voxels(mechanism(), plan, voxels, request), parameters(), plain);
    EXPECT_EQ(plain.cells, fast.cells);
    EXPECT_EQ(plain.feasible_cells, fast.feasible_cells);
    EXPECT_NEAR(plain.volume / fast.volume, 1, 1e-12);
    const auto expect_same_mean = [&](const std::vector<double>& a, const std::vector<double>& b) {
      EXPECT_NEAR(weighted_mean(plain.weight, a), weighted_mean(fast.weight, b), 1e-9);
    };
    for (const PoseQuantity* const quantity : request.fields)
      for (std::size_t i = 0; i < (quantity->per_joint ? info().joints.size() : 1); ++i) {
        SCOPED_TRACE(quantity->name);
        EXPECT_GT(fast.field(*quantity, i).size(), 0u);
        expect_same_mean(plain.field(*quantity, i), fast.field(*quantity, i));
      }
  }
}

TEST_P(WorkspaceAnalysisContract, VoxelsConvergeToTheColumns) {
  if (!mechanism().columns()) GTEST_SKIP() << "no columns";
  for (const Sweep& sweep : test::sweeps(mechanism())) {
    if (!test::has_columns(mechanism(), sweep)) continue;
    SCOPED_TRACE(test::words(info(), sweep));
    const double exact = survey(mechanism(), parameters(), test::columns(info(), sweep)).volume;
    ASSERT_GT(exact, 0);
    const auto voxels = [&](std::int64_t cells) {
      return survey(mechanism(), parameters(), test::voxels(info(), sweep, cells)).volume;
    };
    // Tolerance factor by dimension: rounding to whole cells averages out in a volume, less in an area, not in a
    // length.
    const double factors[] = {2, 1.2, 1};
    EXPECT_NEAR(voxels(30) / exact, 1, factors[sweep.swept.size() - 1] * 0.05);
    EXPECT_NEAR(voxels(240) / exact, 1, factors[sweep.swept.size() - 1] * 0.005);
  }
}

TEST_P(WorkspaceAnalysisContract, ColumnsAreClippedByABoxOrRejectIt) {
  if (!mechanism().columns()) GTEST_SKIP() << "no columns";
  for (const Sweep& sweep : test::sweeps(mechanism())) {
    if (!test::has_columns(mechanism(), sweep)) continue;
    SCOPED_TRACE(test::words(info(), sweep));
    const VoxelMap all = voxel_map(mechanism(), parameters(), test::voxels(info(), sweep, 1));
    Box box;
    for (std::size_t k = 0; k < 3; ++k) box[k] = {all.lower[k], all.upper[k]};
    WorkspacePlan columns = test::columns(info(), sweep);
    const double whole = survey(mechanism(), parameters(), columns).volume;
    columns.method = ColumnOptions{.tolerance = 1e-8, .nodes = {}, .box = box};
    if (!mechanism().columns()->supports_box()) {
      EXPECT_THROW(prepare_workspace(mechanism(), columns, {}), std::invalid_argument);
      continue;
    }
    EXPECT_NEAR(survey(mechanism(), parameters(), columns).volume / whole, 1, 1e-7);
    box[0][1] = (box[0][0] + box[0][1]) / 2;
    std::get<ColumnOptions>(columns.method).box = box;
    WorkspacePlan voxels = test::voxels(info(), sweep, 90);
    std::get<VoxelOptions>(voxels.method).box = box;
    const double cut = survey(mechanism(), parameters(), columns).volume;
    EXPECT_LT(cut, 0.9 * whole);
    EXPECT_NEAR(survey(mechanism(), parameters(), voxels).volume, cut, 0.03 * cut);  // may be empty
  }
}

TEST_P(WorkspaceAnalysisContract, InactiveLimitsLieInTheirRangeAndDoNotReduceTheWorkspace) {
  for (const Sweep& sweep : test::sweeps(mechanism()))
    for (WorkspacePlan& p : test::plans(mechanism(), sweep, 30)) {
      if (info().limits.empty()) continue;
      const auto free = survey(mechanism(), parameters(), p);
      for (std::size_t i = 0; i < info().limits.size(); ++i) {
        const LimitInfo& limit = info().limits[i];
        EXPECT_LE(limit.lower, limit.inactive) << limit.name;
        EXPECT_LE(limit.inactive, limit.upper) << limit.name;
        p.limits = no_limits(info());
        p.limits.given[i] = limit.inactive;
        const auto limited = survey(mechanism(), parameters(), p);
        EXPECT_EQ(limited.feasible_cells, free.feasible_cells) << limit.name;
        EXPECT_NEAR(limited.volume / free.volume, 1, 1e-8) << limit.name;
      }
    }
}

TEST_P(WorkspaceAnalysisContract, InfeasibleLimitsGiveAnEmptyWorkspace) {
  if (info().limits.empty()) GTEST_SKIP() << "no limits";
  for (const Sweep& sweep : test::sweeps(mechanism()))
    for (WorkspacePlan& p : test::plans(mechanism(), sweep, 10)) {
      p.limits = test::infeasible_limits(mechanism(), p);
      if (p.limits.given == no_limits(info()).given) continue;  // columns do not support the only limit, a clearance
      const auto empty = survey(mechanism(), parameters(), p, test::request_without_inertia(mechanism()));
      EXPECT_EQ(empty.volume, 0);
      EXPECT_EQ(empty.feasible_cells, 0);
      EXPECT_FALSE(empty.touches_box);
      EXPECT_TRUE(std::isfinite(empty.error));
    }
}

/// Exponent of the metre in a unit such as "m^2 rad".
int length_exponent(const std::string& unit) {
  if (unit.starts_with("m^")) return unit[2] - '0';
  return unit == "m" || unit.starts_with("m ") ? 1 : 0;
}

TEST_P(WorkspaceAnalysisContract, ScalingAllLengthsScalesTheVolumeByTheExponentOfItsUnit) {
  constexpr double kScale = 4;  // a power of two: exact, so that no cell centre changes its side of a limit by rounding
  auto larger = parameters();
  for (std::size_t i = 0; i < larger.size(); ++i)
    if (info().parameters[i].unit == "m") larger[i] *= kScale;
  if (const Size* const size = mechanism().size()) {
    EXPECT_NEAR(size->of(larger) / size->of(parameters()), std::pow(kScale, length_exponent(size->unit())), 1e-12);
  }
  for (const Sweep& sweep : test::sweeps(mechanism())) {
    SCOPED_TRACE(test::words(info(), sweep));
    const WorkspacePlan p = test::best_plan(mechanism(), sweep);
    const FieldRequest request = test::request_without_inertia(mechanism());
    const auto small = survey(mechanism(), parameters(), p, request), large = survey(mechanism(), larger, p, request);
    EXPECT_NEAR(large.volume / small.volume, std::pow(kScale, length_exponent(volume_unit(info(), p))), 1e-7);
    ASSERT_EQ(large.field(kConditioning).size(), small.field(kConditioning).size());
    for (std::size_t i = 0; i < small.field(kConditioning).size(); ++i)
      EXPECT_NEAR(large.field(kConditioning)[i], small.field(kConditioning)[i], 1e-7) << i;
  }
}

TEST_P(WorkspaceAnalysisContract, ExpressionNamesAreDistinctAndHaveTheRightValues) {
  const auto design = parameters();
  std::set<std::string> distinct;
  const std::vector<AnalysisResult> results = analysis_results(info());
  for (const ExpressionName& known : expression_names(mechanism(), test::best_plan(mechanism()))) {
    SCOPED_TRACE(known.name);
    using Origin = ExpressionName::Origin;
    const AnalysisResult* const result = known.origin == Origin::workspace ? &results[known.index] : nullptr;
    // Formulas are many, and the generic engine evaluates them.
    const bool is_formula = result && result->quantity && result->quantity->formula;
    const WorkspacePlan p = is_formula ? test::voxels(info(), 7) : test::best_plan(mechanism());
    EXPECT_TRUE(distinct.insert(known.name).second) << "twice";
    EXPECT_NE(known.unit, "");
    EXPECT_NE(known.meaning, "");
    Options options = default_options(expression_options());
    options.set("expression", known.name);
    const EntryContext context{mechanism(), p, options};
    const Expression expression(context);
    FieldRequest request;
    expression.add_request(context, request);
    const auto found = survey(mechanism(), design, p, request);
    Scratch scratch;
    std::vector<double> thresholds(info().limits.size());
    mechanism().thresholds(design, p.limits, thresholds);
    EXPECT_EQ(expression.needs_workspace(), known.origin == Origin::workspace);
    const double expected = known.origin == Origin::parameter   ? design[known.index]
                            : known.origin == Origin::threshold ? thresholds[known.index]
                            : known.origin == Origin::size      ? mechanism().size()->of(design)
                                                                : result->value(found, 1, scratch);
    EXPECT_EQ(expression.value(DesignView<double>{mechanism(), design, &found, scratch}), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(All, WorkspaceAnalysisContract, testing::ValuesIn(test::mechanisms_and_files()),
                         [](const auto& name) { return test::test_name(name.param); });

}  // namespace
}  // namespace pkm
