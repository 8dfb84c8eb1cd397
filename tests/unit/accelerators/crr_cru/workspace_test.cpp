// Columns and voxels of (3CRR/R)&CRU and the Quadrupteron against the generic engine, against each other and against
// other orders of integration, on random designs with and without limits, for every coordinate that may be fixed.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/crr_cru/columns.hpp"
#include "engine/accelerators/crr_cru/voxels.hpp"
#include "engine/math/statistics.hpp"
#include "engine/workspace/voxel_grid.hpp"
#include "tests/unit/accelerators/crr_cru/states.hpp"

namespace pkm::testing::crr {
namespace {

struct Case {
  std::string name;
  std::vector<double> p;
  LimitSpec limits;
  int held;
  double value;
};

/// Random designs of both mechanisms, every second one with limits, with each of the coordinates fixed in turn. With a
/// large `share` the rods of one limb may differ in length by a factor.
std::vector<Case> random_cases(int count, int seed, double share = 0.25) {
  Uniform uniform(seed);
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    Case c{both()[static_cast<std::size_t>(i / 4 % 2)], random_design(uniform, share), limit_spec(0, 0), i % 4, 0};
    if (i % 2 == 1) c.limits = limit_spec(uniform(0, 0.5), uniform(0, 0.5));
    c.value = c.held == 3 ? uniform(-1, 1) : uniform(0.05, 0.35);
    cases.push_back(c);
  }
  return cases;
}

std::string text(const Case& c) {
  return c.name + ", fixed " + std::to_string(c.held) + " at " + std::to_string(c.value);
}

FixedCoordinate fixed_of(const Case& c) {
  return {.coordinate = c.held, .kind = FixedCoordinate::Kind::value, .value = c.value};
}

Design<double> design_of_case(const Case& c) { return design(geometry_of(c.name, c.p), limits(c.limits)); }

WorkspacePlan voxels(const Case& c, std::array<std::int64_t, 3> cells, const std::optional<Box>& box = {}) {
  return plan(VoxelOptions{.cells = cells, .box = box}, c.held, c.value, c.limits);
}

WorkspacePlan columns(const Case& c, double tolerance = 1e-10) {
  return plan(ColumnOptions{.tolerance = tolerance}, c.held, c.value, c.limits);
}

TEST(CrrCruVoxels, CountsFromRowsEqualTheGenericEngines) {
  std::int64_t total = 0;
  for (const Case& c : random_cases(64, 1)) {
    SCOPED_TRACE(text(c));
    for (const std::array<std::int64_t, 3>& cells :
         {std::array<std::int64_t, 3>{13, 16, 18}, {9, 131, 64}, {70, 3, 65}}) {
      const WorkspacePlan p = voxels(c, cells);
      const Box box = default_box(design_of_case(c), fixed_of(c));
      const VoxelMap map = voxel_map(mechanism(c.name), c.p, p),
                     expected = voxel_map(generic_engine(c.name), c.p, voxels(c, cells, box));
      EXPECT_TRUE(map.feasible == expected.feasible);
      WorkspaceResult<double> sum;
      summarise(VoxelGrid(cells, box), expected, sum);
      const auto found = survey(c.name, c.p, p);
      EXPECT_EQ(found.feasible_cells, sum.feasible_cells);
      EXPECT_EQ(found.volume, sum.volume);
      EXPECT_EQ(found.touches_box, sum.touches_box);
      total += found.feasible_cells;
    }
  }
  EXPECT_GT(total, 100000) << "the random designs should have workspaces";
}

TEST(CrrCruVoxels, ReportWhetherFeasibleCellsTouchTheGivenBox) {
  Case c{"3crr-r-cru", nominal(), limit_spec(0, 0), 3, 0};
  const auto in = [&](const Box& box) { return survey(c.name, c.p, voxels(c, {40, 40, 40}, box)); };
  const auto whole = in({{{-0.1, 0.5}, {-0.1, 0.5}, {-0.1, 0.5}}});
  EXPECT_FALSE(whole.touches_box);
  EXPECT_NEAR(whole.volume / survey(c.name, c.p, columns(c)).volume, 1, 0.02);
  EXPECT_TRUE(in({{{0.1, 0.2}, {-0.1, 0.5}, {-0.1, 0.5}}}).touches_box);
}

// A box beyond the branch cos(phi + delta) >= 0 adds no pose.
TEST(CrrCruVoxels, PosesOfTheOtherBranchDoNotCount) {
  for (const std::string& name : both()) {
    Case c{name, nominal(), limit_spec(0, 0), 0, 0.2};
    const WorkspacePlan quarter = voxels(c, {20, 20, 30}, Box{{{0, 0.4}, {0, 0.42}, {-kPi / 2, kPi / 2}}});
    const WorkspacePlan half = voxels(c, {20, 20, 60}, Box{{{0, 0.4}, {0, 0.42}, {-kPi, kPi}}});
    EXPECT_GT(survey(name, c.p, quarter).feasible_cells, 0);
    EXPECT_EQ(survey(name, c.p, half).feasible_cells, survey(name, c.p, quarter).feasible_cells);
  }
}

TEST(CrrCruVoxels, PositionSetsAndInspectionAgree) {
  int inside = 0;
  Uniform uniform(3);
  for (const Case& c : random_cases(60, 3)) {
    const Design<double> d = design_of_case(c);
    for (int i = 0; i < 300; ++i) {
      const Pose<double> pose{uniform(-0.05, 0.45), uniform(-0.05, 0.45), uniform(0, 0.45), uniform(-2, 2)};
      const bool feasible = in_position_set(d, position_set(d, pose.angle), {pose.x, pose.y, pose.z});
      inside += feasible;
      for (const char* mode : {"-,-,+,-", "+,+,-,+"}) {
        const PoseReport r = generic_engine(c.name).inspect(c.p, pose, mode, c.limits);
        EXPECT_EQ(r.feasible, feasible) << r.reason;
        EXPECT_EQ(r.reason.empty(), r.feasible);
      }
    }
  }
  EXPECT_GT(inside, 1000);
}

// Closed-form areas against a fine midpoint sum over both axes of the slice, which uses no critical values, and against
// the exact lengths of columns.
TEST(CrrCruColumns, SlicesEqualTheSumOfTheirCells) {
  int positive = 0;
  for (const Case& c : random_cases(120, 4, 0.4)) {
    SCOPED_TRACE(text(c));
    const auto s = sliced_design(design_of_case(c), fixed_of(c));
    const double outer = s.axes.outer_is_phi ? 0.3 : 0.17;
    const PositionSet<double> f = s.axes.outer_is_phi ? position_set(s.design, outer) : s.positions;
    ColumnScratch<double> scratch;
    constexpr int kSteps = 1000;
    const double u0 = f.range[s.axes.u].lower, u1 = f.range[s.axes.u].upper, v0 = f.range[s.axes.v].lower,
                 v1 = f.range[s.axes.v].upper;
    if (!(u1 > u0)) continue;
    std::int64_t cells = 0;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        Vector3<double> at;
        at[s.axes.normal] = s.axes.outer_is_phi ? s.fixed : outer;
        at[s.axes.u] = u0 + (u1 - u0) * (i + 0.5) / kSteps;
        at[s.axes.v] = v0 + (v1 - v0) * (j + 0.5) / kSteps;
        cells += in_position_set(s.design, f, at);
      }
    const double whole = (u1 - u0) * (v1 - v0);
    const double expected = whole * static_cast<double>(cells) / (kSteps * kSteps);
    EXPECT_NEAR(area_at(s, outer, scratch), expected, 1.5e-3 * whole);
    positive += cells > 0;
    static const GaussRule rule = gauss_legendre(40);
    long columns = 0;
    EXPECT_NEAR(area_of_columns(s, outer, rule, scratch, columns), area_at(s, outer, scratch), 1e-6 * whole);
  }
  EXPECT_GT(positive, 60);
}

