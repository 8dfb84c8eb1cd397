// Columns of 4PPa-2PaR against plain sums and their symmetries, for random designs.
#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/columns.hpp"
#include "engine/accelerators/four_ppa_two_par/voxels.hpp"
#include "engine/math/statistics.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/random_cases.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

// The closed-form area of a slice against the plain pose test, by a fine sum over x of the exact z interval.
TEST(FourPpaColumns, SliceAreaEqualsTheSumOverX) {
  int positive = 0;
  for (const Case& c : random_cases(150, 4)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto f = sliced_design(g, limits(g, c.limits), c.y);
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
          top[j] = std::fmax(g.l_u * f.l.sin_alpha_min, sqrt_or_zero(g.l_u * g.l_u - H * H));
        }
        if (none) continue;
        sum += std::fmax(0.0, -std::fmax(top[0] + s1, top[1] + s2) + f.z_low + std::fmin(s1, s2));
      }
      const double expected = sum * g.l_d / kSteps;
      EXPECT_NEAR(area(f, slice(f, s, co)), expected, 2e-4 * g.l_u * g.l_d);
      positive += expected > 1e-3;
    }
  }
  EXPECT_GT(positive, 100);
}

/// Volume by the midpoint rule over the whole range of theta, without critical values.
double midpoint_volume(const Case& c, int steps) {
  const auto g = geometry(std::span<const double>(c.p));
  const auto f = sliced_design(g, limits(g, c.limits), c.y);
  const double last = acos(f.l.cos_theta_min);
  double sum = 0;
  for (int i = 0; i < steps && !f.empty; ++i) {
    const auto [s, co] = sincos(last * (i + 0.5) / steps);
    sum += area(f, slice(f, s, co));
  }
  return 2 * sum * last / steps;
}

TEST(FourPpaColumns, VolumeEqualsAFineMidpointSum) {
  for (const Case& c : random_cases(120, 5)) {
    const double expected = midpoint_volume(c, 10000);
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
    const double expected = midpoint_volume(c, 4000);
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
    const FixedCoordinate fixed_y = at_y(c.y);
    EXPECT_LE(survey(c.p, columns(c.limits, fixed_y)).columns, 1000);
    const auto g = geometry(std::span<const double>(c.p));
    ColumnScratch<double> scratch;
    find_theta_intervals(sliced_design(g, limits(g, c.limits), c.y), scratch.critical_values, scratch.intervals);
    if (scratch.intervals.empty()) continue;
    for (const double rest : {1e-4, 1e-6, 1e-8}) {  // of theta, above where the workspace begins
      c.limits.given[kCosThetaMin] = pkm::sincos(scratch.intervals[0].lower + rest).cos;
      const auto found = survey(c.p, columns(c.limits, fixed_y));
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
    const auto f = sliced_design(g, limits(g, c.limits), c.y);
    ColumnScratch<double> scratch;
    find_theta_intervals(f, scratch.critical_values, scratch.intervals);
    pieces += scratch.intervals.size();
    for (const auto& piece : scratch.intervals)
      for (const double t : {0.01, 0.5, 0.99}) {
        const auto [s, co] = sincos(piece.lower + t * (piece.upper - piece.lower));
        EXPECT_GT(slice(f, s, co).depth[0], 0);
      }
  }
  EXPECT_GT(pieces, 300u);
}

TEST(FourPpaColumns, OnTheMiddlePlaneBothLimbsHaveTheSameBits) {
  for (const Case& c : random_cases(200, 14)) {
    const auto g = geometry(std::span<const double>(c.p));
    const auto f = sliced_design(g, limits(g, c.limits), g.L0 / 2);
    for (int i = 0; i < 50; ++i) {
      const auto [s, co] = sincos(0.03 * i);
      const auto t = slice(f, s, co);
      EXPECT_EQ(t.depth[0], t.depth[1]);
    }
  }
}

TEST(FourPpaColumns, ToleranceIsKept) {
  for (const Case& c : random_cases(300, 6)) {
    const FixedCoordinate fixed_y = at_y(c.y);
    const double best = survey(c.p, columns(c.limits, fixed_y, 1e-13)).volume;
    EXPECT_NEAR(survey(c.p, columns(c.limits, fixed_y, 1e-8)).volume, best, 1e-8 * best);
    EXPECT_NEAR(survey(c.p, columns(c.limits, fixed_y, 1e-4)).volume, best, 1e-4 * best);
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
    const auto f = sliced_design(g, limits(g, c.limits), g.L0 / 2);
    if (f.empty) continue;
    for (int i = 0; i < 10; ++i) {
      const auto [s, co] = sincos(uniform(0, kPi / 2));
      const auto t = slice_range(f, s, co);
      if (t.empty) continue;
      const double expected = area_over_y(f, t, many);
      EXPECT_NEAR(area_over_y(f, t, few), expected, 2e-9 * expected + 1e-15);
      positive += expected > 0;
    }
  }
  EXPECT_GT(positive, 1000);
}

}  // namespace
}  // namespace pkm::testing
