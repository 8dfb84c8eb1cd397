// Columns and voxels of 4PPa-2PaR against the plain pose test, against each other and against their symmetries, on
// random designs with and without limits, on and off the middle plane.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/math/statistics.hpp"
#include "engine/mechanisms/four_ppa_two_par/columns.hpp"
#include "engine/mechanisms/four_ppa_two_par/voxels.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/golden.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/plain_pose.hpp"
#include "tests/unit/mechanisms/plain_loop.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

struct Case {
  std::vector<double> p;
  LimitSpec limits;
  double y;
};

/// Random designs around the paper's ranges; every second one with limits, every third off the middle plane, every
/// fifth with rails so short that the stroke cuts.
std::vector<Case> random_cases(int count, unsigned seed) {
  Uniform uniform(seed);
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) {
    Case c{nominal(), no_limits(four_ppa().info()), 0};
    c.p[kA] = uniform(0.15, 0.6);
    c.p[kB] = c.p[kA] + uniform(0.1, 1.0);
    c.p[kLu] = uniform(0.3, 1.2);
    c.p[kLd] = uniform(0.5, 1.2) * std::fmax(0.4, 0.5 * c.p[kB]) * 1.6;
    c.p[kD] = uniform(0, 0.3);
    c.p[kL0] = i % 5 == 4 ? uniform(0.8, 1.8) * c.p[kLu] : 2.5;
    if (i % 2 == 1) {
      const double drawn[] = {uniform(0, 0.3),  uniform(0, 0.3), uniform(1.0, 1.5),
                              uniform(0, 0.12), uniform(0, 0.5), uniform(0, 0.4)};
      std::ranges::copy(drawn, c.limits.given.begin());
    }
    c.y = i % 3 == 2 ? c.p[kL0] * uniform(0.2, 0.8) : c.p[kL0] / 2;
    cases.push_back(c);
  }
  return cases;
}

/// Least distance of a pose from the boundary of its constraints, to excuse cells within rounding of it.
double margin_at(const Case& c, double x, double z, double theta) {
  const PoseReport r = four_ppa().inspect(c.p, {x, c.y, z, theta}, "lower,lower", c.limits);
  double nearest = 1;
  for (const auto& [name, value] : r.margins) nearest = std::min(nearest, std::fabs(value));
  return nearest;
}

TEST(FourPpaVoxels, CountsFromIntervalsEqualThePlainLoop) {
  std::int64_t total = 0;
  for (const Case& c : random_cases(60, 1)) {
    const SurveyPlan plan = voxels(c.limits, {13, 16, 18}, at_y(c.y));
    const VoxelMap map = voxel_map(four_ppa(), c.p, plan);
    const auto g = geometry(std::span<const double>(c.p));
    const auto l = limits(g, c.limits);
    const VoxelGrid grid(plan.voxels()->cells, default_box(g));
    const VoxelMap plain = test_every_cell(grid, [&](double x, double z, double theta) {
      const auto [s, co] = sincos(theta);
      return feasible(g, l, x, c.y, z, s, co);
    });
    std::int64_t counted = 0, excused = 0;
    for (std::size_t i = 0; i < plain.feasible.size(); ++i) {
      counted += map.feasible[i];
      if (map.feasible[i] == plain.feasible[i]) continue;
      const auto k = static_cast<std::int64_t>(i) % 18, j = static_cast<std::int64_t>(i) / 18 % 16,
                 a = static_cast<std::int64_t>(i) / (18 * 16);
      EXPECT_LT(margin_at(c, grid.centre(0, a), grid.centre(1, j), grid.centre(2, k)), 1e-12);
      ++excused;
    }
    EXPECT_LE(excused, 2);
    const auto found = survey(c.p, plan);
    EXPECT_EQ(found.feasible_cells, counted);
    total += counted;
  }
  EXPECT_GT(total, 20000) << "the random designs should have workspaces";
}

TEST(FourPpaVoxels, SymmetryShortcutsCountTheSameCells) {
  for (const Case& c : random_cases(30, 2)) {
    for (const std::array<std::int64_t, 3>& cells : {std::array<std::int64_t, 3>{12, 15, 20}, {13, 15, 21}}) {
      const SurveyPlan plan = voxels(c.limits, cells);
      const VoxelMap map = voxel_map(four_ppa(), c.p, plan);
      const std::int64_t counted = std::count(map.feasible.begin(), map.feasible.end(), 1);
      EXPECT_EQ(survey(c.p, plan).feasible_cells, counted);
    }
  }
}

