// Columns and voxels of the hybrid robot against the golden data, the generic engine, a plain pose test, each other and
// finite differences.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "engine/accelerators/hybrid/columns.hpp"
#include "engine/accelerators/hybrid/voxels.hpp"
#include "engine/math/statistics.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/accelerators/hybrid/golden.hpp"
#include "tests/unit/accelerators/hybrid/plain_pose.hpp"
#include "tests/unit/generic/plain_loop.hpp"

namespace pkm::testing::hybrid {
namespace {

FixedCoordinate held_y(FixedCoordinate::Kind kind, double value = 0) {
  return {.coordinate = 1, .kind = kind, .value = value};
}

WorkspacePlan columns_plan(double tolerance = ColumnOptions().tolerance) {
  return {.method = ColumnOptions{.tolerance = tolerance}, .limits = no_thresholds()};
}
WorkspacePlan voxels_plan(std::array<std::int64_t, 3> cells) {
  return {.method = VoxelOptions{.cells = cells}, .limits = no_thresholds()};
}

/// The request in a working mode with the required sign of N2.
FieldRequest in_mode(const WorkingMode& mode, int branch = 1, FieldRequest request = {}) {
  request.mode = mode_name(mode, branch);
  return request;
}

template <class S>
WorkspaceResult<S> survey(const std::vector<S>& p, const WorkingMode& mode, const WorkspacePlan& plan,
                          const FieldRequest& request = {}) {
  WorkspaceResult<S> result;
  evaluate_once<S>(*prepare_workspace(mechanism(), plan, in_mode(mode, 1, request)), p, result);
  return result;
}

VoxelMap map(const std::vector<double>& p, const WorkingMode& mode, const WorkspacePlan& plan) {
  return mechanism().voxels()->prepare(plan, *plan.voxels(), in_mode(mode))->map(p);
}

template <class S>
SlicedDesign<S> sliced(const std::vector<S>& p, const WorkingMode& mode, const LimitSpec& spec = no_thresholds(),
                       int branch = 1) {
  const std::span<const S> all(p);
  return sliced_design(geometry(all), limits(all, spec), mode, branch);
}

/// Mean of two designs of the golden data, each shifted a little, so that nearly all have a workspace.
struct Case {
  std::vector<double> p;
  WorkingMode mode;
};
std::vector<Case> random_cases(int count, int seed) {
  Uniform uniform(seed);
  const std::vector<WorkingMode> modes = {{1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, 1, -1}};
  std::vector<Case> cases;
  const auto& designs = golden()["designs"];
  for (int i = 0; i < count; ++i) {
    std::vector<double> p = design_from(designs[static_cast<std::size_t>(i) % designs.size()]);
    for (double& value : p) value *= 1 + uniform(-0.04, 0.04);
    cases.push_back({p, modes[static_cast<std::size_t>(i) % modes.size()]});
  }
  return cases;
}

/// The feasible x at given z and beta: [lower, upper] less (-hole, hole).
struct ColumnOfX {
  double lower = 1, upper = 0, hole = 0;
  bool empty() const { return !(lower <= upper); }
  bool holds(double x) const { return x >= lower && x <= upper && std::fabs(x) >= hole; }
  double length() const {
    if (empty()) return 0;
    return upper - lower - std::fmax(0, std::fmin(upper, hole) - std::fmax(lower, -hole));
  }
};
ColumnOfX column_at(const SlicedDesign<double>& f, double z, double beta) {
  ColumnOfX column;
  if (f.empty) return column;
  const Slice<double> s = slice(f, beta);
  if (z < *std::ranges::max_element(s.lower) || z > *std::ranges::min_element(s.upper)) return column;
  column = {-1e9, 1e9, z < s.hole_end ? s.curve[kCurveH].root(z) : 0};
  for (std::uint8_t k = 0; k < kCurveH; ++k) {
    column.lower = std::fmax(column.lower, edge_at(s, {k, kLeft}, z));
    column.upper = std::fmin(column.upper, edge_at(s, {k, kRight}, z));
  }
  return column;
}

TEST(HybridColumns, OfXAreTheGoldenOnes) {
  int holes = 0, empty = 0;
  for (const auto& entry : golden()["xcolumn"]) {
    SCOPED_TRACE(entry.dump());
    const ColumnOfX column = column_at(sliced(design_of(entry), {1, -1, -1}), entry["z"], entry["beta"]);
    EXPECT_NEAR(column.length(), entry["length"].get<double>(), 1e-13);
    ++(column.empty() ? empty : holes);
    if (column.empty()) continue;
    EXPECT_NEAR(column.lower, entry["lo"].get<double>(), 1e-13);
    EXPECT_NEAR(column.upper, entry["hi"].get<double>(), 1e-13);
    EXPECT_NEAR(column.hole, entry["hole"].get<double>(), 1e-13);
  }
  EXPECT_GT(empty, 3);
  EXPECT_GT(holes, 3);
}

// An independent check: x columns never look at z.
TEST(HybridColumns, OfZEndWhereThePlainTestChanges) {
  constexpr double kBeside = 1e-9;
  int found = 0;
  for (const auto& entry : golden()["zcolumn"]) {
    SCOPED_TRACE(entry.dump());
    const SlicedDesign<double> f = sliced(design_of(entry), {1, -1, -1});
    const double x = entry["x"], beta = entry["beta"];
    const auto at = [&](double z) { return feasible(f, x, z, beta); };
    ASSERT_LE(entry["intervals"].size(), 1u);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) inside += at(0.4 * (i + 0.5) / 2000);
    double length = 0;
    for (const auto& interval : entry["intervals"]) {
      const double low = interval[0], high = interval[1];
      length = high - low;
      EXPECT_TRUE(at(low + kBeside) && at(0.5 * (low + high)) && at(high - kBeside));
      EXPECT_FALSE(at(low - kBeside) || at(high + kBeside));
      ++found;
    }
    EXPECT_NEAR(inside * 0.4 / 2000, length, 2 * 0.4 / 2000);
  }
  EXPECT_GT(found, 8);
}

TEST(HybridVoxels, CountsAndIndicesAreTheGoldenOnes) {
  for (const auto& entry : golden()["workspace"]) {
    const std::vector<double> p = design_of(entry);
    const WorkingMode mode = mode_of(entry["wm"]);
    const Box box = default_box(sliced(p, mode));
    FieldRequest request;
    request.add(kConditioning);
    for (const auto& grid : entry["grids"]) {
      SCOPED_TRACE(entry["design"].dump() + " " + grid.dump());
      WorkspacePlan voxels = voxels_plan({grid["shape"][0], grid["shape"][1], grid["shape"][2]});
      if (entry["interference"]) {  // under a clearance voxels are those of the generic engine, which has another box
        voxels.limits.given[kClearanceMin] = 0;
        std::get<VoxelOptions>(voxels.method).box = box;
      }
      const auto found = survey(p, mode, voxels, request);
      EXPECT_EQ(found.feasible_cells, grid["count"].get<std::int64_t>());
      EXPECT_NEAR(found.volume, grid["volume"].get<double>(), 1e-12 * found.volume);
      EXPECT_NEAR(weighted_mean(found.weight, found.field(kConditioning)), grid["gci"].get<double>(), 1e-12);
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t end = 0; end < 2; ++end)
        EXPECT_NEAR(box[i][end], entry["box"][i][end].get<double>(), 1e-14) << i << " " << end;
    const int nz = entry["column_grid"]["nz"], nbeta = entry["column_grid"]["nbeta"];
    double sum = 0;
    for (int j = 0; j < nz; ++j)
      for (int k = 0; k < nbeta; ++k)
        sum += column_at(sliced(p, mode), box[1][0] + (box[1][1] - box[1][0]) * (j + 0.5) / nz,
                         box[2][0] + (box[2][1] - box[2][0]) * (k + 0.5) / nbeta)
                   .length();
    sum *= (box[1][1] - box[1][0]) / nz * (box[2][1] - box[2][0]) / nbeta;
    EXPECT_NEAR(sum, entry["column_grid"]["volume"].get<double>(), 1e-12 * sum);
  }
}

TEST(HybridColumns, VolumesAreTheGoldenOnes) {
  int compared = 0;
  for (const auto& entry : golden()["workspace"]) {
    if (!entry.contains("analytic")) continue;
    SCOPED_TRACE(entry["design"].dump() + " " + entry["wm"].dump());
    const WorkspacePlan columns = columns_plan(1e-10);
    const double golden = entry["analytic"], error = entry["analytic_rel_err"];
    EXPECT_NEAR(survey(design_of(entry), mode_of(entry["wm"]), columns).volume, golden, error * golden);
    ++compared;
  }
  EXPECT_EQ(compared, 5);
  const auto volume = [](const WorkingMode& mode) { return survey(nominal(), mode, columns_plan()).volume; };
  EXPECT_NEAR(volume({1, -1, -1}), 7.629533e-3, 5e-9);  // document, section 8.4
  EXPECT_NEAR(volume({1, -1, 1}), 6.50289e-4, 5e-10);
  EXPECT_NEAR(volume({-1, 1, -1}), 4.09804e-4, 5e-10);
  EXPECT_NEAR(volume({-1, 1, 1}), 2.18057e-5, 5e-11);
  for (const WorkingMode& mode : all_signs()) EXPECT_EQ(volume(mode) == 0, mode[0] == mode[1]) << mode_name(mode);
}

TEST(HybridVoxels, ConvergeToTheColumns) {
  for (const WorkingMode& mode : {WorkingMode{1, -1, -1}, WorkingMode{1, -1, 1}}) {
    const double exact = survey(nominal(), mode, columns_plan()).volume;
    std::printf("mode %s: columns %.9e m^2 rad\n", mode_name(mode).c_str(), exact);
    for (const std::int64_t n : {32, 64, 128, 256}) {
      const auto found = survey(nominal(), mode, voxels_plan({n, n, n}));
      std::printf("  %3d^3 voxels: %8d feasible, %.9e, error %+.1e\n", static_cast<int>(n),
                  static_cast<int>(found.feasible_cells), found.volume, found.volume / exact - 1);
      EXPECT_NEAR(found.volume / exact, 1, 2.0 / static_cast<double>(n));  // the document's rms is 0.8 / n
    }
  }
}

// The generic engine finds the poses feasible that columns and the plain pose test contain.
TEST(HybridColumns, OfXHoldThePosesWhoseMarginsDo) {
  Uniform uniform(7);
  int inside = 0;
  for (const Case& c : random_cases(60, 8))
    for (const int branch : {1, -1}) {
      const SlicedDesign<double> f = sliced(c.p, c.mode, no_thresholds(), branch);
      for (int i = 0; i < 400; ++i) {
        const SchoenfliesPose<double> pose{uniform(-0.15, 0.15), 0.5 * (f.l.s_min[1] + f.l.s_max[1]),
                                           uniform(0.15, 0.3), uniform(-0.7, 0.7)};
        const PoseReport report = generic_engine().inspect(c.p, pose, mode_name(c.mode, branch), no_thresholds());
        const bool in_range = pose.angle >= f.l.beta_min && pose.angle <= f.l.beta_max;
        ASSERT_EQ(in_range && column_at(f, pose.z, pose.angle).holds(pose.x), report.feasible) << report.reason;
        ASSERT_EQ(feasible(f, pose.x, pose.z, pose.angle), report.feasible) << report.reason;
        inside += report.feasible;
      }
    }
  EXPECT_GT(inside, 1500);
}

TEST(HybridVoxels, CountsFromColumnsEqualThePlainLoop) {
  std::int64_t total = 0;
  for (const Case& c : random_cases(24, 1)) {
    WorkspacePlan voxels = voxels_plan({19, 17, 23});
    const SlicedDesign<double> f = sliced(c.p, c.mode, voxels.limits);
    const Box box = default_box(f), wide = {{{-0.3, 0.3}, {0.0, 0.35}, {-1.2, 1.2}}};
    for (const bool given : {false, true}) {
      if (given) std::get<VoxelOptions>(voxels.method).box = wide;
      const VoxelGrid grid(voxels.voxels()->cells, given ? wide : box);
      const VoxelMap plain =
          test_every_cell(grid, [&](double x, double z, double beta) { return feasible(f, x, z, beta); });
      WorkspaceResult<double> expected;
      summarise(grid, plain, expected);
      const auto found = survey(c.p, c.mode, voxels);
      EXPECT_EQ(found.feasible_cells, expected.feasible_cells);
      EXPECT_EQ(found.touches_box, expected.touches_box);
      EXPECT_TRUE(map(c.p, c.mode, voxels).feasible == plain.feasible);
      total += found.feasible_cells;
    }
  }
  EXPECT_GT(total, 5000) << "the random designs should have workspaces";
}

// The branch N2 < 0 keeps nothing within the range of the universal joint at C'.
TEST(HybridVoxels, TheOtherBranchIsEmpty) {
  for (const Case& c : random_cases(9, 2)) {
    const SlicedDesign<double> f = sliced(c.p, c.mode, no_thresholds(), -1);
    const VoxelGrid grid({15, 15, 40}, {{{-0.3, 0.3}, {0.05, 0.3}, {-1.5, 1.5}}});
    WorkspaceResult<double> found;
    summarise(grid, test_every_cell(grid, [&](double x, double z, double beta) { return feasible(f, x, z, beta); }),
              found);
    EXPECT_EQ(found.feasible_cells, 0);
    evaluate_once<double>(*prepare_workspace(mechanism(), columns_plan(), in_mode(c.mode, -1)), c.p, found);
    EXPECT_EQ(found.volume, 0);
  }
}

// Closed-form areas against a fine midpoint sum over z of exact columns, and against the rule on strips.
TEST(HybridColumns, SlicesEqualTheSumOfTheirColumns) {
  constexpr int kSteps = 20000;
  int positive = 0;
  ColumnScratch<double> scratch;
  const GaussRule rule = gauss_legendre(24);
  for (const Case& c : random_cases(60, 3)) {
    const SlicedDesign<double> f = sliced(c.p, c.mode);
    for (const double beta : {-0.45, -0.31, -0.1, 0.0, 0.2, 0.4}) {
      const double found = area_at(f, beta, scratch);
      double sum = 0, by_rule = 0;
      for (int i = 0; i < kSteps; ++i) sum += column_at(f, 0.35 * (i + 0.5) / kSteps, beta).length() * 0.35 / kSteps;
      EXPECT_NEAR(found, sum, 1e-5) << beta;  // at a jump of the length, half a step of it
      visit_columns(f, beta, rule, scratch, [&](double, double length, double weight) {
        EXPECT_GE(length, -1e-12);
        by_rule += length * weight;
      });
      EXPECT_NEAR(found, by_rule, 1e-9);
      positive += found > 0;
    }
  }
  EXPECT_GT(positive, 150);
}

TEST(HybridColumns, ToleranceIsKept) {
  for (const Case& c : random_cases(40, 4)) {
    const double best = survey(c.p, c.mode, columns_plan(1e-13)).volume;
    for (const double tolerance : {1e-10, 1e-8, 1e-4}) {
      const auto found = survey(c.p, c.mode, columns_plan(tolerance));
      EXPECT_NEAR(found.volume, best, tolerance * best);
      EXPECT_LE(found.error, tolerance);
    }
  }
}

TEST(HybridColumns, SamplesAddUpAndHaveTheMeanOfTheVoxels) {
  FieldRequest request;
  request.add(kConditioning);
  for (const Case& c : random_cases(18, 5)) {
    const auto exact = survey(c.p, c.mode, columns_plan(), request),
               cells = survey(c.p, c.mode, voxels_plan({40, 60, 60}), request);
    if (!(exact.volume > 1e-3)) continue;
    double sum = 0;
    for (const double w : exact.weight) sum += w;
    EXPECT_NEAR(sum / exact.volume, 1, 1e-5);  // 8 nodes along strips
    EXPECT_NEAR(weighted_mean(cells.weight, cells.field(kConditioning)),
                weighted_mean(exact.weight, exact.field(kConditioning)), 2e-3);
  }
}

TEST(HybridWorkspace, TheCarriageMultipliesByItsStroke) {
  WorkspacePlan columns = columns_plan(), voxels = voxels_plan({12, 12, 12});
  for (WorkspacePlan* p : {&columns, &voxels}) {
    const double still = survey(nominal(), {1, -1, -1}, *p).volume;
    p->fixed = {held_y(FixedCoordinate::Kind::value, 0.199)};
    EXPECT_EQ(survey(nominal(), {1, -1, -1}, *p).volume, still);
    p->fixed = {held_y(FixedCoordinate::Kind::value, 0.201)};
    EXPECT_EQ(survey(nominal(), {1, -1, -1}, *p).volume, 0);
    p->fixed = {held_y(FixedCoordinate::Kind::integrated)};
    EXPECT_NEAR(survey(nominal(), {1, -1, -1}, *p).volume, 0.4 * still, 1e-15);
  }
}

TEST(HybridWorkspace, ColumnsRefuseAClearance) {
  WorkspacePlan columns = columns_plan();
  columns.limits.given[kClearanceMin] = 0;
  try {
    prepare_workspace(mechanism(), columns, {});
    FAIL() << "the clearance is accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_STREQ(
        e.what(),
        "mechanism 2t1r-p-hybrid has no exact columns with a clearance limit (clearance_min), because the distance "
        "of two links is not given by a formula; set workspace.method = \"voxels\"");
  }
}

