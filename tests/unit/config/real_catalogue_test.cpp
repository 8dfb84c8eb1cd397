// Studies of the program's own catalogues: what the reader completes and refuses with real entries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/math/portable.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "tests/unit/config/real_studies.hpp"

namespace pkm::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kFourPpa =
    "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.2, max = 0.4 }\nb = { min = 0.7, max = 0.9 }\n"
    "[[objective]]\ntype = \"workspace-volume\"\n";                 // lines 1 to 7
const std::string kGa = "[[stage]]\noptimiser = \"ga\"\n";          // lines 8, 9
const std::string kLinear = "[[constraint]]\ntype = \"linear\"\n";  // lines 10, 11

Study read_more(const std::string& more) { return read_real(kFourPpa + kGa + more); }

std::string complaint_of(const std::string& more) { return real_complaint(kFourPpa + kGa + more); }

TEST(RealCatalogue, GaSpellsOutDefaultsThatDependOnTheVariables) {
  const Study study = read_more("");
  const Options& options = study.stages[0].options;
  EXPECT_EQ(options.integer("population"), 20);
  EXPECT_EQ(options.number("mutation_probability"), 0.1) << "a fifth of 1 / 2 variables";
  EXPECT_THAT(describe(study), HasSubstr("population             20"));
  EXPECT_EQ(read_more("crossover = \"sbx\"\n").stages[0].options.number("mutation_probability"), 0.5);
  EXPECT_EQ(read_more("population = 8\n").stages[0].options.integer("population"), 8);
}

TEST(RealCatalogue, LinearBoundIsInTheUnitOfItsParameters) {
  const Study study = read_more(kLinear + "coefficients = { a = 1, b = -1 }\nbound = \"-200 mm\"\n");
  EXPECT_EQ(study.constraints[0].options.number("bound"), -0.2);
  EXPECT_EQ(study.problem->margins()[0].unit, "m");
  EXPECT_EQ(complaint_of(kLinear + "coefficients = { a = 1 }\nbound = \"1 rad\"\n"),
            "s.toml:13: constraint[1].bound: found \"1 rad\"; expected a number in m, or text with a unit made of um, "
            "mm, cm, dm, m, km, in, inch, ft");
}

TEST(RealCatalogue, LinearNamesParameters) {
  EXPECT_EQ(complaint_of(kLinear + "coefficients = {}\n"),
            "s.toml:10: constraint[1]: coefficients = {} is empty; expected at least one parameter");
  EXPECT_EQ(
      complaint_of(kLinear + "coefficients = { l_x = 1 }\nbound = \"1 m\"\n"),
      "s.toml:10: constraint[1]: coefficient of 'l_x', which is not a parameter of mechanism 4ppa-2par; expected one "
      "of a, b, l_u, l_d, d, L0, R_u, R_d, d_u, d_d, d_0, R_p, R_s, "
      "lambda_u, lambda_d, lambda_s, lambda_p, m_c, kappa, kappa_p, m_p, c_p; did you mean 'l_u'?");
}

TEST(RealCatalogue, PlaneOffTheRailIsWarnedOf) {
  const std::string where = "the workspace of the middle of the variables' bounds is empty: no pose ";
  EXPECT_THAT(read_more("").warnings, ElementsAre());
  EXPECT_THAT(read_more("[workspace]\ny = -0.1\n").warnings,
              ElementsAre(where + "on the plane y = -0.1 m is feasible"));
  EXPECT_THAT(read_more("[workspace]\nmethod = \"voxels\"\ny = 2.6\n").warnings,
              ElementsAre(where + "on the plane y = 2.6 m is feasible"));
  EXPECT_EQ(complaint_of("[workspace]\ny = \"integrated\"\n[baseline]\nL0 = 0\n"),
            "s.toml:12: baseline: the range of joint q1 is empty: from 0 m to 0 m");
}

/// A study of another mechanism, its [workspace] being `workspace`.
std::string quadrupteron(const std::string& workspace) {
  return "[mechanism]\ntype = \"quadrupteron\"\n[variables]\nr = { min = 0.03, max = 0.05 }\n"
         "[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\n[workspace]\n" +
         workspace;
}

Study read_quadrupteron(const std::string& workspace) { return read_real(quadrupteron(workspace)); }

std::string quadrupteron_message(const std::string& workspace) { return real_complaint(quadrupteron(workspace)); }

