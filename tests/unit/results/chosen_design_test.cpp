#include "engine/results/chosen_design.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/optimisers/optimiser.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

using ::testing::HasSubstr;

Study study(const std::string& baseline = "[baseline]\na = 0.22\n") {
  const std::string text = "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.1, max = 0.3 }\n" + baseline +
                           "[[objective]]\ntype = \"workspace-ratio\"\n[[stage]]\noptimiser = \"ga\"\n";
  return read_study_toml(text, "s.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

/// Two stages of two generations with two designs each: a = 0.11, 0.12, .. 0.18. The population of the second
/// generation contains a design of the first one.
StudyContents contents() {
  StudyContents c;
  c.name = "made up";
  double a = 0.11;
  for (int s = 0; s < 2; ++s) {
    StageRecord stage;
    stage.table = EvaluationTable({1, 1, 0, 0});
    stage.table.extend(4);
    for (std::size_t row = 0; row < 4; ++row, a += 0.01) stage.table.design(row)[0] = a;
    stage.generations.first_row = {0, 2};
    stage.generations.population_first = {0, 2};
    stage.generations.population = {0, 1, 3, 1};
    stage.generations.best_row = {0, 3};
    c.stages.push_back(stage);
  }
  c.stages[0].front = FrontRecord{{2, 1}, {}, {}, {}, {}};
  c.best = {1, 3};
  return c;
}

double chosen_a(const DesignChoice& choice) { return chosen_design(contents(), study(), choice).parameters[0]; }

TEST(ChosenDesign, SelectsTheBestDesignByDefault) {
  EXPECT_NEAR(chosen_a({}), 0.18, 1e-12);
  EXPECT_NEAR(chosen_a({.baseline = true}), 0.22, 1e-12);
  EXPECT_NEAR(chosen_a({.generation = 0, .individual = 2, .stage = 1}), 0.12, 1e-12);
  EXPECT_NEAR(chosen_a({.generation = 1, .individual = 1, .stage = 1}), 0.14, 1e-12);
  EXPECT_NEAR(chosen_a({.generation = 1, .individual = 2}), 0.16, 1e-12);  // last stage that has the generation
  EXPECT_NEAR(chosen_a({.front = 1}), 0.13, 1e-12);                        // only stage with a front
  EXPECT_NEAR(chosen_a({.front = 2, .stage = 1}), 0.12, 1e-12);
  const ChosenDesign design = chosen_design(contents(), study(), {.generation = 1, .individual = 2});
  EXPECT_EQ(design.words, "individual 2 of generation 1 of stage 2");
  EXPECT_EQ(design.file_name, "stage-2-generation-1-individual-2");
  EXPECT_EQ(design.parameters.size(), study().problem->parts().parameters.size());
}

std::string error_of(const DesignChoice& choice, const StudyContents& file = contents(), const Study& from = study()) {
  try {
    chosen_design(file, from, choice);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ChosenDesign, ErrorsListTheValidValues) {
  EXPECT_EQ(error_of({.generation = 2, .individual = 1}),
            "--generation: found 2; expected a generation of stage 2, 0 to 1");
  EXPECT_EQ(error_of({.generation = -1, .individual = 1}),
            "--generation: found -1; expected a generation of stage 2, 0 to 1");
  EXPECT_EQ(error_of({.generation = 1, .individual = 3}),
            "--individual: found 3; expected an individual of generation 1, 1 to 2");
  EXPECT_EQ(error_of({.generation = 1, .individual = 0}),
            "--individual: found 0; expected an individual of generation 1, 1 to 2");
  EXPECT_EQ(error_of({.generation = 1, .individual = 1, .stage = 3}),
            "--stage: found 3; expected a stage with a generation: 1, 2");
  EXPECT_EQ(error_of({.front = 3}), "--front: found 3; expected a point of the front of stage 1, 1 to 2");
  EXPECT_EQ(error_of({.front = 1, .stage = 2}), "--stage: found 2; expected a stage with a front: 1");
  EXPECT_EQ(error_of({.baseline = true}, contents(), study("")),
            "--baseline: study made up has no [baseline]; expected a study that has one");
  StudyContents empty = contents();
  empty.stages.clear();
  empty.best = {};
  EXPECT_THAT(error_of({}, empty), HasSubstr("study made up has no best design yet"));
  EXPECT_THAT(error_of({.front = 1}, empty), HasSubstr("has no front; expected a study that has one"));
  EXPECT_THAT(error_of({.generation = 0, .individual = 1}, empty),
              HasSubstr("has no generation; expected a study that has one"));
}

TEST(ChosenDesign, RejectsAmbiguousAndIncompleteChoices) {
  EXPECT_THAT(error_of({.baseline = true, .front = 1}), HasSubstr("--baseline: two designs selected"));
  EXPECT_THAT(error_of({.generation = 1, .individual = 1, .front = 1}), HasSubstr("--front: two designs selected"));
  EXPECT_THAT(error_of({.generation = 1}), HasSubstr("--generation: incomplete"));
  EXPECT_THAT(error_of({.individual = 1}), HasSubstr("--individual: incomplete"));
  EXPECT_THAT(error_of({.stage = 1}), HasSubstr("--stage: --front or --generation is missing"));
  EXPECT_THAT(error_of({.baseline = true, .stage = 1}), HasSubstr("--stage: --front or --generation is missing"));
}

}  // namespace
}  // namespace pkm
