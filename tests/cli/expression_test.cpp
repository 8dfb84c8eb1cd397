// Studies whose objectives, constraints and outputs are formulas, end to end; and all example studies and motions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "engine/storage/study_file.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const std::string kStudy = R"toml([study]
name = "formulas"
seed = 3
[mechanism]
type = "4ppa-2par"
[variables]
a   = { min = 0.15, max = 0.95 }
b   = { min = 0.6, max = 1.5 }
l_u = { min = 0.4, max = 1.2 }
l_d = { min = 0.4, max = 1.2 }
[baseline]
a = 0.2
[[objective]]
type = "OBJECTIVE"
name = "ratio"
expression = "volume / (pi * b * (l_u + l_d))"
unit = "rad"
[[constraint]]
type = "expression"
name = "shape"
expression = """
  l_d - sqrt(l_u^2 + (b - a*cos_theta_min)^2)/2   # eq 21
"""
unit = "m"
[[constraint]]
type = "expression"
name = "width"
expression = "volume / b"
unit = "m rad"
min = "400 mm rad"
[[output]]
type = "expression"
name = "squared"
expression = "volume^2"
unit = "m^4 rad^2"
[[stage]]
optimiser = "ga"
population = 20
generations = 15
)toml";

/// The study without the comment in its formula, and the equivalent study with built-in objectives and constraints.
std::string with_formulas() {
  std::string text = kStudy;
  text.replace(text.find("OBJECTIVE"), 9, "expression");
  text.erase(text.find("   # eq 21"), 10);
  return text;
}
std::string built_in() {
  std::string text = with_formulas();
  const auto replace = [&](const std::string& from, const std::string& to, const std::string& by) {
    const auto begin = text.find(from), end = text.find(to, begin);
    text.replace(begin, end - begin, by);
  };
  replace("type = \"expression\"\nname = \"ratio\"", "[[constraint]]",
          "type = \"workspace-ratio\"\nname = \"ratio\"\n");
  replace("type = \"expression\"\nname = \"shape\"", "[[constraint]]",
          "type = \"workspace-shape\"\nname = \"shape\"\n");
  return text;
}

TEST(CliExpression, CheckPrintsFormulas) {
  const StudyFolder folder;
  const auto check = pkmopt({"check", folder.write("s.toml", with_formulas())});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("  ratio (expression): maximise, in rad\n"
                                   "    expression             \"volume / (pi * b * (l_u + l_d))\"\n"));
  EXPECT_THAT(check.out, HasSubstr("  width (expression): margin >= 0, in m rad\n"));
  EXPECT_THAT(check.out, HasSubstr("    min                    0.4 m rad\n"));
}

TEST(CliExpression, EvaluateShowsFormulasAndTheirValues) {
  const StudyFolder folder;
  const auto file = folder.write("s.toml", with_formulas());
  const json found = pkmopt({"evaluate", file, "--json"}).json();
  const double volume = found["workspace"]["volume"];
  EXPECT_EQ(found["objectives"]["ratio"], volume / (M_PI * 0.8 * (0.6 + 0.55)));
  EXPECT_EQ(found["constraints"]["shape"], 0.55 - std::sqrt(0.6 * 0.6 + 0.8 * 0.8) / 2);
  EXPECT_EQ(found["constraints"]["width"], volume / 0.8 - 0.4);
  EXPECT_EQ(found["outputs"]["squared"], volume * volume);
  const auto text = pkmopt({"evaluate", file});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_THAT(text.out, HasSubstr("l_d - sqrt(l_u^2 + (b - a*cos_theta_min)^2)/2 >= 0 m\n"));
  EXPECT_THAT(text.out, HasSubstr("volume / b >= 0.4 m rad\n"));
}