TEST(FourPpaVoxels, PoseTestAgreesWithTheInspection) {
  Uniform uniform(3);
  for (const Case& c : random_cases(40, 3)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto l = limits(g, c.limits);
    for (int i = 0; i < 200; ++i) {
      const double x = uniform(0, c.p[kB]), z = uniform(-(c.p[kLu] + c.p[kLd] + c.p[kD]), 0),
                   theta = uniform(-kPi / 2, kPi / 2);
      const auto [s, co] = sincos(theta);
      const PoseReport r = four_ppa().inspect(c.p, {x, c.y, z, theta}, "lower,lower", c.limits);
      EXPECT_EQ(feasible(g, l, x, c.y, z, s, co), r.feasible) << r.reason;
      EXPECT_EQ(r.reason.empty(), r.feasible);
    }
  }
}

TEST(FourPpaVoxels, GivenBoxAndItsTouch) {
  const auto none = no_limits(four_ppa().info());
  SurveyPlan plan = voxels(none, {30, 30, 30});
  voxel_options(plan).box = Box{{{-0.2, 1.0}, {-1.5, 0.1}, {-1.7, 1.7}}};
  const auto inside = survey(nominal(), plan);
  EXPECT_FALSE(inside.touches_box);
  EXPECT_NEAR(inside.volume / 0.550157374606, 1, 0.04);
  voxel_options(plan).box = Box{{{0.3, 0.5}, {-1.5, 0.1}, {-1.7, 1.7}}};
  EXPECT_TRUE(survey(nominal(), plan).touches_box);
}

// The closed-form area of a section against the plain pose test, by a fine sum over x of the exact z interval.
TEST(FourPpaColumns, SectionAreaEqualsTheSumOverX) {
  int positive = 0;
  for (const Case& c : random_cases(150, 4)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto f = frame(g, limits(g, c.limits), c.y);
    if (f.empty) continue;
    for (const double theta : {0.0, 0.4, 0.9, 1.3}) {
      const auto [s, co] = sincos(theta);
      if (co < f.l.cos_theta_min) continue;
      constexpr int kSteps = 10000;
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        const double x1 = g.l_d * (i + 0.5) / kSteps, x2 = g.b - g.a * co - x1;
        if (x1 < f.x_min || x1 > f.x_max || x2 < f.x_min || x2 > f.x_max) continue;
        const double s1 = std::sqrt(g.l_d * g.l_d - x1 * x1), s2 = std::sqrt(g.l_d * g.l_d - x2 * x2);
        if (x1 * s2 + x2 * s1 < f.l.sin_par_min * g.l_d * g.l_d) continue;
        double top[2];
        bool none = false;
        for (int j = 0; j < 2; ++j) {
          const double y = f.y + (j == 0 ? -1 : 1) * g.a * s / 2, H = std::fmin(y, g.L0 - y);
          none = none || H < 0;
          top[j] = std::fmax(g.l_u * f.l.sin_alpha_min, root_or_zero(g.l_u * g.l_u - H * H));
        }
        if (none) continue;
        sum += std::fmax(0.0, -std::fmax(top[0] + s1, top[1] + s2) + f.z_low + std::fmin(s1, s2));
      }
      const double expected = sum * g.l_d / kSteps;
      EXPECT_NEAR(area(f, section(f, s, co)), expected, 2e-4 * g.l_u * g.l_d);
      positive += expected > 1e-3;
    }
  }
  EXPECT_GT(positive, 100);
}

// The rule with its pieces against a fine midpoint rule over theta that knows of no breaks.
TEST(FourPpaColumns, VolumeEqualsAFineMidpointSum) {
  for (const Case& c : random_cases(120, 5)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto f = frame(g, limits(g, c.limits), c.y);
    constexpr int kSteps = 10000;
    const double last = acos(f.l.cos_theta_min);
    double sum = 0;
    for (int i = 0; i < kSteps && !f.empty; ++i) {
      const auto [s, co] = sincos(last * (i + 0.5) / kSteps);
      sum += area(f, section(f, s, co));
    }
    const double expected = 2 * sum * last / kSteps;
    const auto found = survey(c.p, columns(c.limits, at_y(c.y)));
    EXPECT_NEAR(found.volume, expected, 3e-6 * (1 + expected));
  }
}

