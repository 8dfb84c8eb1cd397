// `pkmopt show`: studies whose text this program cannot read, infeasible best designs, rounded designs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/storage/study_file.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A study interrupted after one evaluation.
StudyContents interrupted(Status status) {
  StudyContents c;
  c.name = "old";
  c.toml = "[mechanism]\ntype = \"4ppa-2par\"\nforgotten = 1\n";
  c.toml_file = "old.toml";
  c.state = StudyState::interrupted;
  c.problem.mechanism = "4ppa-2par";
  c.problem.parameters = {{"a", "m", 0.2, 0}};
  c.problem.variables = {{"a", "m", 0.1, 0.3, 0}};
  c.problem.objectives = {{"workspace-ratio", "rad", "V / V_mech", Direction::maximise}};
  c.problem.margins = {{"rail-length", "m", "eq 18"}};
  c.stages.push_back({"ga", {}, EvaluationTable(c.problem.shape())});
  EvaluationTable& table = c.stages[0].table;
  table.extend(1);
  table.design(0)[0] = 0.25;
  table.slot(0).objectives[0] = 0.125;
  table.slot(0).margins[0] = status == Status::feasible ? 0.5 : -0.5;
  table.status[0] = status;
  c.best = {0, 0};
  return c;
}

TEST(CliShow, WorksIfTheStudyTextCannotBeRead) {
  const StudyFolder folder;
  const std::string file = folder.path() + "/old.h5";
  write_study(file, interrupted(Status::feasible));
  const auto shown = pkmopt({"show", file});
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("best so far: a = 250 mm, workspace-ratio = 0.125 rad\n"));
  EXPECT_THAT(shown.out, HasSubstr("note: this program cannot read the study's text, so references are omitted ("));
  EXPECT_THAT(shown.out, HasSubstr("forgotten"));
}

TEST(CliShow, MarksAnInfeasibleBestDesign) {
  const StudyFolder folder;
  const std::string file = folder.path() + "/old.h5";
  write_study(file, interrupted(Status::infeasible));
  EXPECT_THAT(pkmopt({"show", file}).out,
              HasSubstr("best so far, which is infeasible: a = 250 mm, workspace-ratio = 0.125 rad\n"));
}

TEST(CliShow, ExplainsProblemsOfTheRoundedDesign) {
  const StudyFolder folder;
  const std::string file = folder.path() + "/old.h5";
  StudyContents c = interrupted(Status::feasible);
  c.state = StudyState::finished;
  DesignRecord design;
  design.parameters = {0.25};
  design.objectives = {0.125};
  design.margins = {0.5};
  design.status = Status::feasible;
  c.final.emplace();
  c.final->best = c.final->rounded = design;
  write_study(file, c);
  EXPECT_THAT(pkmopt({"show", file}).out, Not(HasSubstr("the rounded design")));

  c.final->rounded->reason = "a = 0.4 m lies outside its bounds";
  write_study(file, c);
  EXPECT_THAT(pkmopt({"show", file}).out,
              HasSubstr("the rounded design is feasible, but a = 0.4 m lies outside its bounds\n"));
  EXPECT_EQ(pkmopt({"show", file, "--json"}).json()["rounded"]["reason"], "a = 0.4 m lies outside its bounds");

  c.final->rounded->status = Status::infeasible;
  c.final->rounded->margins = {-0.5};
  write_study(file, c);
  EXPECT_THAT(pkmopt({"show", file}).out, HasSubstr("the rounded design is infeasible: a = 0.4 m lies outside its "
                                                    "bounds; rail-length is violated, margin -500 mm\n"));
}

}  // namespace
}  // namespace pkm::testing
