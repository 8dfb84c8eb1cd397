// The one statement of what keeps a pose of 4PPa-2PaR feasible: its two measures of angles against each other, its
// lanes against its doubles, and the closed-form sections against it. (Cells: workspace_test.cpp.)
#include "engine/mechanisms/four_ppa_two_par/margins.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "engine/math/lanes_functions.hpp"
#include "engine/mechanisms/four_ppa_two_par/inspect.hpp"
#include "engine/mechanisms/four_ppa_two_par/section.hpp"
#include "tests/unit/mechanisms/four_ppa_two_par/golden.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

struct Case {
  Geometry<double> g;
  Limits<double> l;
};

Case random_case(Uniform& uniform) {
  std::vector<double> p = nominal();
  for (const ParameterIndex length : {kA, kB, kLu, kLd, kD}) p[length] *= uniform(0.7, 1.4);
  p[kL0] = uniform(0.8, 3) * p[kLu];
  LimitSpec spec = no_limits(four_ppa().info());
  const double drawn[] = {uniform(0, 0.3),  uniform(0, 0.3), uniform(1.0, 1.5),
                          uniform(0, 0.12), uniform(0, 0.5), uniform(0, 0.4)};
  for (std::size_t i = 0; i < std::size(drawn); ++i)
    if (uniform(0, 1) < 0.5) spec.given[i] = drawn[i];
  const auto g = geometry(std::span<const double>(p));
  return {g, limits(g, spec)};
}

struct At {
  double x, y, z, angle;
};
At random_pose(const Geometry<double>& g, Uniform& uniform) {
  return {uniform(0, g.b), uniform(0, g.L0), uniform(-(g.l_u + g.l_d + g.d), 0), uniform(-kPi / 2, kPi / 2)};
}

template <Angles angles, class S>
std::array<S, kMargins> margins(const Geometry<S>& g, const Limits<S>& l, const S& x, const S& y, const S& z,
                                const SinCosOf<S>& theta, WorkingMode mode) {
  std::array<S, kMargins> least;
  least.fill(S(1e9));
  visit_margins<angles>(g, l, x, y, z, theta, mode, [&](std::size_t index, const S& part) {
    least[index] = select(part < least[index], part, least[index]);
    return true;
  });
  return least;
}

constexpr std::array<Branch, 2> kBranches = {Branch::lower, Branch::upper};

TEST(FourPpaMargins, SidesOfTrianglesSayWhatRadiansSay) {
  Uniform uniform(31);
  int kept = 0, broken = 0;
  for (int i = 0; i < 4000; ++i) {
    const Case c = random_case(uniform);
    const At at = random_pose(c.g, uniform);
    const SinCosOf<double> theta = sincos(at.angle);
    for (const Branch one : kBranches)
      for (const Branch two : kBranches) {
        const WorkingMode mode = {one, two};
        if (!inverse(c.g, {at.x, at.y, at.z, at.angle}, mode).assembles) continue;
        const auto sides = margins<Angles::by_sides>(c.g, c.l, at.x, at.y, at.z, theta, mode);
        const auto radians = margins<Angles::in_radians>(c.g, c.l, at.x, at.y, at.z, theta, mode);
        for (std::size_t k = 0; k < kMargins; ++k) {
          if (std::fabs(radians[k]) < 1e-12) continue;
          EXPECT_EQ(sides[k] >= 0, radians[k] >= 0) << kMarginNames[k];
          ++(radians[k] >= 0 ? kept : broken);
        }
      }
  }
  EXPECT_GT(kept, 10000);
  EXPECT_GT(broken, 1000);
}

TEST(FourPpaMargins, LimitsKeepTheirNames) {
  const auto& limits = four_ppa().info().limits;
  ASSERT_EQ(limits.size(), std::size_t{kLimits});
  for (std::size_t i = 0; i < limits.size(); ++i) EXPECT_EQ(kMarginNames[kFirstLimit + i], limits[i].name);
}