/// Limits so strong that sin_par_min leaves less of the range of beta than beta_max: the corner of the two moves in.
std::vector<Case> strong_cases(int count, unsigned seed) {
  Uniform uniform(seed);
  std::vector<Case> cases = random_cases(count, seed);
  for (Case& c : cases) {
    c.p[kB] = uniform(0.2, 1.2);
    c.p[kLd] = uniform(0.4, 1.2);
    const double beta_max = uniform(0.5, 1.1);
    c.limits.given[kBetaMax] = beta_max;
    c.limits.given[kSinParMin] = uniform(pkm::sincos(beta_max).sin, 1.0);
  }
  return cases;
}

TEST(FourPpaColumns, StrongLimitsTogetherLoseNothing) {
  int compared = 0;
  for (const Case& c : strong_cases(400, 11)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto f = frame(g, limits(g, c.limits), c.y);
    constexpr int kSteps = 4000;
    const double last = acos(f.l.cos_theta_min);
    double sum = 0;
    for (int i = 0; i < kSteps && !f.empty; ++i) {
      const auto [s, co] = sincos(last * (i + 0.5) / kSteps);
      sum += area(f, section(f, s, co));
    }
    const double expected = 2 * sum * last / kSteps;
    const auto found = survey(c.p, columns(c.limits, at_y(c.y)));
    EXPECT_NEAR(found.volume, expected, 1e-5);
    compared += expected > 1e-3;
  }
  EXPECT_GT(compared, 50);
}

// Pieces are smooth, so a few hundred columns serve any design. Where a workspace is nearly empty, its area's rounding
// is all that is left of the error, and no halving improves it.
TEST(FourPpaColumns, NoDesignTakesLong) {
  int nearly_empty = 0;
  for (Case c : random_cases(1000, 12)) {
    const HeldCoordinate held = at_y(c.y);
    EXPECT_LE(survey(c.p, columns(c.limits, held)).columns, 1000);
    const auto g = geometry(std::span<const double>(c.p));
    ColumnScratch<double> scratch;
    find_pieces(frame(g, limits(g, c.limits), c.y), scratch.breaks, scratch.pieces);
    if (scratch.pieces.empty()) continue;
    for (const double rest : {1e-4, 1e-6, 1e-8}) {  // of theta, above where the workspace begins
      c.limits.given[kCosThetaMin] = pkm::sincos(scratch.pieces[0].lower + rest).cos;
      const auto found = survey(c.p, columns(c.limits, held));
      EXPECT_LE(found.columns, 1000) << found.volume;
      nearly_empty += found.volume > 0 && found.volume < 1e-8;
    }
  }
  EXPECT_GT(nearly_empty, 100);
}

// Where beta_max = pi/2 hands over to beta_min, at w = b - a cos(theta) = l_d, the end of delta has a root.
TEST(FourPpaColumns, ARootInsideTheRangeOfThetaIsAnEndOfAPiece) {
  auto p = nominal();
  p[kB] = 0.7;  // w from 0.5 to 0.7 about l_d = 0.55
  const auto found = survey(p, columns(no_limits(four_ppa().info())));
  EXPECT_LE(found.columns, 45);
}

TEST(FourPpaColumns, PiecesLieWhereBothLimbsHaveDepth) {
  std::size_t pieces = 0;
  for (const Case& c : random_cases(300, 16)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto f = frame(g, limits(g, c.limits), c.y);
    ColumnScratch<double> scratch;
    find_pieces(f, scratch.breaks, scratch.pieces);
    pieces += scratch.pieces.size();
    for (const auto& piece : scratch.pieces)
      for (const double t : {0.01, 0.5, 0.99}) {
        const auto [s, co] = sincos(piece.lower + t * (piece.upper - piece.lower));
        EXPECT_GT(section(f, s, co).depth[0], 0);
      }
  }
  EXPECT_GT(pieces, 300u);
}

TEST(FourPpaColumns, OnTheMiddlePlaneBothLimbsHaveTheSameBits) {
  for (const Case& c : random_cases(200, 14)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto f = frame(g, limits(g, c.limits), g.L0 / 2);
    for (int i = 0; i < 50; ++i) {
      const auto [s, co] = sincos(0.03 * i);
      const auto t = section(f, s, co);
      EXPECT_EQ(t.depth[0], t.depth[1]);
    }
  }
}

