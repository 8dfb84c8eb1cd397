// The plain test of a pose of 4PPa-2PaR against the generic engine, and closed-form slices against the plain test.
// (Cells: voxels_test.cpp.)
#include <algorithm>

#include <gtest/gtest.h>

#include "engine/accelerators/four_ppa_two_par/masses.hpp"
#include "engine/accelerators/four_ppa_two_par/slice.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/golden.hpp"
#include "tests/unit/accelerators/four_ppa_two_par/plain_pose.hpp"

namespace pkm::testing {
namespace {

using namespace four_ppa_two_par;

struct MarginCase {
  std::vector<double> p;
  LimitSpec limits;
  Geometry<double> g;
  Limits<double> l;
};

MarginCase random_margin_case(Uniform& uniform) {
  std::vector<double> p = nominal();
  for (const ParameterIndex length : {kA, kB, kLu, kLd, kD}) p[length] *= uniform(0.7, 1.4);
  p[kL0] = uniform(0.8, 3) * p[kLu];
  LimitSpec spec = no_limits(four_ppa().info());
  const double drawn[] = {uniform(0, 0.3),  uniform(0, 0.3), uniform(1.0, 1.5),
                          uniform(0, 0.12), uniform(0, 0.5), uniform(0, 0.4)};
  for (std::size_t i = 0; i < std::size(drawn); ++i)
    if (uniform(0, 1) < 0.5) spec.given[i] = drawn[i];
  const auto g = geometry(std::span<const double>(p));
  return {p, spec, g, limits(g, spec)};
}

struct At {
  double x, y, z, angle;
};
At random_pose(const Geometry<double>& g, Uniform& uniform) {
  return {uniform(0, g.b), uniform(0, g.L0), uniform(-(g.l_u + g.l_d + g.d), 0), uniform(-kPi / 2, kPi / 2)};
}

/// Margins of the pose in the lower mode, by the generic engine.
std::vector<double> margins_at(const MarginCase& c, const At& at, double y) {
  const pkm::Pose<double> pose = {at.x, y, at.z, at.angle};
  std::vector<double> margins;
  Scratch scratch;
  generic_four_ppa().pose_margins()->append(std::span<const double>(c.p), "lower,lower", c.limits, {&pose, 1}, scratch,
                                            margins);
  return margins;
}

TEST(FourPpaSlices, PlainPoseTestAgreesWithTheGenericEngine) {
  Uniform uniform(31);
  int feasible_poses = 0, infeasible_poses = 0;
  for (int i = 0; i < 40000; ++i) {
    const MarginCase c = random_margin_case(uniform);
    const At at = random_pose(c.g, uniform);
    const auto theta = sincos(at.angle);
    const std::vector<double> margins = margins_at(c, at, at.y);
    if (std::ranges::any_of(margins, [](double m) { return std::fabs(m) < 1e-12; })) continue;
    const bool expected = std::ranges::all_of(margins, [](double m) { return m >= 0; });
    EXPECT_EQ(feasible(c.g, c.l, at.x, at.y, at.z, theta.sin, theta.cos), expected);
    ++(expected ? feasible_poses : infeasible_poses);
  }
  EXPECT_GT(feasible_poses, 500);
  EXPECT_GT(infeasible_poses, 1000);
}

TEST(FourPpaSlices, ParametersAndLimitsHaveTheOrderOfTheFile) {
  const auto names = [](const auto& list) {
    std::vector<std::string> all;
    for (const auto& entry : list) all.push_back(entry.name);
    return all;
  };
  EXPECT_EQ(names(four_ppa().info().limits),
            (std::vector<std::string>{"alpha_min", "beta_min", "beta_max", "h_min", "sin_par_min", "cos_theta_min",
                                      "clearance_min"}));
  EXPECT_EQ(names(four_ppa().info().parameters),
            (std::vector<std::string>{"a",        "b",   "l_u",   "l_d",     "d",   "L0",       "R_u",      "R_d",
                                      "d_u",      "d_d", "d_0",   "R_p",     "R_s", "lambda_u", "lambda_d", "lambda_s",
                                      "lambda_p", "m_c", "kappa", "kappa_p", "m_p", "c_p"}));
  EXPECT_EQ(four_ppa().info().limits.size(), std::size_t{kLimits});
  EXPECT_EQ(four_ppa().info().parameters.size(), std::size_t{kAllParameters});
}

/// Whether a pose lies in the closed-form slice of its plane and theta.
bool in_slice(const SlicedDesign<double>& f, double x, double z, const SinCosOf<double>& theta) {
  const Slice<double> t = slice(f, theta.sin, theta.cos);
  if (t.empty || theta.cos < f.l.cos_theta_min) return false;
  Limbs<double> limbs;
  for (std::size_t j = 0; j < 2; ++j) place_limb(f.g, x, f.y, z, theta, Branch::lower, j, limbs);
  const std::size_t leaning = limbs.x[0] >= limbs.x[1] ? 0 : 1;
  if (limbs.x[leaning] > f.g.l_d) return false;
  const HalfSlice<double> h = half_slice(t, leaning);
  const double delta = limbs.sigma[1 - leaning] - limbs.sigma[leaning];
  if (h.empty || delta < h.low || delta > h.end) return false;
  const double rise = limbs.z_c[leaning] + f.z_low;
  return rise >= 0 && rise <= column(f, t, h, leaning, delta).length;
}

TEST(FourPpaSlices, ContainExactlyTheFeasiblePoses) {
  Uniform uniform(33);
  int inside = 0, outside = 0;
  for (int i = 0; i < 100000; ++i) {
    const MarginCase c = random_margin_case(uniform);
    const At at = random_pose(c.g, uniform);
    const SlicedDesign<double> f = sliced_design(c.g, c.l, at.y);
    const SinCosOf<double> theta = sincos(at.angle);
    if (f.empty) continue;
    const std::vector<double> margins = margins_at(c, at, f.y);
    if (std::ranges::any_of(margins, [](double m) { return std::fabs(m) < 1e-9; })) continue;
    const bool expected = std::ranges::all_of(margins, [](double m) { return m >= 0; });
    EXPECT_EQ(in_slice(f, at.x, at.z, theta), expected);
    ++(expected ? inside : outside);
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(outside, 1000);
}

}  // namespace
}  // namespace pkm::testing
