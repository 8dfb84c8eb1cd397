// Quantities that are formulas, of a mechanism file or of a study: statistics over the workspace with derivatives, pose
// limits, names in formulas, messages.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/catalogue.hpp"
#include "engine/problem/expression.hpp"
#include "tests/unit/config/real_studies.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

/// A slider at q = x + h, h = sqrt(l^2 - y^2), on the square [-1 m, 1 m]^2, all of which it reaches.
const std::string kSlider = R"toml([mechanism]
name = "slider"
[parameters]
l = { default = "2 m", min = "0.1 m", max = "9 m", meaning = "rod" }
[platform]
coordinates = { x = "along x", y = "along y" }
[survey]
box = { x = [-1, 1], y = [-1, 1] }
[inputs]
load = { unit = "N", default = 5 }
[let]
h = "sqrt(l^2 - y^2)"
[[limb]]
name = "rod"
drive = "formula"
joints = { q = "x + h", p = "y" }
range = [-9, 9]
[[quantity]]
name = "height"
formula = "sqrt(l^2 - y^2)"
unit = "m"
meaning = "of the slide above the point"
[[quantity]]
name = "push"
formula = "load*(1 + x^2)"
unit = "N"
[[quantity]]
name = "twice"
formula = "2*l"
unit = "m"
[[quantity]]
name = "speed"
formula = "height_rate"
unit = "m/s"
)toml";

const std::string kColumns = "[workspace]\nmethod = \"columns\"\n";
const std::string kVoxels = "[workspace]\nmethod = \"voxels\"\ncells = { x = 20, y = 40 }\n";
const std::string kVolume = "[[objective]]\ntype = \"workspace-volume\"\n";

