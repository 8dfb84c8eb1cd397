// Studies of the program's own catalogues: what the reader completes and refuses with real entries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/core/error.hpp"
#include "engine/setup/study.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kHead =
    "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.2, max = 0.4 }\nb = { min = 0.7, max = 0.9 }\n"
    "[[objective]]\ntype = \"workspace-volume\"\n";                 // lines 1 to 7
const std::string kStage = "[[stage]]\noptimiser = \"ga\"\n";       // lines 8, 9
const std::string kLinear = "[[constraint]]\ntype = \"linear\"\n";  // lines 10, 11

Study read(const std::string& more) {
  return read_study_toml(kHead + kStage + more, "s.toml",
                         {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

std::string message_of(const std::string& more) {
  try {
    read(more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RealCatalogue, GaSpellsOutDefaultsThatDependOnTheVariables) {
  const Study study = read("");
  const Options& options = study.stages[0].options;
  EXPECT_EQ(options.integer("population"), 20);
  EXPECT_EQ(options.number("mutation_probability"), 0.1) << "a fifth of 1 / 2 variables";
  EXPECT_THAT(describe(study), HasSubstr("population             20"));
  EXPECT_EQ(read("crossover = \"sbx\"\n").stages[0].options.number("mutation_probability"), 0.5);
  EXPECT_EQ(read("population = 8\n").stages[0].options.integer("population"), 8);
}

TEST(RealCatalogue, LinearBoundIsInTheUnitOfItsParameters) {
  const Study study = read(kLinear + "coefficients = { a = 1, b = -1 }\nbound = \"-200 mm\"\n");
  EXPECT_EQ(study.constraints[0].options.number("bound"), -0.2);
  EXPECT_EQ(study.problem->margins()[0].unit, "m");
  EXPECT_EQ(message_of(kLinear + "coefficients = { a = 1 }\nbound = \"1 rad\"\n"),
            "s.toml:13: constraint[1].bound: found \"1 rad\"; expected a number in m, or text with a unit made of um, "
            "mm, cm, dm, m, km, in");
}

TEST(RealCatalogue, LinearNamesParameters) {
  EXPECT_EQ(message_of(kLinear + "coefficients = {}\n"),
            "s.toml:10: constraint[1]: coefficients = {} relates nothing; name at least one parameter");
  EXPECT_EQ(
      message_of(kLinear + "coefficients = { l_x = 1 }\nbound = \"1 m\"\n"),
      "s.toml:10: constraint[1]: coefficient of 'l_x', which is no parameter of mechanism 4ppa-2par; expected one "
      "of a, b, l_u, l_d, d, L0, R_u, R_d, d_u, d_d, d_0; did you mean 'l_u'?");
}

TEST(RealCatalogue, PlaneOffTheRailIsWarnedOf) {
  const std::string where = "the workspace of the middle of the variables' bounds is empty: no pose ";
  EXPECT_THAT(read("").warnings, ElementsAre());
  EXPECT_THAT(read("[workspace]\ny = -0.1\n").warnings, ElementsAre(where + "on the plane y = -0.1 m is feasible"));
  EXPECT_THAT(read("[workspace]\nmethod = \"voxels\"\ny = 2.6\n").warnings,
              ElementsAre(where + "on the plane y = 2.6 m is feasible"));
  EXPECT_THAT(read("[workspace]\ny = \"integrated\"\n[baseline]\nL0 = 0\n").warnings,
              ElementsAre("the workspace of the baseline is empty: no pose at any y is feasible"));
}

TEST(RealCatalogue, NodesDoNotIntegrateOverThePlane) {
  EXPECT_EQ(
      message_of("[workspace]\ny = \"integrated\"\nnodes = { x = 12, theta = 12 }\n"),
      "s.toml:10: workspace: nodes fix the accuracy on one plane y only; with y = \"integrated\" give a tolerance "
      "instead");
}

}  // namespace
}  // namespace pkm
