// The objective orientation-workspace in studies.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/generic/files.hpp"
#include "tests/unit/generic/tilting.hpp"

namespace pkm::orientation_objective {
namespace {

using ::testing::AllOf, ::testing::HasSubstr;

Study study_of(const std::string& mechanism, const std::string& text, const std::string& outputs) {
  return read_study_toml("[mechanism]\nfile = \"" + mechanism + ".toml\"\n[workspace]\nmethod = \"voxels\"\n" +
                             outputs + "[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\n",
                         "s.toml", pkm::testing::all_catalogues(), SourceText{text, mechanism + ".toml"});
}
/// The parameter varies between these bounds only because the optimiser of the study needs a variable.
const std::string kGoughVariable = "[variables]\nl_max = { min = 1.5, max = 1.9 }\n";

Study gough_study(const std::string& outputs) {
  return study_of("gough", test::text_of_mechanism("gough"), kGoughVariable + outputs);
}
std::vector<double> values(const Study& study) {
  return study.problem->report(study.problem->parts().parameters).reports;
}
std::string output(const std::string& name, const std::string& keys) {
  return "[[output]]\ntype = \"orientation-workspace\"\ncells = 8\nname = \"" + name + "\"\n" + keys + "\n";
}
std::string complaint(const std::string& mechanism, const std::string& keys) {
  try {
    study_of(mechanism, test::text_of_mechanism(mechanism), output("orientations", keys));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(OrientationWorkspace, AtAPointAndAtAllPointsOfABox) {
  const Study study = gough_study(
      "[[region]]\nname = \"plate\"\nbox = { x = [-0.1, 0.1], y = [-0.1, 0.1], z = [1.3, 1.4] }\nmethod = "
      "\"voxels\"\n" +
      output("middle", "at = { x = 0, y = 0, z = 1.35 }") +
      output("share", "at = { x = 0, y = 0, z = 1.35 }\nmeasure = \"share\"") +
      output("corner", "at = { x = 0.1, y = 0.1, z = 1.4 }") + output("all", "region = \"plate\"\npoints = 2") +
      output("far", "at = { x = 9, y = 0, z = 0 }"));
  const std::vector<double> found = values(study);
  EXPECT_GT(found[0], 0.1);
  EXPECT_NEAR(found[1], found[0] / (8 * std::numbers::pi * std::numbers::pi), 1e-12);
  EXPECT_GT(found[3], 0);
  EXPECT_LT(found[3], found[2]) << "the box contains the point, which is one of its corners";
  EXPECT_EQ(found[4], 0);
}

/// Directions within 60 deg of the vertical, with any rotation about them.
TEST(OrientationWorkspace, OfACone) {
  const std::string text = test::text_of_tilting("zyz");
  const Study study = study_of(
      "tilting", text, "[variables]\ntilt = { min = 0.5, max = 1.5 }\n[[output]]\ntype = \"orientation-workspace\"\n");
  const double pi = std::numbers::pi;
  EXPECT_NEAR(values(study)[0], 2 * pi * 2 * pi * (1 - std::cos(pi / 3)), 1e-3);
}

TEST(OrientationWorkspace, MistakesAreExplained) {
  EXPECT_THAT(complaint("gough", "at = { X = 1 }"), AllOf(HasSubstr("'X'"), HasSubstr("x, y, z")));
  EXPECT_THAT(complaint("gough", "points = 3"), HasSubstr("box"));
  EXPECT_THAT(complaint("gough", "at = { x = 1 }\npoints = 3"), HasSubstr("give one of them"));
  EXPECT_THAT(complaint("rotary-delta", ""), HasSubstr("three coordinates that are angles"));
}

}  // namespace
}  // namespace pkm::orientation_objective