TEST(FourPpaColumns, ToleranceIsKept) {
  for (const Case& c : random_cases(300, 6)) {
    const HeldCoordinate held = at_y(c.y);
    const double best = survey(c.p, columns(c.limits, held, 1e-13)).volume;
    EXPECT_NEAR(survey(c.p, columns(c.limits, held, 1e-8)).volume, best, 1e-8 * best);
    EXPECT_NEAR(survey(c.p, columns(c.limits, held, 1e-4)).volume, best, 1e-4 * best);
  }
  for (Case& c : random_cases(60, 15)) {
    c.p[kL0] = std::fmin(c.p[kL0], 1.4 * c.p[kLu]);
    const double best = survey(c.p, columns(c.limits, over_y(), 1e-12)).volume;
    EXPECT_NEAR(survey(c.p, columns(c.limits, over_y(), 1e-8)).volume, best, 1e-8 * best);
  }
}

TEST(FourPpaColumns, MirroredPlaneAndScaling) {
  for (const Case& c : random_cases(40, 7)) {
    const double v = survey(c.p, columns(c.limits, at_y(c.y))).volume;
    EXPECT_NEAR(survey(c.p, columns(c.limits, at_y(c.p[kL0] - c.y))).volume, v, 1e-9 * v);
    Case big = c;
    for (auto& length : big.p) length *= 3;
    if (big.limits.given[kHMin]) *big.limits.given[kHMin] *= 3;
    EXPECT_NEAR(survey(big.p, columns(big.limits, at_y(3 * c.y))).volume, 9 * v, 1e-9 * v);
  }
}

TEST(FourPpaColumns, IntegratedOverYEqualsTheSumOverPlanes) {
  for (const Case& c : random_cases(10, 8)) {
    constexpr int kPlanes = 400;
    double sum = 0;
    for (int i = 0; i < kPlanes; ++i)
      sum += survey(c.p, columns(c.limits, at_y(c.p[kL0] * (i + 0.5) / kPlanes), 1e-7)).volume;
    const double expected = sum * c.p[kL0] / kPlanes;
    const auto found = survey(c.p, columns(c.limits, over_y(), 1e-8));
    EXPECT_NEAR(found.volume, expected, 2e-4 * (expected + 1e-3));
  }
}

// All kinks in y are ends of pieces: more nodes change the result no more, but for rare roots near a piece's end.
TEST(FourPpaColumns, AreasOverYHaveNoKinkInsideAPiece) {
  const GaussRule few = gauss_legendre(40), many = gauss_legendre(160);
  Uniform uniform(16);
  int positive = 0;
  for (Case& c : random_cases(400, 16)) {
    c.p[kL0] = uniform(0.8, 3.0) * c.p[kLu];
    const auto g = geometry(std::span<const double>(c.p));
    const auto f = frame(g, limits(g, c.limits), g.L0 / 2);
    if (f.empty) continue;
    for (int i = 0; i < 10; ++i) {
      const auto [s, co] = sincos(uniform(0, kPi / 2));
      const auto t = section_range(f, s, co);
      if (t.empty) continue;
      const double expected = area_over_y(f, t, many);
      EXPECT_NEAR(area_over_y(f, t, few), expected, 2e-9 * expected + 1e-15);
      positive += expected > 0;
    }
  }
  EXPECT_GT(positive, 1000);
}

TEST(FourPpaVoxels, IntegratedOverYConvergesToColumns) {
  const auto none = no_limits(four_ppa().info());
  auto p = nominal();
  const double exact = survey(p, columns(none, over_y())).volume;
  const SurveyPlan plan = voxels(none, {48, 48, 80}, over_y(50));
  const auto found = survey(p, plan);
  EXPECT_NEAR(found.volume / exact, 1, 0.01);
  EXPECT_EQ(found.cells, 48 * 48 * 80 * 50);
}