// With respect to every parameter that the volume depends on, for designs and modes of all kinds.
TEST(HybridColumns, DerivativesOfTheVolumeEqualDifferences) {
  int moved = 0;
  WorkspacePlan columns = columns_plan(1e-12);
  columns.fixed = {held_y(FixedCoordinate::Kind::integrated)};
  for (const Case& c : random_cases(12, 6)) {
    const double volume = survey(c.p, c.mode, columns).volume;
    if (!(volume > 1e-5)) continue;
    for (std::size_t first = 0; first < kParameters; first += 4) {
      std::vector<Dual4> p(c.p.begin(), c.p.end());
      for (int i = 0; i < 4 && first + static_cast<std::size_t>(i) < kParameters; ++i)
        p[first + static_cast<std::size_t>(i)].v[i] = 1;
      const auto found = survey(p, c.mode, columns);
      for (std::size_t i = first; i < std::min<std::size_t>(first + 4, kParameters); ++i) {
        const auto at = [&](double step) {
          auto q = c.p;
          q[i] += step;
          return survey(q, c.mode, columns).volume;
        };
        constexpr double h = 1e-5;
        const double wide = (at(h) - at(-h)) / (2 * h), narrow = (at(h / 2) - at(-h / 2)) / h;
        const double exact = found.volume.v[static_cast<int>(i - first)];
        EXPECT_NEAR(exact, (4 * narrow - wide) / 3, 1e-5 * (std::fabs(exact) + volume))
            << mechanism().info().parameters[i].name;
        moved += std::fabs(exact) > 1e-3 * volume;
      }
    }
  }
  EXPECT_GT(moved, 100);
}

}  // namespace
}  // namespace pkm::testing::hybrid
