// Studies that find nothing: `run` and `resume` print a diagnosis and give exit code 4, `show` prints it too; `check`
// finds contradictions before a run.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// Designs are feasible, but every workspace is empty.
const std::string kEmpty =
    study_with("[workspace]\nlimits = { beta_min = 0.9, beta_max = 0.5 }") + "population = 8\ngenerations = 2\n";
/// No design is feasible.
const std::string kInfeasible =
    study_with("[[constraint]]\ntype = \"conditioning\"\nmin = 0.9") + "population = 8\ngenerations = 2\n";
const std::string kGood = study_with("") + "population = 8\ngenerations = 2\n";

TEST(CliDiagnosis, ARunThatFindsNothingIsExplainedWithExitCode4) {
  const StudyFolder folder;
  folder.write("s.toml", kInfeasible);
  const auto run = pkmopt({"run", "s.toml"}, folder.path());
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_THAT(run.out, HasSubstr("diagnosis: nothing feasible: none of 24 designs is feasible: 24 infeasible\n"
                                 "  no design satisfies conditioning; the closest misses it by 0."));
  EXPECT_THAT(run.out, HasSubstr("least infeasible"));
  const auto text = run.out.substr(run.out.find("diagnosis: "));
  const std::string diagnosis = text.substr(0, std::min(text.find("this run:"), text.find("written to")));

  const auto shown = pkmopt({"show", "s.h5"}, folder.path());
  EXPECT_EQ(shown.exit_code, 0) << "show itself has succeeded";
  EXPECT_THAT(shown.out, HasSubstr(diagnosis));
  const auto printed = pkmopt({"show", "s.h5", "--json"}, folder.path()).json();
  EXPECT_EQ(printed["diagnosis"]["finding"], "nothing feasible");
  EXPECT_EQ(printed["diagnosis"]["reasons"][0]["names"][0], "conditioning");
  const auto resumed = pkmopt({"resume", "s.h5"}, folder.path());
  EXPECT_EQ(resumed.exit_code, 4);
  EXPECT_THAT(resumed.out, HasSubstr(diagnosis));
  const auto extended = pkmopt({"resume", "s.h5", "--generations", "3", "--quiet"}, folder.path());
  EXPECT_EQ(extended.exit_code, 4);
  EXPECT_THAT(extended.err, HasSubstr("none of 32 designs is feasible"));
}

TEST(CliDiagnosis, QuietPrintsOneLine) {
  const StudyFolder folder;
  folder.write("s.toml", kInfeasible);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"run", "s.toml", "--quiet"}, {"resume", "s.h5", "--quiet"}}) {
    const auto run = pkmopt(command, folder.path());
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_EQ(run.out, "");
    EXPECT_THAT(run.err, StartsWith("pkmopt: nothing feasible: none of 24 designs is feasible: 24 infeasible; no "
                                    "design satisfies conditioning; the closest misses it by 0."));
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1);
  }
}

TEST(CliDiagnosis, AnEmptyWorkspaceIsExplained) {
  const StudyFolder folder;
  folder.write("s.toml", kEmpty);
  const auto run = pkmopt({"run", "s.toml"}, folder.path());
  EXPECT_EQ(run.exit_code, 4) << run.err;
  const std::string contradiction = "beta_min = 0.9 rad is not below beta_max = 0.5 rad; no pose satisfies both\n";
  EXPECT_THAT(run.err, HasSubstr("pkmopt: warning: " + contradiction));
  EXPECT_THAT(run.out,
              HasSubstr("diagnosis: nothing found: workspace-ratio is 0 for each of the 24 feasible designs\n  " +
                        contradiction + "  no pose sampled for the best-ranked design satisfies beta_min"));
}

