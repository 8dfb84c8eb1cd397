// Workspaces of mechanism files that are solids of planes, spheres, cylinders and tori: volumes and derivatives.
#include "engine/generic/edge_plan.hpp"

#include <gtest/gtest.h>

#include "engine/mechanism/plan.hpp"
#include "tests/unit/generic/files.hpp"
#include "tests/unit/generic/slices_of.hpp"

namespace pkm {
namespace {

WorkspacePlan plan_of(const Mechanism& mechanism) {
  return {.method = ColumnOptions{}, .fixed = {}, .limits = no_limits(mechanism.info())};
}

WorkspaceResult<double> analyse(const Mechanism& mechanism, const std::vector<double>& design,
                                const WorkspacePlan& plan) {
  WorkspaceResult<double> result;
  evaluate_once<double>(*mechanism.columns()->prepare(plan, *plan.columns(), {}), design, result);
  return result;
}

std::vector<double> default_design(const Mechanism& mechanism) {
  return test::design_with(mechanism.info(), nlohmann::json::object());
}

void expect_agreement(const Mechanism& mechanism, const std::vector<double>& design, const WorkspacePlan& plan) {
  const WorkspaceResult<double> edges = analyse(mechanism, design, plan);
  const Integral<double> slices = test::SlicesOf(mechanism, design, plan).measure();
  EXPECT_NE(edges.columns, slices.evaluations) << "the volume was not computed along edges";
  EXPECT_GT(edges.volume, 0);
  EXPECT_NEAR(edges.volume, slices.value, slices.error + (edges.error + 1e-9) * edges.volume);
}

void expect_derivatives(const Mechanism& mechanism, const std::vector<double>& design, const WorkspacePlan& plan) {
  const auto evaluator = mechanism.columns()->prepare(plan, *plan.columns(), {});
  const auto value = [&](std::size_t parameter, double step) {
    std::vector<double> changed = design;
    changed[parameter] += step;
    WorkspaceResult<double> result;
    evaluate_once<double>(*evaluator, changed, result);
    return result.volume;
  };
  for (std::size_t i = 0; i < design.size(); ++i) {
    SCOPED_TRACE(mechanism.info().parameters[i].name);
    std::vector<Dual4> parameters(design.begin(), design.end());
    parameters[i].v.d[0] = 1;
    WorkspaceResult<Dual4> result;
    evaluate_once<Dual4>(*evaluator, parameters, result);
    EXPECT_EQ(result.volume.a, value(i, 0));
    constexpr double kStep = 2e-5;
    const double difference =
        (8 * (value(i, kStep) - value(i, -kStep)) - (value(i, 2 * kStep) - value(i, -2 * kStep))) / (12 * kStep);
    EXPECT_NEAR(result.volume.v.d[0], difference, 1e-7 * (std::fabs(difference) + 0.1));
  }
}

class EdgeFiles : public testing::TestWithParam<const char*> {};

TEST_P(EdgeFiles, HaveTheVolumeOfTheCylindricalDecomposition) {
  const Mechanism& mechanism = *test::described(GetParam());
  expect_agreement(mechanism, default_design(mechanism), plan_of(mechanism));
}
TEST_P(EdgeFiles, HaveDerivativesThatAgreeWithDifferences) {
  const Mechanism& mechanism = *test::described(GetParam());
  std::vector<double> design = default_design(mechanism);
  // Without coincidences that only the default has. A tilt below 180 deg is a cone.
  for (std::size_t i = 0; i < design.size(); ++i)
    if (mechanism.info().parameters[i].name != "tilt")
      design[i] = design[i] * (1 + 0.01 * static_cast<double>(i)) + 1e-3;
  expect_agreement(mechanism, design, plan_of(mechanism));
  expect_derivatives(mechanism, design, plan_of(mechanism));
}
INSTANTIATE_TEST_SUITE_P(, EdgeFiles, testing::Values("rotary-delta", "linear-delta", "orthoglide", "gough"),
                         [](const auto& name) {
                           std::string text = name.param;
                           std::erase(text, '-');
                           return text;
                         });

/// Three telescopes, and margins of the kinds that bound a solid, with dimensions of their own.
std::shared_ptr<const Mechanism> mechanism_with(const std::string& margins) {
  const std::string text = R"(
[mechanism]
name = "three-telescopes"
title = "three telescopes from points of a circle"
source = "a test"
[parameters]
R     = { default = "300 mm", min = 0, max = "1 m", meaning = "radius of the base joints" }
l_min = { default = "400 mm", min = 0, max = "1 m", meaning = "minimum length" }
l_max = { default = "800 mm", min = 0, max = "2 m", meaning = "maximum length" }
s     = { default = "370 mm", min = 0, max = "2 m", meaning = "size of the margins" }
tilt  = { default = "12 deg", min = 0, max = "90 deg", meaning = "tilt of the margins" }
[platform]
coordinates = { x = "along x", y = "along y", z = "along z" }
[survey]
sweep = ["x", "y", "z"]
box = { x = ["-l_max", "l_max"], y = ["-l_max", "l_max"], z = ["0 m", "l_max"] }
[[limb]]
name = "leg"
copies = { number = 3, about = "z" }
drive = "telescope"
base = ["R", 0, 0]
platform = [0, 0, 0]
range = ["l_min", "l_max"]
)" + margins;
  return read_mechanism_toml(text, "three-telescopes.toml");
}
std::string margin(const std::string& formula) {
  return "[[margin]]\nname = \"m" + std::to_string(formula.size()) + "\"\nunit = \"m^2\"\nformula = \"" + formula +
         "\"\n";
}

TEST(EdgePlan, RecognisesPlanesSpheresAndCylinders) {
  for (const std::string formula :
       {"(s - z*cos(tilt) - x*sin(tilt))*(1 m)", "s^2 - x^2 - y^2 - (z - s)^2", "x^2 + y^2 + (z - s)^2 - s^2/4",
        "s^2/3 - (x*cos(tilt) - z*sin(tilt))^2 - (y - s/5)^2", "(x*cos(tilt) - z*sin(tilt))^2 + y^2 - s^2/8"}) {
    SCOPED_TRACE(formula);
    std::string text = formula;
    if (const auto unit = text.find("*(1 m)"); unit != std::string::npos) text = text.substr(1, unit - 2);
    std::string table = margin(text);
    if (text != formula) table.replace(table.find("m^2"), 3, "m");
    const auto mechanism = mechanism_with(table);
    expect_agreement(*mechanism, default_design(*mechanism), plan_of(*mechanism));
    expect_derivatives(*mechanism, default_design(*mechanism), plan_of(*mechanism));
  }
}

TEST(EdgePlan, LeavesOtherQuadricsToTheCylindricalDecomposition) {
  const auto mechanism = mechanism_with(margin("s^2 - x^2 - 2*y^2 - z^2/4"));
  const std::vector<double> design = default_design(*mechanism);
  const WorkspacePlan plan = plan_of(*mechanism);
  EXPECT_EQ(analyse(*mechanism, design, plan).columns, test::SlicesOf(*mechanism, design, plan).measure().evaluations);
}

TEST(EdgePlan, RestrictsTheSolidToTheBoxOfThePlan) {
  const Mechanism& mechanism = *test::described("linear-delta");
  WorkspacePlan plan = plan_of(mechanism);
  plan.method = ColumnOptions{.box = Box{{{-0.1, 0.2}, {-0.3, 0.05}, {-0.2, 0.1}}}};
  expect_agreement(mechanism, default_design(mechanism), plan);
}

TEST(EdgePlan, RotatesTheDirectionsOfAFixedOrientation) {
  const Mechanism& mechanism = *test::described("gough");
  WorkspacePlan plan = plan_of(mechanism);
  plan.fixed = {{3, FixedCoordinate::Kind::value, 0.1},
                {4, FixedCoordinate::Kind::value, -0.2},
                {5, FixedCoordinate::Kind::value, 0.3}};
  expect_agreement(mechanism, default_design(mechanism), plan);
}

}  // namespace
}  // namespace pkm