Study read(const std::string& tables, const std::string& mechanism = kSlider) {
  const std::string text = "[mechanism]\nfile = \"m.toml\"\n[variables]\nl = { min = 1.1, max = 3 }\n" + tables +
                           (tables.find("[[stage]]") == std::string::npos ? "[[stage]]\noptimiser = \"ga\"\n" : "");
  return read_study_toml(text, "s.toml", all_catalogues(), SourceText{mechanism, "m.toml"});
}
std::string complaint(const std::string& tables) {
  try {
    read(tables);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}
std::string statistic(const std::string& quantity, const std::string& name, const std::string& role = "objective") {
  return "[[" + role + "]]\ntype = \"quantity\"\nquantity = \"" + quantity + "\"\nstatistic = \"" + name + "\"\n";
}
DesignReport evaluate(const Study& study) { return study.problem->report(study.problem->parts().parameters); }

/// The integral of sqrt(l^2 - y^2) over [-b, b].
double integral(double l, double b) { return b * std::sqrt(l * l - b * b) + l * l * std::asin(b / l); }

TEST(FormulaQuantity, HasStatisticsOverColumnsAndVoxels) {
  const std::string all = statistic("height", "mean") + statistic("height", "std", "output") +
                          statistic("height", "min", "output") + statistic("height", "p50", "output") +
                          statistic("push", "mean", "output");
  for (const auto& [method, tolerance] : {std::pair{kColumns, 1e-6}, {kVoxels, 2e-3}}) {
    const Study study = read(method + all);
    EXPECT_EQ(names_of(study.objectives), std::vector<std::string>{"height-mean"});
    const DesignReport report = evaluate(study);
    ASSERT_EQ(report.status, Status::feasible) << report.reason;
    const double mean = integral(2, 1) / 2, square = 4 - 1 / 3.0;  // mean of l^2 - y^2
    EXPECT_NEAR(report.objectives[0], mean, tolerance);
    EXPECT_NEAR(report.reports[0], std::sqrt(square - mean * mean), tolerance);
    EXPECT_NEAR(report.reports[1], std::sqrt(3), 0.04) << "of the samples, which are inside";
    EXPECT_NEAR(report.reports[2], std::sqrt(4 - 0.25), 0.06) << "half of the poses have |y| > 0.5";
    EXPECT_NEAR(report.reports[3], 5 * (1 + 1 / 3.0), 5 * tolerance) << "the load at its default";
    EXPECT_EQ(study.problem->objectives()[0].unit, "m");
  }
}

TEST(FormulaQuantity, HasDerivativesOnColumns) {
  const Study study = read(kColumns + statistic("height", "mean"));
  ASSERT_FALSE(study.problem->why_no_derivatives());
  const std::vector<double> derivatives =
      study.problem->derivatives(std::vector<double>{2}, std::vector<std::size_t>{0});
  EXPECT_NEAR(derivatives[1], 2 * std::asin(0.5), 1e-5) << "mean of l / sqrt(l^2 - y^2)";
  // A smooth minimum is near the minimum in any unit.
  const Study least = read(kColumns + statistic("height", "min"));
  const double smooth = least.problem->derivatives(std::vector<double>{2}, std::vector<std::size_t>{0})[0];
  EXPECT_NEAR(smooth, evaluate(least).objectives[0], 0.01);
  const std::string gradients = "[[stage]]\noptimiser = \"nlopt\"\nalgorithm = \"slsqp\"\n";
  EXPECT_EQ(complaint(kColumns + statistic("height", "std") + gradients), "accepted");
  EXPECT_THAT(complaint(kColumns + statistic("height", "p95") + gradients),
              HasSubstr("quantity with statistic = \"p95\" is a quantile, which has none"));
  EXPECT_THAT(complaint(kVoxels + statistic("height", "mean") + gradients),
              HasSubstr("workspace.method = \"columns\""));
}

TEST(FormulaQuantity, LimitsCutTheWorkspace) {
  const double least = 1.9, b = std::sqrt(4 - least * least);  // |y| <= b
  const std::string limit = "limits = { height = { min = \"1900 mm\" } }\n";
  const Study columns = read(kColumns + limit + kVolume);
  const DesignReport report = evaluate(columns);
  EXPECT_NEAR(report.objectives[0], 4 * b, 1e-7);
  EXPECT_NEAR(columns.problem->derivatives(std::vector<double>{2}, std::vector<std::size_t>{0})[1], 4 * 2 / b, 1e-5);
  const DesignReport voxels = evaluate(read(kVoxels + limit + kVolume));
  EXPECT_NEAR(voxels.objectives[0], 4 * b, 0.1);
  EXPECT_NEAR(evaluate(read(kVoxels + "limits = { height = { min = 1.9, max = 1.99 } }\n" + kVolume)).objectives[0],
              4 * (b - std::sqrt(4 - 1.99 * 1.99)), 0.2);

  const ProblemParts& parts = columns.problem->parts();
  const Mechanism& mechanism = *parts.mechanism;
  const PoseReport outside = mechanism.inspect(parts.parameters, {0, 0.9}, "", parts.plan.limits);
  EXPECT_EQ(outside.reason, "height_min is violated");
  EXPECT_EQ(outside.margins.back().first, "height_min");
  EXPECT_NEAR(outside.margins.back().second, std::sqrt(4 - 0.81) - least, 1e-12);
  const VolumeBounds bounds = mechanism.bounds()->volume(parts.parameters, parts.plan, "", {.gap = 1e-6});
  EXPECT_LE(bounds.lower, 4 * b);
  EXPECT_GE(bounds.upper, 4 * b);
  EXPECT_LT(bounds.gap(), 1e-6);
  const auto names = names_of(expression_names(mechanism, parts.plan));
  EXPECT_EQ(std::ranges::count(names, "height_min"), 1) << "the statistic";
}

TEST(FormulaQuantity, OfAStudyIsOneOfTheMechanism) {
  const std::string own = "[[quantity]]\nname = \"ratio\"\nformula = \"height/l + x^2\"\nmeaning = \"of lengths\"\n";
  const Study study = read(kColumns + "limits = { ratio = { max = 1.5 } }\n" + own + statistic("ratio", "mean") +
                           "[[output]]\ntype = \"expression\"\nexpression = \"ratio_mean*l + height_min\"\n");
  const MechanismInfo& info = study.problem->parts().mechanism->info();
  EXPECT_EQ(names_of(info.quantities).back(), "ratio");
  const DesignReport report = evaluate(study);
  ASSERT_EQ(report.status, Status::feasible) << report.reason;
  EXPECT_GT(report.objectives[0], 1);
  EXPECT_LT(report.objectives[0], 1.5);
  EXPECT_NEAR(report.reports[0], 2 * report.objectives[0] + std::sqrt(3), 0.05);
}

/// Accelerators have no formulas: the generic engine takes their place, on the same cells.
TEST(FormulaQuantity, OfBuiltInMechanisms) {
  const std::string study =
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.15, max = 0.3 }\n"
      "[[quantity]]\nname = \"lean\"\nformula = \"sin(theta)^2\"\n"
      "[[objective]]\ntype = \"conditioning\"\n[[objective]]\ntype = \"workspace-volume\"\n"
      "[[stage]]\noptimiser = \"nsga2\"\n[workspace]\nmethod = \"voxels\"\ncells = { x = 8, z = 8, theta = 12 }\n";
  const std::string more = "[[output]]\ntype = \"quantity\"\nquantity = \"lean\"\n";
  const DesignReport plain = evaluate(read_real(study)), with = evaluate(read_real(study + more));
  ASSERT_EQ(with.status, Status::feasible) << with.reason;
  EXPECT_EQ(with.objectives[1], plain.objectives[1]);
  EXPECT_NEAR(with.objectives[0], plain.objectives[0], 1e-9);
  const DesignReport cut = evaluate(read_real(study + "limits = { lean = { max = 0.25 } }\n" + more));
  EXPECT_LT(cut.objectives[1], plain.objectives[1]);
  EXPECT_LT(cut.reports[0], 0.25);
  EXPECT_THAT(real_complaint(study + "limits = { leaning = { max = 0.25 } }\n"),
              HasSubstr("mechanism 4ppa-2par has no quantity 'leaning'"));
}

