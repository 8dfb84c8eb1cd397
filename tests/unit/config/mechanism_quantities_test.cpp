// What mechanism files say beside limbs: quantities and their inputs, reported margins, names of modes, alternative
// mass models, required tests of the design, loop-closure equations.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/catalogue.hpp"
#include "tests/unit/config/mechanism_text.hpp"

namespace pkm {
namespace {

using test::value_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A slider q = x + e sqrt(l^2 - y^2) in the plane, with more tables.
std::string slider(const std::string& more, const std::string& modes = "e = [\"+\", \"-\"]",
                   const std::string& limb = "") {
  return R"toml([mechanism]
name = "slider"
[parameters]
l = { default = "2 m", min = "1 m", max = "9 m", meaning = "rod" }
q_max = { default = "9 m", min = "-9 m", max = "99 m", meaning = "end of the rail" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
box = { x = [-1, 1], y = [-1, 1] }
[modes]
)toml" + modes +
         R"toml(
[let]
h = "e*sqrt(l^2 - y^2)"
[[limb]]
name = "rod"
drive = "formula"
joints = { q = "x + h", p = "y" }
range = [-9, "q_max"]
)toml" + limb +
         '\n' + more;
}

const Pose<double> kPose = {0.5, 1.2};
constexpr double kHeight = 1.6;  // sqrt(4 - 1.44)

TEST(MechanismQuantities, DependOnTheDesignThePoseOrTheMotion) {
  const auto mechanism = test::read_robot(slider(R"toml([inputs]
t = { unit = "rad", default = 0.25, meaning = "an angle" }
[[quantity]]
name = "twice"
formula = "2*l"
unit = "m"
[[quantity]]
name = "height"
formula = "h"
unit = "m"
meaning = "of the slide above the point"
[[quantity]]
name = "share"
formula = "h/l"
[[quantity]]
name = "speed"
formula = "height_rate + t_rate"
unit = "m/s"
[[quantity]]
name = "change"
formula = "speed_rate"
unit = "m/s^2"
[[quantity]]
name = "turned"
formula = "sin(t)*x"
)toml"));
  const MechanismInfo& info = mechanism->info();
  ASSERT_EQ(names_of(info.quantities), (std::vector<std::string>{"velocity_transmission", "force_transmission", "twice",
                                                                 "height", "share", "speed", "change", "turned"}));
  EXPECT_TRUE(info.quantities[2].of_design);
  EXPECT_FALSE(info.quantities[3].of_design || info.quantities[3].of_motion);
  EXPECT_TRUE(info.quantities[5].of_motion && info.quantities[6].of_motion && info.quantities[7].of_motion);

  const std::vector<double> design = {2, 9};
  const LimitSpec none = no_limits(info);
  EXPECT_EQ(quantities_of_design(*mechanism, design, none), (NamedValues{{"twice", 4}}));
  const PoseReport report = mechanism->inspect(design, kPose, "+", none);
  EXPECT_NEAR(value_of(report.angles, "height"), kHeight, 1e-15);
  EXPECT_NEAR(value_of(report.indices, "share"), kHeight / 2, 1e-15);
  EXPECT_NEAR(value_of(mechanism->inspect(design, kPose, "-", none).angles, "height"), -kHeight, 1e-15);

  MotionSample at{.pose = kPose, .velocity = {0.1, 0.3}, .acceleration = {0.2, -0.4}, .inputs = {{0.5, 2, -3}}};
  const std::vector<double> values = mechanism->quantities(design, "+", none, at);
  const double rate = -1.2 * 0.3 / kHeight;  // h h' = -y y'
  const double change = (-0.3 * 0.3 - 1.2 * -0.4 - rate * rate) / kHeight;
  EXPECT_NEAR(values[5], rate + 2, 1e-14);
  EXPECT_NEAR(values[6], change - 3, 1e-14);
  EXPECT_NEAR(values[7], std::sin(0.5) * 0.5, 1e-15);
  at.inputs.clear();  // the default, constant
  EXPECT_NEAR(mechanism->quantities(design, "+", none, at)[5], rate, 1e-14);
  EXPECT_NEAR(mechanism->quantities(design, "+", none, at)[7], std::sin(0.25) * 0.5, 1e-15);
  EXPECT_TRUE(std::isnan(mechanism->quantities(design, "+", none, {.pose = {0, 3}})[3]));
}

TEST(MechanismQuantities, RefuseWhatCannotBe) {
  const std::string input = "[inputs]\nt = { unit = \"rad\" }\n";
  EXPECT_THAT(test::refusal_of(slider(input + "[[margin]]\nname = \"m\"\nformula = \"t\"\n")),
              HasSubstr("only the formula of a [[quantity]] may depend on [inputs] or rates"));
  EXPECT_THAT(test::refusal_of(slider("[[quantity]]\nname = \"dci\"\nformula = \"x\"\n")),
              HasSubstr("'dci' is a predefined name of every mechanism"));
  EXPECT_THAT(test::refusal_of(slider("[[quantity]]\nname = \"l\"\nformula = \"x\"\n")),
              HasSubstr("'l' is already the name of"));
  EXPECT_THAT(test::refusal_of(slider("[[quantity]]\nname = \"a\"\nformula = \"b\"\n")), HasSubstr("'b'"));
  EXPECT_THAT(test::refusal_of(slider("[inputs]\nt = { default = 1 }\n")), HasSubstr("inputs.t.unit"));
}

TEST(ReportedMargins, AreTheMinimumOfAListOrTheShownFormula) {
  const auto mechanism = test::read_robot(slider(R"toml([[margin]]
name = "inside"
formula = ["1 - x", "1 + x"]
unit = "m"
[[margin]]
name = "lean"
formula = "h - 1"
unit = "m"
shown = "acos(1/l) - asin(y/l)"
shown_unit = "rad"
[[margin]]
name = "last"
formula = "x + 2"
)toml"));
  const PoseReport report = mechanism->inspect(std::vector<double>{2, 9}, kPose, "+", no_limits(mechanism->info()));
  EXPECT_NEAR(value_of(report.margins, "inside"), 0.5, 1e-15);
  EXPECT_NEAR(value_of(report.margins, "lean"), std::acos(0.5) - std::asin(0.6), 1e-15);
  EXPECT_NEAR(value_of(report.margins, "last"), 2.5, 1e-15);
  EXPECT_TRUE(report.feasible);
  const PoseReport outside = mechanism->inspect(std::vector<double>{2, 9}, {1.5, 0}, "+", no_limits(mechanism->info()));
  EXPECT_FALSE(outside.feasible);
  EXPECT_THAT(outside.reason, HasSubstr("inside"));
  EXPECT_THAT(test::refusal_of(slider("[[margin]]\nname = \"m\"\nformula = \"x\"\nshown_unit = \"m\"\n")),
              HasSubstr("`shown_unit` requires `shown`"));
}

TEST(ModeNames, AreThoseOfTheFile) {
  const auto named = test::read_robot(slider("", "e = { signs = [\"+\", \"-\"], names = [\"upper\", \"lower\"] }"));
  EXPECT_THAT(named->info().modes, ElementsAre("upper", "lower"));
  const auto branch = test::read_robot(slider("[[margin]]\nname = \"side\"\nformula = \"b*x\"\n",
                                              "b = { signs = [\"+\", \"-\"], branch = true }\ne = [\"-\", \"+\"]"));
  EXPECT_THAT(branch->info().modes, ElementsAre("-", "+", "-/-", "+/-"));
  EXPECT_THAT(branch->info().branches, ElementsAre("+", "-"));
  const std::vector<double> design = {2, 9};
  const LimitSpec none = no_limits(branch->info());
  EXPECT_TRUE(branch->inspect(design, kPose, "+", none).feasible);
  EXPECT_FALSE(branch->inspect(design, kPose, "+/-", none).feasible);
  EXPECT_THAT(test::refusal_of(slider("", "e = { signs = [\"+\", \"-\"], names = [\"a\", \"a\"] }")),
              HasSubstr("a different name for each sign"));
}

TEST(MassModels, AreAlternativesOfOneFile) {
  const std::string text = slider(R"toml([masses.table.parameters]
m = { default = "3 kg", min = "1 kg", max = "9 kg" }
[masses.lengths.parameters]
mu = { default = "5 kg/m", min = "1 kg/m", max = "9 kg/m" }
[masses.lengths.let]
m = "mu*l"
[[body]]
name = "tool"
centre = ["x", "y", 0]
mass = "m"
)toml");
  const auto table = test::read_robot(text);
  ASSERT_TRUE(table->dynamics());
  EXPECT_THAT(table->dynamics()->mass_models(), ElementsAre("table", "lengths"));
  EXPECT_EQ(table->dynamics()->mass_model(), "table");
  EXPECT_EQ(names_of(table->info().parameters), (std::vector<std::string>{"l", "q_max", "m"}));
  const auto lengths = table->dynamics()->with_masses("lengths");
  ASSERT_TRUE(lengths);
  EXPECT_EQ(names_of(lengths->info().parameters), (std::vector<std::string>{"l", "q_max", "mu"}));
  EXPECT_FALSE(table->dynamics()->with_masses("other"));
  const auto inertia = [](const Mechanism& mechanism, const std::vector<double>& design) {
    const MotionState<double> state{kPose, AxisVector<double>(2)};
    PoseDynamics<double> found;
    mechanism.dynamics()->equations(std::span<const double>(design), "+", {&state, 1}, {&found, 1});
    return found.M_X(0, 0);
  };
  EXPECT_NEAR(inertia(*table, {2, 9, 4}), 4, 1e-15);
  EXPECT_NEAR(inertia(*lengths, {2, 9, 4}), 8, 1e-15);
}

TEST(Designs, ThatDescribeNoMechanismAreRefused) {
  const auto mechanism = test::read_robot(
      slider("[[design]]\nname = \"long rod\"\nformula = \"l - 1.5\"\nunit = \"m\"\nrequired = true\n"));
  EXPECT_FALSE(mechanism->design_tests());
  EXPECT_FALSE(mechanism->refuse(std::vector<double>{2, 9}));
  EXPECT_EQ(*mechanism->refuse(std::vector<double>{1, 9}), "long rod is violated: -0.5 m < 0");
  EXPECT_EQ(*mechanism->refuse(std::vector<double>{2, -9}), "the range of joint q is empty: from -9 m to -9 m");
}

TEST(Closures, ShowWhereTheMechanismIsSingular) {
  const auto mechanism =
      test::read_robot(slider("", "e = [\"+\", \"-\"]", "closures = [\"((q - x)^2 + y^2 - l^2)/2\", \"y - p\"]"));
  const PoseReport report = mechanism->inspect(std::vector<double>{2, 9}, kPose, "-", no_limits(mechanism->info()));
  EXPECT_NEAR(*report.det_Jq, kHeight, 1e-15);  // -(q - x)
  EXPECT_NEAR((*report.G)(0, 0), kHeight, 1e-15);
  EXPECT_NEAR((*report.G)(0, 1), 1.2, 1e-15);
  EXPECT_NEAR((*report.J)(0, 1), 1.2 / kHeight, 1e-15);
  EXPECT_THAT(test::refusal_of(slider("", "e = [\"+\", \"-\"]", "closures = [\"q - x\"]")),
              HasSubstr("as many formulas"));
}

}  // namespace
}  // namespace pkm