TEST(CrrCruColumns, ToleranceIsKept) {
  for (const Case& c : random_cases(240, 5)) {
    SCOPED_TRACE(text(c));
    const double best = survey(c.name, c.p, columns(c, 1e-13)).volume;
    for (const double tolerance : {1e-10, 1e-8, 1e-4}) {
      const auto found = survey(c.name, c.p, columns(c, tolerance));
      EXPECT_NEAR(found.volume, best, tolerance * best);
      EXPECT_LE(found.error, tolerance);
    }
  }
}

TEST(CrrCruColumns, VolumeEqualsAFineMidpointSum) {
  for (const Case& c : random_cases(48, 6, 0.4)) {
    SCOPED_TRACE(text(c));
    const auto s = sliced_design(design_of_case(c), fixed_of(c));
    ColumnScratch<double> scratch;
    const double first = s.axes.outer_is_phi ? -kPi : s.positions.range[0].lower;
    const double last = s.axes.outer_is_phi ? kPi : s.positions.range[0].upper;
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) sum += area_at(s, first + (last - first) * (i + 0.5) / kSteps, scratch);
    const double expected = sum * (last - first) / kSteps;
    // at a jump of the area, half a step of it
    const double jump = 0.2 * (last - first) / kSteps;
    EXPECT_NEAR(survey(c.name, c.p, columns(c)).volume, expected, jump);
  }
}

