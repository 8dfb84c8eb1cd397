// Tests of reading study files of earlier schemas.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/storage/study_file.hpp"

namespace pkm {
namespace {

TEST(StudyFile, FilesOfSchemaOneAreReadable) {
  // The file was written by write_study() when schema 1 was released, from sample_study() with a short TOML text. It
  // must never be replaced. The expected values are stated here, because sample_study.hpp may change.
  const StudyContents study = read_study(PKM_TEST_DATA "/schema-1.h5");
  EXPECT_EQ(study.name, "Größe, 4PPa-2PaR <b>");
  EXPECT_EQ(study.toml, "[study]\nname = \"Größe\"\n");
  EXPECT_EQ(study.seed, 0xfedcba9876543210u);
  EXPECT_EQ(study.algorithms, 3);
  EXPECT_EQ(study.state, StudyState::interrupted);
  ASSERT_EQ(study.extensions.size(), 2u);
  EXPECT_EQ(study.extensions[1].limit, "time");
  EXPECT_EQ(study.extensions[1].value, 1.5);
  EXPECT_EQ(study.problem.mechanism, "4ppa-2par");
  ASSERT_EQ(study.problem.shape(), (EvaluationShape{2, 1, 2, 1}));
  EXPECT_EQ(study.problem.variables[0].step, 0.001);
  EXPECT_EQ(study.problem.objectives[0].direction, Direction::maximise);
  EXPECT_EQ(study.problem.margins[1].name, "rail-length");
  ASSERT_EQ(study.stages.size(), 2u);
  const StageRecord& stage = study.stages[0];
  EXPECT_EQ(stage.optimiser, "ga");
  EXPECT_EQ(stage.stop, "generation limit");
  EXPECT_THAT(stage.options, testing::ElementsAre("population = 4", "crossover = sbx"));
  ASSERT_EQ(stage.table.size(), 12u);
  EXPECT_EQ(stage.table.design(0)[0], 3.9 * 0.1 * 0.9);
  EXPECT_EQ(stage.table.status[3], Status::failed);
  EXPECT_TRUE(std::isnan(stage.table.output_row(4)[0]));
  EXPECT_THAT(stage.generations.population_of(1), testing::ElementsAre(4, 5, 6, 7));
  EXPECT_EQ(study.best.row, 8);
  ASSERT_TRUE(study.final && study.final->best && study.final->map);
  EXPECT_EQ(study.final->best->feasible_cells, 12412);
  EXPECT_THAT(study.final->map->voxels.feasible, testing::ElementsAre(0, 1, 1, 0, 1, 0));
  EXPECT_THAT(study.final->active, testing::ElementsAre("a at its upper bound", "rail-length"));
}

TEST(StudyFile, FilesOfSchemaTwoAreReadable) {
  // Written when schema 2 was released, like schema-1.h5; must never be replaced.
  const StudyContents study = read_study(PKM_TEST_DATA "/schema-2.h5");
  ASSERT_EQ(study.stages.size(), 3u);
  const StageRecord& stage = study.stages[2];
  EXPECT_EQ(stage.optimiser, "ipopt");
  ASSERT_EQ(stage.table.shape(), (EvaluationShape{2, 1, 2, 1, Detail::derivatives}));
  EXPECT_EQ(stage.table.derivative_row(0)[0], 3.9 * 0.25 * 0.75);
  ASSERT_EQ(stage.starts.size(), 2u);
  EXPECT_EQ(stage.starts[0].message, "optimal solution found");
  EXPECT_EQ(stage.starts[1].end_row, 2);
  ASSERT_TRUE(stage.optimality);
  EXPECT_EQ(stage.optimality->active[1].kind, "upper bound");
  EXPECT_EQ(stage.optimality->sensitivities[2].reoptimised, 0.3);
  EXPECT_THAT(study.notes, testing::ElementsAre("stage 3: start 1 began anew."));
}

TEST(StudyFile, FilesOfSchemaThreeAreReadable) {
  // Written when schema 3 was released, like schema-1.h5; must never be replaced.
  const StudyContents study = read_study(PKM_TEST_DATA "/schema-3.h5");
  ASSERT_EQ(study.stages.size(), 3u);
  ASSERT_TRUE(study.stages[0].front);
  EXPECT_THAT(study.stages[0].front->rows, testing::ElementsAre(4, 0, 8));
  EXPECT_THAT(study.stages[0].front->reference, testing::ElementsAre(0.25));
  EXPECT_TRUE(std::isnan(study.stages[0].front->hypervolume[0]));
  EXPECT_THAT(study.stages[0].front->spread, testing::ElementsAre(0.1, 0.2, 0.3));
  EXPECT_THAT(study.stages[0].front->igd_plus, testing::ElementsAre(3, 2, 1));
}

}  // namespace
}  // namespace pkm
