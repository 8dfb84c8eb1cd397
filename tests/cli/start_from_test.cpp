// `pkmopt run NEW.toml --start-from OLD.h5`: designs of another study as starting points.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/cli/study_program.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;

class StartFromProgram : public StudyProgram {
 protected:
  void SetUp() override {
    StudyProgram::SetUp();
    write("old.toml", 0.15, "workspace-volume", "optimiser = \"ga\"\npopulation = 24\ngenerations = 8");
    ASSERT_EQ(run({"run", "old.toml", "--seed", "3", "--quiet"}), 0) << output_;
  }

  /// A study of the lengths a (at least `least_a`), b and l_d.
  void write(const std::string& name, double least_a, const std::string& objective, const std::string& stage) {
    std::ofstream(path(name)) << "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = " << least_a
                              << ", max = 0.5 }\nb = { min = 0.4, max = 1.5 }\nl_d = { min = 0.3, max = 1.2 }\n"
                                 "[workspace]\nmethod = \"columns\"\n[[objective]]\ntype = \""
                              << objective << "\"\n[[stage]]\n"
                              << stage << '\n';
  }

  static std::vector<double> design_of(const StudyContents& study, std::int64_t row) {
    const auto design = study.stages[0].table.design(static_cast<std::size_t>(row));
    return {design.begin(), design.end()};
  }
};

TEST_F(StartFromProgram, FirstPopulationHasTheBestDesignsOfTheOtherStudy) {
  write("new.toml", 0.15, "workspace-ratio", "optimiser = \"ga\"\npopulation = 20\ngenerations = 3");
  ASSERT_EQ(run({"run", "new.toml", "--start-from", "old.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("designs of old.h5\n"));
  const StudyContents old = read("old.h5"), found = read("new.h5");
  EXPECT_EQ(design_of(found, 0), std::vector<double>(old.best_design().begin(), old.best_design().end()));
  const auto& population = found.stages[0].generations.population_of(0);
  int taken = 0;
  for (const std::int64_t row : population)
    for (std::size_t other = 0; other < old.stages[0].table.size(); ++other)
      taken += design_of(found, row) == design_of(old, static_cast<std::int64_t>(other));
  EXPECT_GE(taken, 3);
  EXPECT_LE(taken, 10);  // half of the population

  // The designs are part of the study: without the other file, the run is repeated and resumed with the same bits.
  fs::remove(path("old.h5"));
  ASSERT_EQ(run({"run", "new.toml", "--resume", "--quiet"}), 1) << output_;
  EXPECT_THAT(output_, HasSubstr("holds the study with --start-from old.h5, not with no changes"));
  ASSERT_EQ(run({"resume", "new.h5", "--generations", "5", "--quiet"}), 0) << output_;
  std::ofstream(path("stored.toml")) << found.toml;
  ASSERT_EQ(run({"run", "stored.toml", "--quiet"}), 0) << output_;
  ASSERT_EQ(run({"resume", "stored.h5", "--generations", "5", "--quiet"}), 0) << output_;
  EXPECT_EQ(read("stored.h5").stages[0].table.designs, read("new.h5").stages[0].table.designs);
}

TEST_F(StartFromProgram, SolverStartsAtTheBestDesign) {
  write("new.toml", 0.15, "workspace-ratio", "optimiser = \"nlopt\"");
  ASSERT_EQ(run({"run", "new.toml", "--start-from", "old.h5"}), 0) << output_;
  EXPECT_THAT(output_, HasSubstr("design 1 of old.h5"));
  const StudyContents old = read("old.h5");
  EXPECT_EQ(design_of(read("new.h5"), 0), std::vector<double>(old.best_design().begin(), old.best_design().end()));
}

TEST_F(StartFromProgram, SaysWhichDesignsAreMoved) {
  ASSERT_LT(read("old.h5").best_design()[0], 0.16);
  write("new.toml", 0.16, "workspace-ratio", "optimiser = \"nlopt\"");
  ASSERT_EQ(run({"run", "new.toml", "--start-from", "old.h5"}), 0) << output_;
  EXPECT_THAT(output_,
              HasSubstr("starts from 1 design of old.h5, of which 1 moved to the nearest design within the bounds"));
  EXPECT_EQ(design_of(read("new.h5"), 0)[0], 0.16);
}

TEST_F(StartFromProgram, RefusesStudiesWithoutCommonVariables) {
  std::ofstream(path("other.toml"))
      << "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\nl_u = { min = 0.3, max = 1.2 }\n"
         "[workspace]\nmethod = \"columns\"\n[[objective]]\ntype = \"workspace-volume\"\n"
         "[[stage]]\noptimiser = \"nlopt\"\n";
  ASSERT_EQ(run({"run", "other.toml", "--start-from", "old.h5"}), 2) << output_;
  EXPECT_THAT(output_,
              HasSubstr("old.h5: found a study with the variables a, b, l_d; expected one that has a variable in "
                        "common with other.toml (l_u)"));
  ASSERT_EQ(run({"run", "other.toml", "--start-from", "old.toml"}), 2) << output_;
  EXPECT_THAT(output_, HasSubstr("old.toml"));
  EXPECT_FALSE(fs::exists(path("other.h5")));
}

}  // namespace
}  // namespace pkm::testing