TEST(RealCatalogue, TheHeldCoordinateIsTheOneThatIsGiven) {
  const auto plan = [](const std::string& workspace) { return read_quadrupteron(workspace).problem->parts().plan; };
  EXPECT_TRUE(plan("").fixed.empty());
  EXPECT_EQ(plan("phi = \"30 deg\"").fixed.at(0).coordinate, 3);
  EXPECT_EQ(plan("phi = \"30 deg\"").fixed.at(0).value, kPi / 6);
  EXPECT_EQ(plan("x = \"200 mm\"").fixed.at(0).coordinate, 0);
  EXPECT_EQ(plan("z = \"middle\"").fixed.at(0).coordinate, 2);
  EXPECT_EQ(plan("z = \"middle\"").fixed.at(0).kind, FixedCoordinate::Kind::default_value);
  // cells, box and nodes are those of the coordinates that are left
  EXPECT_THAT(plan("method = \"voxels\"\ny = 0.2\ncells = { x = 4, z = 5, phi = 6 }").voxels()->cells,
              ElementsAre(4, 5, 6));
  EXPECT_THAT(plan("y = 0.2\nnodes = { phi = 6, x = 4 }").columns()->nodes, ElementsAre(4, 6));
  EXPECT_THAT(plan("z = 0.2\nnodes = { phi = 6, x = 4 }").columns()->nodes, ElementsAre(4, 6)) << "columns along y";
  EXPECT_THAT(plan("nodes = { y = 6, x = 4 }").columns()->nodes, ElementsAre(4, 6));
  EXPECT_EQ(read_quadrupteron("x = 0.2").problem->objectives()[0].unit, "m^2 rad");
  EXPECT_EQ(read_quadrupteron("phi = 0").problem->objectives()[0].unit, "m^3");
  EXPECT_THAT(describe(read_quadrupteron("x = 0.2")), HasSubstr("  x          200 mm\n"));
}

TEST(RealCatalogue, TheSweptCoordinatesMayBeNamed) {
  const Study study = read_quadrupteron("sweep = [\"phi\", \"x\", \"y\"]");
  const WorkspacePlan& plan = study.problem->parts().plan;
  EXPECT_THAT(sweep_of(study.problem->parts().mechanism->info(), plan).swept, ElementsAre(0, 1, 3));
  EXPECT_EQ(study.problem->objectives()[0].unit, "m^2 rad");
  EXPECT_THAT(describe(study), HasSubstr("  sweep      x, y, phi\n"));
  EXPECT_EQ(quadrupteron_message("sweep = [\"x\", \"y\", \"z\"]\nphi = 0.1"), "accepted");

  EXPECT_EQ(quadrupteron_message("sweep = [\"x\", \"y\", \"z\"]\nz = 0.2"),
            "s.toml:11: workspace.z: the coordinate z is swept (line 10), so it cannot be fixed");
  EXPECT_EQ(quadrupteron_message("sweep = [\"x\", \"y\", \"x\"]"),
            "s.toml:10: workspace.sweep[3]: this coordinate is swept already");
  EXPECT_EQ(quadrupteron_message("sweep = [\"x\", \"phy\"]"),
            "s.toml:10: workspace.sweep[2]: found \"phy\"; expected one of x, y, z, phi; did you mean 'phi'?");
  EXPECT_EQ(read_quadrupteron("sweep = [\"x\", \"y\"]").problem->objectives()[0].unit, "m^2");
  EXPECT_EQ(quadrupteron_message("sweep = []"),
            "s.toml:10: workspace.sweep: found []; expected a list of the swept coordinates, such as [\"x\", \"y\", "
            "\"z\"]");
}

TEST(RealCatalogue, WrongHeldCoordinates) {
  EXPECT_EQ(read_quadrupteron("x = 0.2\nphi = 0").problem->objectives()[0].unit, "m^2") << "two are fixed";
  EXPECT_EQ(quadrupteron_message("phi = 30"),
            "s.toml:10: workspace.phi: found 30; expected an angle in [-pi, pi] rad; write \"30 deg\" for degrees");
  EXPECT_THAT(quadrupteron_message("method = \"voxels\"\ny = 0.2\ncells = { x = 4, y = 5, z = 6 }"),
              HasSubstr("s.toml:12: workspace.cells.y: found an unknown coordinate; expected one of x, z, phi"));
}

const std::string kClearance = "[[constraint]]\ntype = \"clearance\"\n";  // lines 10, 11