TEST(FourPpaMargins, LanesHaveTheBitsOfDoubles) {
  using L = LanesOf<InstructionSet::baseline>;
  Uniform uniform(32);
  for (int i = 0; i < 200; ++i) {
    const Case c = random_case(uniform);
    const auto& [g, l] = c;
    std::array<std::array<double, kLanes>, 5> lanes;  // x, y, z, sin, cos
    std::array<std::array<double, kMargins>, kLanes> expected;
    for (std::size_t k = 0; k < kLanes; ++k) {
      const At at = random_pose(g, uniform);
      const auto [s, co] = sincos(at.angle);
      expected[k] = margins<Angles::by_sides>(g, l, at.x, at.y, at.z, {s, co}, kLowerMode);
      const double values[] = {at.x, at.y, at.z, s, co};
      for (std::size_t n = 0; n < lanes.size(); ++n) lanes[n][k] = values[n];
    }
    const auto of = [&](std::size_t n) { return L::load(lanes[n].data()); };
    const Geometry<L> g_lanes = {.a = g.a, .b = g.b, .l_u = g.l_u, .l_d = g.l_d, .d = g.d, .L0 = g.L0};
    const Limits<L> l_lanes = {.sin_alpha_min = l.sin_alpha_min,
                               .sin_beta_min = l.sin_beta_min,
                               .sin_beta_max = l.sin_beta_max,
                               .cos_beta_max = l.cos_beta_max,
                               .h_min = l.h_min,
                               .sin_par_min = l.sin_par_min,
                               .cos_theta_min = l.cos_theta_min};
    const auto found =
        margins<Angles::by_sides>(g_lanes, l_lanes, of(0), of(1), of(2), SinCosOf<L>{of(3), of(4)}, kLowerMode);
    for (std::size_t m = 0; m < kMargins; ++m) {
      std::array<double, kLanes> each;
      found[m].store(each.data());
      for (std::size_t k = 0; k < kLanes; ++k) EXPECT_EQ(each[k], expected[k][m]) << kMarginNames[m];
    }
  }
}

/// Whether a pose lies in the closed-form section of its plane and theta.
bool in_section(const Frame<double>& f, double x, double z, const SinCosOf<double>& theta) {
  const Section<double> t = section(f, theta.sin, theta.cos);
  if (t.empty || theta.cos < f.l.cos_theta_min) return false;
  Limbs<double> limbs;
  for (std::size_t j = 0; j < 2; ++j) place_limb(f.g, x, f.y, z, theta, Branch::lower, j, limbs);
  const std::size_t leaning = limbs.x[0] >= limbs.x[1] ? 0 : 1;
  if (limbs.x[leaning] > f.g.l_d) return false;
  const Half<double> h = half_section(t, leaning);
  const double delta = limbs.sigma[1 - leaning] - limbs.sigma[leaning];
  if (h.empty || delta < h.low || delta > h.end) return false;
  const double rise = limbs.z_c[leaning] + f.z_low;
  return rise >= 0 && rise <= column(f, t, h, leaning, delta).length;
}

TEST(FourPpaMargins, SectionsHoldThePosesThatKeepThem) {
  Uniform uniform(33);
  int inside = 0, outside = 0;
  for (int i = 0; i < 100000; ++i) {
    const Case c = random_case(uniform);
    const At at = random_pose(c.g, uniform);
    const Frame<double> f = frame(c.g, c.l, at.y);
    const SinCosOf<double> theta = sincos(at.angle);
    if (f.empty) continue;
    const auto margin = margins<Angles::by_sides>(c.g, c.l, at.x, f.y, at.z, theta, kLowerMode);
    if (std::ranges::any_of(margin, [](double m) { return std::fabs(m) < 1e-9; })) continue;
    const bool expected = feasible(c.g, c.l, at.x, f.y, at.z, theta.sin, theta.cos);
    EXPECT_EQ(in_section(f, at.x, at.z, theta), expected);
    ++(expected ? inside : outside);
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

}  // namespace
}  // namespace pkm::testing
