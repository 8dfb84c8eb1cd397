#include "engine/report/chosen_design.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/mechanisms/all.hpp"
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

/// Two stages of two generations with two designs each: a = 0.11, 0.12, .. 0.18; the population of the second
/// generation holds a design of the first.
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

double a_of(const DesignChoice& choice) { return chosen_design(contents(), study(), choice).parameters[0]; }

TEST(ChosenDesign, IsTheBestUnlessAnotherIsNamed) {
  EXPECT_NEAR(a_of({}), 0.18, 1e-12);
  EXPECT_NEAR(a_of({.baseline = true}), 0.22, 1e-12);
  EXPECT_NEAR(a_of({.generation = 0, .individual = 2, .stage = 1}), 0.12, 1e-12);
  EXPECT_NEAR(a_of({.generation = 1, .individual = 1, .stage = 1}), 0.14, 1e-12);
  EXPECT_NEAR(a_of({.generation = 1, .individual = 2}), 0.16, 1e-12);  // of the last stage
  EXPECT_NEAR(a_of({.front = 1}), 0.13, 1e-12);                        // of the only stage that has one
  EXPECT_NEAR(a_of({.front = 2, .stage = 1}), 0.12, 1e-12);
  const ChosenDesign design = chosen_design(contents(), study(), {.generation = 1, .individual = 2});
  EXPECT_EQ(design.words, "individual 2 of generation 1 of stage 2");
  EXPECT_EQ(design.file_name, "stage-2-generation-1-individual-2");
  EXPECT_EQ(design.parameters.size(), study().problem->parts().parameters.size());
}

std::string refusal(const DesignChoice& choice, const StudyContents& file = contents(), const Study& of = study()) {
  try {
    chosen_design(file, of, choice);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

TEST(ChosenDesign, RefusalsNameWhatThereIs) {
  EXPECT_EQ(refusal({.generation = 2, .individual = 1}),
            "--generation: found 2; expected a generation of stage 2, 0 to 1");
  EXPECT_EQ(refusal({.generation = -1, .individual = 1}),
            "--generation: found -1; expected a generation of stage 2, 0 to 1");
  EXPECT_EQ(refusal({.generation = 1, .individual = 3}),
            "--individual: found 3; expected an individual of generation 1, 1 to 2");
  EXPECT_EQ(refusal({.generation = 1, .individual = 0}),
            "--individual: found 0; expected an individual of generation 1, 1 to 2");
  EXPECT_EQ(refusal({.generation = 1, .individual = 1, .stage = 3}),
            "--stage: found 3; expected a stage with a generation: 1, 2");
  EXPECT_EQ(refusal({.front = 3}), "--front: found 3; expected a point of the front of stage 1, 1 to 2");
  EXPECT_EQ(refusal({.front = 1, .stage = 2}), "--stage: found 2; expected a stage with a front: 1");
  EXPECT_EQ(refusal({.baseline = true}, contents(), study("")),
            "--baseline: found study made up; expected a study with a [baseline]: this one has none");
  StudyContents empty = contents();
  empty.stages.clear();
  empty.best = {};
  EXPECT_THAT(refusal({}, empty), HasSubstr("found no best design in study made up"));
  EXPECT_THAT(refusal({.front = 1}, empty), HasSubstr("a study file that holds a front: this one has none"));
  EXPECT_THAT(refusal({.generation = 0, .individual = 1}, empty), HasSubstr("holds a generation: this one has none"));
}

TEST(ChosenDesign, RefusesContradictions) {
  EXPECT_THAT(refusal({.baseline = true, .front = 1}), HasSubstr("--baseline: found another design beside it"));
  EXPECT_THAT(refusal({.generation = 1, .individual = 1, .front = 1}),
              HasSubstr("--front: found another design beside it"));
  EXPECT_THAT(refusal({.generation = 1}), HasSubstr("--generation: found no --individual"));
  EXPECT_THAT(refusal({.individual = 1}), HasSubstr("--individual: found no --generation"));
  EXPECT_THAT(refusal({.stage = 1}), HasSubstr("--stage: found no --front or --generation"));
  EXPECT_THAT(refusal({.baseline = true, .stage = 1}), HasSubstr("--stage: found no --front or --generation"));
}

}  // namespace
}  // namespace pkm