TEST(FourPpaConditioning, SamplesAddUpAndVoxelsConvergeToThem) {
  for (const Case& c : random_cases(12, 9)) {
    const HeldCoordinate held = at_y(c.y);
    Demand demand;
    demand.add(kConditioning);
    const auto exact = survey(c.p, columns(c.limits, held), demand);
    double sum = 0;
    for (const double w : exact.weight) sum += w;
    EXPECT_NEAR(sum, exact.volume, 1e-5 * exact.volume);
    if (exact.volume < 0.05) continue;
    const auto cells = survey(c.p, voxels(c.limits, {64, 68, 80}, held), demand);
    double counted = 0;  // a sample stands for its mirror images too
    for (const double w : cells.weight) counted += w / cells.cell_volume;
    EXPECT_NEAR(counted, static_cast<double>(cells.feasible_cells), 1e-6);
    EXPECT_NEAR(weighted_mean(cells.weight, cells.of(kConditioning)),
                weighted_mean(exact.weight, exact.of(kConditioning)), 3e-3);
    for (const double value : exact.of(kConditioning)) ASSERT_TRUE(value >= 0 && value <= 1);
  }
}

TEST(FourPpaConditioning, KernelEqualsTheFullJacobian) {
  Uniform uniform(10);
  int compared = 0;
  for (const Case& c : random_cases(60, 10)) {
    const auto g = geometry(std::span<const double>(c.p));
    for (int i = 0; i < 100; ++i) {
      const SchoenfliesPose<double> pose{uniform(0, c.p[kB]), c.y, uniform(-(c.p[kLu] + c.p[kLd]), 0),
                                         uniform(-kPi / 2, kPi / 2)};
      const PoseReport r = four_ppa().inspect(c.p, pose, "lower,lower", no_limits(four_ppa().info()));
      if (!r.feasible || !r.J) continue;
      const auto limb = inverse(g, pose, {Branch::lower, Branch::lower});
      const auto [s, co] = sincos(pose.angle);
      const double fast = conditioning<double, double>({g.l_u, 1.0, s, co, limb.x, limb.sigma}, limb.z_c);
      EXPECT_NEAR(fast, *r.conditioning, 1e-12);
      ++compared;
    }
  }
  EXPECT_GT(compared, 300);
}

// The shape types of section 3.3 by counting the connected parts of a fine section of both branches.
TEST(FourPpaShape, TypesMatchTheConnectedParts) {
  const auto parts = [](const Geometry<double>& g, double c) {
    constexpr int n = 300;
    std::vector<int> cell(n * n, 0);
    const double w = g.b - g.a * c, top = g.l_u + 1.1 * g.l_d;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x1 = g.l_d * (i + 0.5) / n, x2 = w - x1, z = -top + 2 * top * (j + 0.5) / n;  // height of D
        if (x2 < 0 || x2 > g.l_d) continue;
        bool ok = true;
        for (const double x : {x1, x2}) {
          const double sigma = std::sqrt(g.l_d * g.l_d - x * x);
          const auto below = [&](double z_c) { return z_c <= 0 && z_c >= -g.l_u; };
          ok = ok && (below(z + sigma) || below(z - sigma));
        }
        cell[static_cast<std::size_t>(i * n + j)] = ok;
      }
    int count = 0;
    std::vector<int> stack;
    for (int start = 0; start < n * n; ++start) {
      if (cell[static_cast<std::size_t>(start)] != 1) continue;
      int size = 0;
      stack.push_back(start);
      cell[static_cast<std::size_t>(start)] = 2;
      while (!stack.empty()) {
        const int at = stack.back(), i = at / n, j = at % n;
        stack.pop_back();
        ++size;
        for (const auto& [a, b] : {std::pair{i + 1, j}, {i - 1, j}, {i, j + 1}, {i, j - 1}})
          if (a >= 0 && a < n && b >= 0 && b < n && cell[static_cast<std::size_t>(a * n + b)] == 1) {
            cell[static_cast<std::size_t>(a * n + b)] = 2;
            stack.push_back(a * n + b);
          }
      }
      count += size > 20;
    }
    return count;
  };
  auto g = geometry(std::span<const double>(nominal()));
  g.b = 1.0, g.a = 0.2, g.l_u = 0.4;
  const double w = 0.8;
  const struct {
    double l_d;
    int type, parts;
  } cases[] = {{0.39, 1, 0}, {0.42, 2, 1}, {0.445, 3, 1}, {0.48, 4, 2}, {0.7, 5, 2}};
  for (const auto& c : cases) {
    g.l_d = c.l_d;
    EXPECT_EQ(section_type(g, 1.0), c.type) << c.l_d;
    EXPECT_EQ(parts(g, 1.0), c.parts) << c.l_d << " w " << w;
  }
}

}  // namespace
}  // namespace pkm::testing