TEST(CliExpression, FormulasGiveTheSameRunAsBuiltInEntries) {
  const StudyFolder folder;
  folder.write("formulas.toml", with_formulas());
  folder.write("built-in.toml", built_in());
  for (const std::string name : {"formulas", "built-in"}) {
    const auto run = pkmopt({"run", name + ".toml", "--quiet"}, folder.path());
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  const StudyContents formulas = read_study(folder.path() + "/formulas.h5");
  const StudyContents entries = read_study(folder.path() + "/built-in.h5");
  // The same operations in the same order give a bit-identical search.
  EXPECT_EQ(formulas.stages[0].table.designs, entries.stages[0].table.designs);
  EXPECT_EQ(formulas.stages[0].table.status, entries.stages[0].table.status);
  EXPECT_EQ(formulas.best.row, entries.best.row);
  EXPECT_GE(formulas.best.row, 0);
  const auto show = pkmopt({"show", "formulas.h5"}, folder.path());
  EXPECT_EQ(show.exit_code, 0);
  EXPECT_THAT(show.out, HasSubstr("squared"));
  const auto resume = pkmopt({"resume", "formulas.h5", "--generations", "18", "--quiet"}, folder.path());
  EXPECT_EQ(resume.exit_code, 0) << resume.err;
}

TEST(CliExpression, GradientSolversBehaveAsWithBuiltInEntries) {
  for (const std::string solver : {"nlopt", "ipopt"}) {
    const StudyFolder folder;
    for (const std::string name : {"formulas", "built-in"}) {
      std::string text = name == "formulas" ? with_formulas() : built_in();
      text.replace(text.find("l_u = { min = 0.4, max = 1.2 }"), 30, "l_u = { min = 0.4, max = 0.9 }");
      text.erase(text.find("[[stage]]"));
      folder.write(name + ".toml", text + "[[stage]]\noptimiser = \"" + solver + "\"\n");
      const auto run = pkmopt({"run", name + ".toml", "--quiet"}, folder.path());
      ASSERT_EQ(run.exit_code, 0) << run.err;
    }
    const StudyContents formulas = read_study(folder.path() + "/formulas.h5");
    const StudyContents entries = read_study(folder.path() + "/built-in.h5");
    const auto best = [](const StudyContents& study) {
      return study.stages[0].table.objective_row(static_cast<std::size_t>(study.best.row))[0];
    };
    ASSERT_GE(formulas.best.row, 0);
    EXPECT_EQ(formulas.stages[0].table.size(), entries.stages[0].table.size()) << solver;
    EXPECT_LT(formulas.stages[0].table.size(), 50u) << solver;  // few evaluations, because gradients are exact
    EXPECT_NEAR(best(formulas), best(entries), 1e-9) << solver;
    EXPECT_NEAR(best(formulas), 0.43091372, 1e-7) << solver;
  }
}

TEST(CliExpression, ACommentInAFormulaIsRejected) {
  const StudyFolder folder;
  std::string text = kStudy;
  text.replace(text.find("OBJECTIVE"), 9, "expression");
  const auto comment = pkmopt({"check", folder.write("s.toml", text)});
  EXPECT_EQ(comment.exit_code, 2);
  EXPECT_THAT(comment.err, HasSubstr("s.toml:18: constraint[1]: the formula \"  l_d - sqrt(l_u^2 + (b - "
                                     "a*cos_theta_min)^2)/2   # eq 21 \" has a '#' at character 51, which is not "
                                     "allowed in formulas"));
}

TEST(CliExpression, ListShowsOptionsAndNames) {
  const json both = pkmopt({"list", "expression", "--json"}).json();
  EXPECT_EQ(both["objectives"]["direction"], "maximise");
  EXPECT_EQ(both["constraints"]["level"], "design or workspace");
  const auto text = pkmopt({"list", "expression"}).out;
  EXPECT_TRUE(text.starts_with("objectives\n  name       expression\n"));
  EXPECT_THAT(text, HasSubstr("\nconstraints\n  name     expression\n"));
  const json names = pkmopt({"list", "mechanisms", "4ppa-2par", "--json"}).json()["expression_names"];
  const auto named = [&](const std::string& name) {
    for (const auto& each : names)
      if (each["name"] == name) return each;
    return json();
  };
  EXPECT_EQ(named("l_u")["unit"], "m");
  EXPECT_EQ(named("cos_theta_min")["known"], "before the workspace analysis");
  EXPECT_EQ(named("volume"), (json{{"name", "volume"},
                                   {"unit", "m^2 rad"},
                                   {"known", "after the workspace analysis"},
                                   {"meaning", "measure of the feasible poses over the swept coordinates"}}));
}

TEST(CliExamples, EveryStudyPassesItsCheck) {
  int studies = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(PKM_EXPERIMENTS)) {
    const std::string name = file.path().filename().string(), folder = file.path().parent_path().filename().string();
    if (file.path().extension() != ".toml" || folder == "motions" || folder == "tasks" || name == "motors.toml" ||
        name == "gears.toml")
      continue;
    ++studies;
    const auto check = pkmopt({"check", file.path().string()});
    EXPECT_EQ(check.exit_code, 0) << file.path() << check.err;
    EXPECT_THAT(check.out, ::testing::Not(HasSubstr("warning"))) << file.path();
  }
  EXPECT_GE(studies, 7);
}

TEST(CliExamples, EveryMotionIsFeasible) {
  int motions = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(PKM_EXPERIMENTS)) {
    const auto folder = file.path().parent_path();
    if (file.path().extension() != ".toml" || folder.filename() != "motions") continue;
    ++motions;
    const auto result =
        pkmopt({"trajectory", folder.parent_path().filename().string(), "--motion", file.path().string()});
    EXPECT_EQ(result.exit_code, 0) << file.path() << result.err;
  }
  EXPECT_GE(motions, 15);
}

}  // namespace
}  // namespace pkm::testing