TEST(FormulaQuantity, UndefinedValuesFailWithAReason) {
  const std::string undefined = "[[quantity]]\nname = \"root\"\nformula = \"sqrt(x)\"\n" + statistic("root", "mean");
  const DesignReport report = evaluate(read(kVoxels + undefined));
  EXPECT_EQ(report.status, Status::failed);
  EXPECT_EQ(report.reason, "root-mean: root is undefined at 400 of 800 feasible poses");
  EXPECT_EQ(evaluate(read(kVoxels + "limits = { root = { min = 0 } }\n" + undefined)).status, Status::feasible)
      << "a limit cuts undefined poses";
  const DesignReport empty =
      evaluate(read(kVoxels + "limits = { height = { min = \"8 m\" } }\n" + statistic("height", "mean")));
  EXPECT_EQ(empty.reason, "height-mean: no pose is feasible");
}

/// Of a quantity that is no formula: cells are tested one by one.
TEST(BuiltInQuantity, LimitsCutVoxels) {
  const std::string objectives = kVolume + statistic("conditioning", "min", "output");
  const DesignReport all = evaluate(read(kVoxels + objectives));
  const double least = 0.5 * (all.reports[0] + 1);
  const std::string limit = "limits = { conditioning = { min = " + std::to_string(least) + " } }\n";
  const Study study = read(kVoxels + limit + objectives);
  const DesignReport cut = evaluate(study);
  ASSERT_EQ(cut.status, Status::feasible) << cut.reason;
  EXPECT_GE(cut.reports[0], least - 1e-6);
  EXPECT_LT(cut.objectives[0], all.objectives[0]);
  EXPECT_GT(cut.objectives[0], 0);
  const ProblemParts& parts = study.problem->parts();
  const PoseReport outside = parts.mechanism->inspect(parts.parameters, {0, 0.99}, "", parts.plan.limits);
  EXPECT_EQ(outside.reason, "conditioning_min is violated");
  EXPECT_NEAR(outside.margins.back().second, *outside.conditioning - least, 1e-6);
  Scratch scratch;
  std::vector<double> margins;
  const Pose<double> pose = {0, 0.99};
  parts.mechanism->pose_margins()->append(parts.parameters, "", parts.plan.limits, {&pose, 1}, scratch, margins);
  EXPECT_NEAR(margins.back(), outside.margins.back().second, 1e-15);
  EXPECT_THAT(complaint(kColumns + limit + objectives),
              HasSubstr("has no exact columns with a limit of conditioning, which is not given by a formula"));
  EXPECT_THAT(complaint(kVoxels + "limits = { dci = { max = 0.5 } }\n" + kVolume),
              HasSubstr("dci depends on the inertia, so it cannot restrict a workspace"));
}

TEST(FormulaQuantity, MistakesAreNamed) {
  EXPECT_EQ(complaint(kColumns + statistic("heigt", "mean")),
            "s.toml:7: objective[1]: mechanism slider has no quantity 'heigt'; expected one of conditioning, dci, "
            "inertia_condition, velocity_transmission, force_transmission, height, push; did you mean "
            "'height'?");
  EXPECT_THAT(complaint(kColumns + statistic("twice", "mean")),
              HasSubstr("quantity 'twice' depends on the design alone; expected a quantity of the workspace"));
  EXPECT_THAT(complaint(kColumns + statistic("speed", "mean")), HasSubstr("depends on rates of the motion"));
  EXPECT_THAT(complaint(kColumns + statistic("height", "median")),
              HasSubstr("expected one of mean, std, min, max, p5"));
  EXPECT_EQ(complaint(kColumns + "limits = { heigth = { min = 1 } }\n" + kVolume),
            "s.toml:7: workspace.limits.heigth.min: mechanism slider has no quantity 'heigth'; expected one of "
            "conditioning, dci, inertia_condition, velocity_transmission, force_transmission, height, push; "
            "did you mean 'height'?");
  EXPECT_THAT(complaint(kColumns + "limits = { height = 1 }\n" + kVolume),
              HasSubstr("expected a table { min = .., max = .. }, since height is a quantity"));
  EXPECT_THAT(complaint(kColumns + "limits = { height = { least = 1 } }\n" + kVolume),
              HasSubstr("workspace.limits.height.least: found an unknown key"));
  EXPECT_THAT(complaint(kColumns + "limits = { height = { min = \"3 deg\" } }\n" + kVolume), HasSubstr("height.min"));
  EXPECT_THAT(complaint(kColumns + "limits = { height = { min = 2, max = 1 } }\n" + kVolume), "accepted");
  EXPECT_THAT(complaint(kVolume + "[[quantity]]\nname = \"l\"\nformula = \"x\"\n"), HasSubstr("s.toml:"));
  EXPECT_THAT(complaint(kVolume + "[[quantity]]\nname = \"height\"\nformula = \"x\"\n"),
              HasSubstr("there is already a quantity called 'height'"));
  EXPECT_THAT(complaint(kVolume + "[[quantity]]\nname = \"u\"\nformula = \"hight\"\n"), HasSubstr("did you mean"));
}

}  // namespace
}  // namespace pkm::testing