// Three ways to one volume: columns; voxels, whose error falls with their number; and a quasi-random count (Kronecker's
// sequence with powers of the plastic number's relative in three dimensions), which shares nothing with either.
TEST(CrrCruColumns, VolumesEqualVoxelsAtFourResolutionsAndAQuasiRandomCount) {
  for (const std::string& name : both())
    for (const double phi : {0.0, 0.4}) {
      const Case c{name, nominal(), limit_spec(0.2, 0.1), 3, phi};
      SCOPED_TRACE(text(c));
      const double exact = survey(name, c.p, columns(c)).volume;
      for (const std::int64_t cells : {20, 40, 80, 160}) {
        const WorkspacePlan grid = voxels(c, {cells, cells, cells}, Box{{{-0.05, 0.45}, {-0.05, 0.45}, {-0.05, 0.45}}});
        const double error = survey(name, c.p, grid).volume / exact - 1;
        EXPECT_LT(std::fabs(error), 1.0 / static_cast<double>(cells)) << cells;
      }
      const Design<double> d = design_of_case(c);
      const PositionSet<double> f = position_set(d, phi);
      constexpr double kPlastic = 1.2207440846057596;  // x^4 = x + 1
      constexpr int kPoints = 6000000;
      Vector3<double> step{}, at{};
      for (std::size_t k = 0; k < 3; ++k) step[k] = std::pow(kPlastic, -1.0 - static_cast<double>(k));
      int inside = 0;
      for (int i = 1; i <= kPoints; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double share = 0.5 + i * step[k];
          at[k] = -0.05 + 0.5 * (share - std::floor(share));
        }
        inside += in_position_set(d, f, at);
      }
      EXPECT_NEAR(inside * 0.125 / kPoints / exact, 1, 1e-4);
    }
}

// The measure of all (x, y, z, phi) does not depend on which coordinate is held: four ways to one number.
TEST(CrrCruColumns, AllSweepsAddUpToTheSameMeasure) {
  constexpr int kSteps = 1200;
  for (const Case& c : random_cases(5, 7)) {
    SCOPED_TRACE(c.name);
    std::array<double, 4> measure{};
    for (int held = 0; held < 4; ++held) {
      const double first = held == 3 ? -kPi : -0.1, last = held == 3 ? kPi : 0.6;
      for (int i = 0; i < kSteps; ++i) {
        const double value = first + (last - first) * (i + 0.5) / kSteps;
        const Case at{c.name, c.p, c.limits, held, value};
        measure[static_cast<std::size_t>(held)] +=
            survey(c.name, c.p, columns(at, 1e-5)).volume * (last - first) / kSteps;
      }
    }
    EXPECT_GT(measure[0], 1e-3);
    for (std::size_t held = 1; held < 4; ++held) EXPECT_NEAR(measure[held] / measure[0], 1, 2.5e-3) << held;
  }
}

TEST(CrrCruColumns, FixedNodesConvergeToTheTolerance) {
  for (const Case& c : random_cases(40, 8)) {
    SCOPED_TRACE(text(c));
    const double best = survey(c.name, c.p, columns(c, 1e-12)).volume;
    const auto with = [&](const std::array<int, 2>& given) {
      return survey(c.name, c.p, plan(ColumnOptions{.tolerance = 1e-10, .nodes = given}, c.held, c.value, c.limits));
    };
    const auto found = with({24, 24});
    EXPECT_NEAR(found.volume, best, 1e-5 * best);
    EXPECT_EQ(found.error, 0);
    // the order of nodes is that of the swept coordinates: 60 columns over the inner one, 2 slices per piece
    const std::array<int, 2> nodes = c.held == 3 ? std::array<int, 2>{2, 60} : std::array<int, 2>{60, 2};
    const auto slices = with(nodes);
    if (!(best > 0)) continue;
    EXPECT_NE(slices.volume, with({nodes[1], nodes[0]}).volume);
  }
}

TEST(CrrCruConditioning, IsOneNumberPerYawAndSamplesAddUp) {
  FieldRequest request;
  request.add(kConditioning);
  for (const Case& c : random_cases(32, 9)) {
    SCOPED_TRACE(text(c));
    const auto exact = survey(c.name, c.p, columns(c), request),
               cells = survey(c.name, c.p, voxels(c, {40, 40, 80}), request);
    if (!(exact.volume > 1e-4)) continue;
    for (const auto* s : {&exact, &cells}) {
      double sum = 0;
      for (const double w : s->weight) sum += w;
      EXPECT_NEAR(sum, s->volume, 1e-5 * s->volume);
      ASSERT_EQ(s->weight.size(), s->field(kConditioning).size());
    }
    const double mean = weighted_mean(exact.weight, exact.field(kConditioning));
    EXPECT_NEAR(weighted_mean(cells.weight, cells.field(kConditioning)), mean, 5e-3);
    if (c.held != 3) continue;
    const PoseReport r = generic_engine(c.name).inspect(c.p, {0.2, 0.2, 0.2, c.value}, "-,-,+,-", c.limits);
    EXPECT_NEAR(mean, r.conditioning.value(), 1e-13);  // closed form and singular value decomposition
    FieldRequest longer = request;
    longer.characteristic_length = 10;
    EXPECT_LT(survey(c.name, c.p, columns(c), longer).field(kConditioning)[0], mean);
  }
}

TEST(CrrCruWorkspace, EveryParameterButUnusedAnglesMatters) {
  for (const std::string& name : both())
    for (std::size_t i = 0; i < kParameters; ++i) {
      const Case c{name, nominal(), limit_spec(0.2, 0.1), 3, 0.4};
      auto p = c.p;
      p[i] += 0.01;
      EXPECT_NE(survey(name, p, columns(c)).volume, survey(name, c.p, columns(c)).volume)
          << name << " " << mechanism(name).info().parameters[i].name;
    }
}

}  // namespace
}  // namespace pkm::testing::crr
