// Tests of write_study() and read_study(): everything that is written is read back unchanged.
#include "engine/storage/study_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <cstring>

#include "tests/unit/storage/first_difference.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using test::Folder;
using test::slurp;
using test::storage_error;
using ::testing::HasSubstr;

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

TEST(StudyFile, StoresEverything) {
  const Folder folder;
  const StudyContents written = test::sample_study();
  write_study(folder / "s.h5", written);
  const StudyContents read = read_study(folder / "s.h5");

  EXPECT_EQ(first_difference(written, read), "");
  // Items that first_difference() ignores, and a sample of the others, checked independently of it.
  EXPECT_EQ(read.toml, written.toml);
  EXPECT_EQ(read.toml_file, "wide.toml");
  ASSERT_TRUE(read.description);
  EXPECT_EQ(read.description->text, written.description->text);
  EXPECT_EQ(read.description->file_name, "delta.toml");
  EXPECT_EQ(read.seed, 0xfedcba9876543210u);
  EXPECT_EQ(read.program_version, "0.1.0");
  EXPECT_EQ(read.program_revision, "abc123");
  EXPECT_EQ(read.machine, written.machine);
  EXPECT_EQ(read.created, written.created);
  EXPECT_EQ(read.updated, written.updated);
  EXPECT_EQ(read.seconds, 12.5);
  EXPECT_EQ(read.state, StudyState::interrupted);
  EXPECT_EQ(read.problem.objectives[0].direction, Direction::maximise);
  EXPECT_EQ(read.problem.parameters[2].variable, -1);
  EXPECT_EQ(read.problem.shape(), written.problem.shape());
  ASSERT_EQ(read.stages.size(), 3u);
  const EvaluationTable &a = written.stages[0].table, &b = read.stages[0].table;
  EXPECT_EQ(b.shape(), a.shape());
  EXPECT_TRUE(same_bits(a.designs, b.designs));
  EXPECT_TRUE(same_bits(a.objectives, b.objectives));
  EXPECT_TRUE(same_bits(a.margins, b.margins));
  EXPECT_TRUE(same_bits(a.reports, b.reports));
  EXPECT_EQ(b.status, a.status);
  EXPECT_EQ(b.seconds, a.seconds);
  EXPECT_EQ(read.stages[0].generations.seconds, written.stages[0].generations.seconds);
  EXPECT_THAT(read.stages[0].generations.population_of(1), testing::ElementsAre(4, 5, 6, 7));
  EXPECT_THAT(read.stages[0].generations.population_of(2), testing::ElementsAre(8, 9, 10, 11));
  EXPECT_EQ(read.stages[1].table.size(), 0u);
  EXPECT_EQ(read.evaluations(), 18);
  EXPECT_EQ(read.stages[2].table.shape(), written.problem.shape(Detail::derivatives));
  EXPECT_TRUE(same_bits(written.stages[2].table.derivatives, read.stages[2].table.derivatives));
  ASSERT_EQ(read.stages[2].starts.size(), 2u);
  EXPECT_EQ(read.stages[2].starts[1].origin, "Sobol point 1");
  EXPECT_EQ(read.stages[2].starts[1].stop, "time limit");
  ASSERT_EQ(read.stages[2].ahead.size(), 2u);
  EXPECT_EQ(read.stages[2].ahead[0].number, 3);
  EXPECT_FALSE(read.stages[2].ahead[0].outcome);
  EXPECT_TRUE(same_bits(read.stages[2].ahead[0].table.derivatives, written.stages[2].ahead[0].table.derivatives));
  EXPECT_EQ(read.stages[2].ahead[1].outcome->origin, "Sobol point 3");
  ASSERT_TRUE(read.stages[2].optimality);
  EXPECT_EQ(read.stages[2].optimality->active[0].multiplier, 0.2);
  EXPECT_TRUE(std::isnan(read.stages[2].optimality->sensitivities[0].reoptimised));
  EXPECT_FALSE(read.stages[0].optimality);
  ASSERT_TRUE(read.stages[0].front);
  EXPECT_THAT(read.stages[0].front->rows, testing::ElementsAre(4, 0, 8));
  EXPECT_THAT(read.stages[0].front->reference, testing::ElementsAre(0.25));
  EXPECT_TRUE(same_bits(written.stages[0].front->hypervolume, read.stages[0].front->hypervolume));
  EXPECT_EQ(read.stages[0].front->spread, written.stages[0].front->spread);
  EXPECT_EQ(read.stages[0].front->igd_plus, written.stages[0].front->igd_plus);
  EXPECT_FALSE(read.stages[1].front);
  EXPECT_FALSE(read.reproducible());
  EXPECT_EQ(read.notes, written.notes);
  ASSERT_TRUE(read.final && read.final->best && read.final->baseline && read.final->map);
  EXPECT_FALSE(read.final->rounded);
  EXPECT_TRUE(read.final->best->touches_box);
  EXPECT_EQ(read.final->baseline->reason, "does not assemble");
  EXPECT_EQ(read.final->map->voxels.feasible, written.final->map->voxels.feasible);
  EXPECT_EQ(read.final->map->voxels.cells[2], 3);
}