TEST(RealCatalogue, ClearanceCutsTheWorkspaceByBothMethods) {
  const auto volume = [](const std::string& more) {
    const Study study = read_more(more);
    WorkspaceResult<double> survey;
    const ProblemParts& parts = study.problem->parts();
    evaluate_once<double>(*prepare_workspace(*parts.mechanism, parts.plan, parts.request), parts.parameters, survey);
    return survey.volume;
  };
  const std::string columns = "[workspace]\nmethod = \"columns\"\n", voxels = "[workspace]\nmethod = \"voxels\"\n";
  for (const auto& method : {columns, voxels}) {
    const double free = volume(method), touching = volume(method + kClearance),
                 apart = volume(method + kClearance + "min = \"20 mm\"\n");
    EXPECT_LT(touching, 0.995 * free) << method;
    EXPECT_LT(apart, 0.999 * touching) << method;
    EXPECT_EQ(volume(method + "limits = { clearance_min = \"20 mm\" }\n"), apart) << method;
    EXPECT_EQ(volume(method + "limits = { clearance_min = -2 }\n"), free) << method;
    EXPECT_EQ(volume(method + kClearance + "min = \"60 mm\"\n"), 0) << "the lower bars are 40 mm from the platform";
  }
  EXPECT_NEAR(volume(voxels + kClearance), volume(columns + kClearance), 0.01);
}

TEST(RealCatalogue, ClearanceIsSpelledOut) {
  const Study study = read_more(kClearance);
  EXPECT_EQ(study.constraints[0].role, "restricts the workspace by clearance_min");
  EXPECT_EQ(study.constraints[0].options.number("min"), 0);
  EXPECT_THAT(describe(study), ::testing::ContainsRegex("clearance_min +0 mm +from constraint.1. clearance .line 10."));
  EXPECT_THAT(describe(read_more("")), HasSubstr("clearance_min  -2000 mm"));
  EXPECT_EQ(complaint_of(kClearance + "min = \"-1 mm\"\n"), "accepted") << "in the range of clearance_min";
  EXPECT_EQ(complaint_of(kClearance + "min = \"-3 m\"\n"),
            "s.toml:12: constraint[1].min: found \"-3 m\"; expected a number in [-2, 100] m");
  EXPECT_EQ(complaint_of(kClearance + "max = 1\n"),
            "s.toml:12: constraint[1].max: found an unknown key; expected one of type, min");
  EXPECT_EQ(
      complaint_of("[workspace]\nlimits = { clearance_min = 0 }\n" + kClearance),
      "s.toml:12: constraint[1]: the threshold clearance_min is set here and in workspace.limits (line 11); set it "
      "once");
}

TEST(RealCatalogue, GradientsAreRefusedUnderAClearance) {
  const std::string gradient = "[[stage]]\noptimiser = \"ipopt\"\n";
  EXPECT_EQ(complaint_of(gradient), "accepted");
  EXPECT_EQ(
      complaint_of(kClearance + gradient),
      "s.toml:13: stage[2].optimiser: the optimiser ipopt needs derivatives, but the study limits the clearance "
      "of links (clearance_min), so that ends of columns have no closed form and the analysis has no derivatives; "
      "use an optimiser without gradients, or keep the sliders apart by h_min");
  EXPECT_EQ(complaint_of(kClearance + "[[stage]]\noptimiser = \"nlopt\"\nalgorithm = \"bobyqa\"\n"), "accepted");
}

TEST(RealCatalogue, AParameterCannotVaryBesideTheThresholdThatTakesItsPlace) {
  const std::string hybrid =
      "[mechanism]\ntype = \"2t1r-p-hybrid\"\n[variables]\ntau_s = { min = 0.05, max = 0.2 }\n"
      "[[objective]]\ntype = \"workspace-volume\"\n" +
      kGa;
  const auto message = [&](const std::string& limit) { return real_complaint(hybrid + limit); };
  EXPECT_EQ(message("[workspace]\nlimits = { tau_s = 0.1 }\n"),
            "s.toml:4: variables.tau_s: the threshold tau_s is set in workspace.limits (line 10), so it cannot be a "
            "variable");
  EXPECT_EQ(message("[[constraint]]\ntype = \"singularity-margin\"\ntau_s = 0.1\n"),
            "s.toml:4: variables.tau_s: the threshold tau_s is set in constraint[1] singularity-margin (line 9), so it "
            "cannot be a variable");
}

}  // namespace
}  // namespace pkm::testing