/// The objective is a parameter, so it says nothing about the workspace.
TEST(CliDiagnosis, NoneIfTheObjectiveIsAParameter) {
  const StudyFolder folder;
  folder.write("s.toml", "[mechanism]\nfile = \"" PKM_EXPERIMENTS R"(/mechanisms/rotary-delta.toml"
[variables]
l_a = { min = 0.1, max = 0.3 }
[workspace]
method = "voxels"
cells = { x = 12, y = 12, z = 12 }
[[objective]]
type = "expression"
name = "size_of_crank"
expression = "l_a"
unit = "m"
direction = "minimise"
[[constraint]]
type = "workspace-volume"
min = 0.05
[[stage]]
optimiser = "ga"
population = 8
generations = 3
)");
  const auto run = pkmopt({"run", "s.toml"}, folder.path());
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_THAT(run.out, Not(HasSubstr("diagnosis")));
  const auto best = pkmopt({"show", "s.h5", "--json"}, folder.path()).json().at("best");
  EXPECT_NEAR(best["objectives"]["size_of_crank"].get<double>(), 0.17, 0.01);
  EXPECT_GE(best["constraints"]["workspace-volume"].get<double>(), 0);
}

TEST(CliDiagnosis, SeedsThatFindNothingAreExplained) {
  const StudyFolder folder;
  folder.write("s.toml", kInfeasible);
  const auto run = pkmopt({"run", "s.toml", "--seeds", "2"}, folder.path());
  EXPECT_EQ(run.exit_code, 4) << run.err;
  EXPECT_THAT(run.out, HasSubstr("0 of 2 seeds ended feasible\ndiagnosis: nothing feasible: "));
}

TEST(CliDiagnosis, NoneIfADesignIsFeasible) {
  const StudyFolder folder;
  folder.write("s.toml", kGood);
  const auto run = pkmopt({"run", "s.toml"}, folder.path());
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, Not(HasSubstr("diagnosis")));
  EXPECT_TRUE(pkmopt({"show", "s.h5", "--json"}, folder.path()).json().at("diagnosis").is_null());
}

TEST(CliDiagnosis, CheckFindsContradictionsAndEvaluatesSampleDesigns) {
  const StudyFolder folder;
  folder.write("empty.toml", kEmpty);
  const auto empty = pkmopt({"check", "empty.toml"}, folder.path());
  EXPECT_EQ(empty.exit_code, 4) << empty.err;
  EXPECT_THAT(empty.out, HasSubstr("\ncontradiction: beta_min = 0.9 rad is not below beta_max = 0.5 rad"));
  const auto printed = pkmopt({"check", "empty.toml", "--json"}, folder.path());
  EXPECT_EQ(printed.exit_code, 4);
  EXPECT_EQ(printed.json()["contradictions"][0]["names"][1], "beta_max");

  folder.write("infeasible.toml", kInfeasible);
  const auto infeasible = pkmopt({"check", "infeasible.toml"}, folder.path());
  EXPECT_EQ(infeasible.exit_code, 0) << "the samples prove nothing: " << infeasible.err;
  EXPECT_THAT(infeasible.out, HasSubstr("\nprobe: 0 of "));
  EXPECT_THAT(infeasible.out, HasSubstr("designs is feasible: "));
  EXPECT_THAT(infeasible.out, HasSubstr("\n  no design satisfies conditioning; the closest misses it by 0."));

  folder.write("good.toml", kGood);
  const auto good = pkmopt({"check", "good.toml"}, folder.path());
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_THAT(good.out, HasSubstr("\nprobe: 64 of 64 designs spread over the bounds are feasible\n"));
  EXPECT_THAT(good.out, Not(HasSubstr("warning")));
  const auto tried = pkmopt({"check", "good.toml", "--json"}, folder.path()).json();
  EXPECT_EQ(tried["probe"]["designs"], 64);
  EXPECT_EQ(tried["probe"]["feasible"], 64);
  EXPECT_TRUE(tried["probe"]["diagnosis"].is_null());
}

}  // namespace
}  // namespace pkm::testing