TEST(StudyFile, StoresAnEmptyStudy) {
  const Folder folder;
  write_study(folder / "s.h5", StudyContents{});
  const StudyContents read = read_study(folder / "s.h5");
  EXPECT_EQ(first_difference(StudyContents{}, read), "");
  EXPECT_FALSE(read.description);
  EXPECT_EQ(read.stages.size(), 0u);
  EXPECT_EQ(read.best.row, -1);
  EXPECT_FALSE(read.final);
}

TEST(StudyFile, StoresAStudyWithoutMarginsAndReports) {
  const Folder folder;
  StudyContents study = test::sample_study();
  study.problem.margins.clear();
  study.problem.reports.clear();
  study.stages = {test::sample_stage(study.problem.shape(), 2, 5), test::sample_stage(study.problem.shape(), 0, 0)};
  study.best = {0, 1};
  study.final.reset();
  write_study(folder / "s.h5", study);
  const StudyContents read = read_study(folder / "s.h5");
  EXPECT_EQ(first_difference(study, read), "");
  EXPECT_EQ(read.stages[0].table.size(), 10u);
  EXPECT_EQ(read.stages[0].table.margin_row(3).size(), 0u);
}

TEST(StudyFile, RowsOfStartsMustBeContiguous) {
  const Folder folder;
  StudyContents study = test::sample_study();
  study.stages[2].starts[1].first_row = 3;
  EXPECT_THAT(storage_error([&] { write_study(folder / "s.h5", study); }),
              HasSubstr("/stages/3: starts: rows overlap, leave a gap or exceed the evaluations"));
  study = test::sample_study();
  study.stages[2].starts[0].end_row = 2;
  EXPECT_THAT(storage_error([&] { write_study(folder / "s.h5", study); }),
              HasSubstr("/stages/3: starts: end_row out of range"));
  study = test::sample_study();
  study.stages[2].ahead[0].number = 1;
  EXPECT_THAT(storage_error([&] { write_study(folder / "s.h5", study); }),
              HasSubstr("/stages/3: ahead: a start is also in starts, or has no evaluations"));
  study = test::sample_study();
  study.stages[2].ahead[1].outcome->end_row = 2;
  EXPECT_THAT(storage_error([&] { write_study(folder / "s.h5", study); }),
              HasSubstr("/stages/3: ahead: row index out of range"));
}

TEST(StudyFile, StoresPopulationsOfDifferentSizes) {
  const Folder folder;
  StudyContents study = test::sample_study();
  GenerationRecords& generations = study.stages[0].generations;
  generations.population = {3, 1, 2, 2, 11};
  generations.population_first = {0, 3, 3};
  write_study(folder / "s.h5", study);
  const GenerationRecords read = read_study(folder / "s.h5").stages[0].generations;
  EXPECT_THAT(read.population_of(0), testing::ElementsAre(3, 1, 2));
  EXPECT_THAT(read.population_of(1), testing::ElementsAre());
  EXPECT_THAT(read.population_of(2), testing::ElementsAre(2, 11));
}

TEST(StudyFile, EqualContentsGiveEqualBytes) {
  const Folder folder;
  write_study(folder / "a.h5", test::sample_study());
  write_study(folder / "b.h5", test::sample_study());
  EXPECT_EQ(slurp(folder / "a.h5"), slurp(folder / "b.h5"));
}

TEST(StudyFile, LeavesNoTemporaryFiles) {
  const Folder folder;
  write_study(folder / "s.h5", test::sample_study());
  write_study(folder / "s.h5", StudyContents{});
  std::size_t entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) entries += !entry.path().empty();
  EXPECT_EQ(entries, 1u);
  EXPECT_EQ(read_study(folder / "s.h5").name, "");
}

TEST(StudyFile, IsReadableWithoutWritePermission) {
  const Folder folder;
  write_study(folder / "s.h5", test::sample_study());
  ASSERT_EQ(::chmod((folder / "s.h5").c_str(), 0444), 0);
  EXPECT_EQ(read_study(folder / "s.h5").seed, 0xfedcba9876543210u);
}

}  // namespace
}  // namespace pkm
