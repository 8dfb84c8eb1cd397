// Volumes over four and five coordinates: those beyond three are integrated over their ranges.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/math/quadrature.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm {
namespace {

/// A ball about the origin whose radius depends on two angles, phi in [-p, p] and psi in [0, p].
std::shared_ptr<const Mechanism> ball_of(const std::string& radius) {
  return read_mechanism_toml(R"([mechanism]
name = "ball"
[parameters]
r = { default = "0.5 m", min = "0.1 m", max = "1 m" }
p = { default = "0.7 rad", min = "0.1 rad", max = "1.5 rad" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z", phi = "about z", psi = "about x" }
characteristic_length = "1 m"
[survey]
sweep = ["x", "y", "z"]
fixed = { phi = 0, psi = 0 }
box = { x = ["-2*r", "2*r"], y = ["-2*r", "2*r"], z = ["-2*r", "2*r"], phi = ["-p", "p"], psi = [0, "p"] }
[[limb]]
name = "a"
drive = "formula"
joints = { q1 = "x", q2 = "y", q3 = "z" }
unit = "m"
[[limb]]
name = "b"
drive = "formula"
joints = { q4 = "phi", q5 = "psi" }
unit = "rad"
[[margin]]
name = "ball"
unit = "m^2"
formula = "()" + radius + R"()^2 - x^2 - y^2 - z^2"
)",
                             "ball.toml");
}

WorkspacePlan integrated(const Mechanism& mechanism, std::vector<int> coordinates) {
  WorkspacePlan plan{.method = ColumnOptions{}, .fixed = {}, .limits = no_limits(mechanism.info())};
  for (const int coordinate : coordinates)
    plan.fixed.push_back({.coordinate = coordinate, .kind = FixedCoordinate::Kind::integrated});
  return plan;
}

/// Integral of cos(phi)^3 from 0.
double of_cosine(double phi) { return std::sin(phi) - std::pow(std::sin(phi), 3) / 3; }

TEST(OuterQuadrature, OfFourCoordinatesHasItsClosedFormWithDerivatives) {
  const auto ball = ball_of("r*cos(phi)");
  const WorkspacePlan plan = integrated(*ball, {3});
  const double r = 0.5, p = 0.7, expected = 8.0 / 3 * std::numbers::pi * r * r * r * of_cosine(p);
  const std::vector<Dual4> design{Dual4::variable(r, 0), Dual4::variable(p, 1)};
  WorkspaceResult<Dual4> result;
  evaluate_once<Dual4>(*prepare_workspace(*ball, plan, {}), design, result);
  EXPECT_NEAR(result.volume.a, expected, 1e-13);
  EXPECT_LT(result.error, 1e-8);
  EXPECT_NEAR(result.volume.v[0], 3 * expected / r, 1e-12);
  EXPECT_NEAR(result.volume.v[1], 8.0 / 3 * std::numbers::pi * r * r * r * std::pow(std::cos(p), 3), 1e-12);
}

TEST(OuterQuadrature, OfFiveCoordinatesHasItsClosedForm) {
  const auto ball = ball_of("r*cos(phi)*cos(psi)");
  const double r = 0.5, p = 0.7;
  const WorkspaceResult<double> result = test::survey(*ball, {r, p}, integrated(*ball, {3, 4}));
  EXPECT_NEAR(result.volume, 8.0 / 3 * std::numbers::pi * r * r * r * of_cosine(p) * of_cosine(p), 1e-13);
  EXPECT_LT(result.error, 1e-8);
}

/// The volume begins at a value of phi that is not known beforehand, like its power 3/2.
TEST(OuterQuadrature, FindsWhereAWorkspaceBegins) {
  const auto ball = ball_of("sqrt(r*phi)");
  const double r = 0.5, p = 0.7;
  const WorkspaceResult<double> result = test::survey(*ball, {r, p}, integrated(*ball, {3}));
  const double expected = 4.0 / 3 * std::numbers::pi * std::pow(r, 1.5) * 0.4 * std::pow(p, 2.5);
  EXPECT_NEAR(result.volume, expected, (result.error + 1e-13) * expected);
  EXPECT_LT(result.error, 1e-7);
}

TEST(OuterQuadrature, SamplesCoverTheVolume) {
  const auto ball = ball_of("r*cos(phi)");
  const WorkspaceResult<double> result = test::survey(*ball, {0.5, 0.7}, integrated(*ball, {3}), {.poses = true});
  double weight = 0, square = 0;
  for (std::size_t i = 0; i < result.weight.size(); ++i) {
    weight += result.weight[i];
    square += result.weight[i] * result.pose[i][3] * result.pose[i][3];
  }
  EXPECT_NEAR(weight, result.volume, 1e-4 * result.volume);
  // integral of phi^2 cos(phi)^3 / integral of cos(phi)^3, from 0 to 0.7
  EXPECT_NEAR(square / weight, 0.13176, 5e-4);
}

/// At each phi the limbs of Par4 are placed differently, so that edges follow curves of general tori.
TEST(OuterQuadrature, OfPar4IsTheIntegralOfItsVolumesAtFixedAngles) {
  const Mechanism& par4 = *test::described("par4");
  std::vector<double> design = test::nominal(par4.info());
  const WorkspaceResult<double> all = test::survey(par4, design, integrated(par4, {3}));
  WorkspacePlan plan{.method = ColumnOptions{}, .fixed = {{.coordinate = 3, .kind = FixedCoordinate::Kind::value}}};
  plan.limits = no_limits(par4.info());
  const GaussRule rule = gauss_legendre(16);
  const double half = design.back();
  double sum = 0;
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    plan.fixed.front().value = half * (2 * rule.node[i] - 1);
    sum += 2 * half * rule.weight[i] * test::survey(par4, design, plan).volume;
  }
  EXPECT_NEAR(all.volume, sum, 1e-7 * sum);
  EXPECT_LT(all.error, 1e-8);
}

}  // namespace
}  // namespace pkm
