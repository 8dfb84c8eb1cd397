// Tests of run_study() and resume_study(): resuming after every generation, sequences of stages, final results.
#include "engine/runner/run_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "engine/core/instruction_set.hpp"
#include "tests/unit/runner/run_study.hpp"
#include "tests/unit/runner/stop_at.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST_F(RunStudy, ContinuesAfterASignalThatTheProcessIgnores) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  StopAt at(2);
  std::signal(SIGINT, SIG_IGN);
  EXPECT_EQ(run_study(study, path("s.h5"), false, {}, at).stopped, "");
  EXPECT_EQ(std::signal(SIGINT, SIG_DFL), SIG_IGN);
}

/// Simulates a second writer: removes the lock file and replaces the study file during a run.
class Intruder final : public Progress {
 public:
  explicit Intruder(std::string study) : study_(std::move(study)) {}
  void generation(const ProgressReport& report) override {
    if (report.generation != 3) return;
    std::filesystem::remove(study_ + ".lock");
    std::ofstream(study_) << "the second writer's";
  }

 private:
  std::string study_;
};

TEST_F(RunStudy, WritesToAnotherFileIfItsLockFileIsRemoved) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto reference = run_study(study, path("reference.h5"), false, {}, silent);
  const std::string other = path("s-kept-" + std::to_string(::getpid()) + ".h5");
  Intruder intruder(path("s.h5"));
  try {
    run_study(study, path("s.h5"), false, {}, intruder);
    FAIL() << "no error";
  } catch (const StorageError& error) {
    EXPECT_EQ(error.what(), path("s.h5") +
                                ": its lock file was removed during the run, so that another process may use the "
                                "study; the results of this run are in " +
                                other + ", which can be resumed");
  }
  std::ifstream file(path("s.h5"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "the second writer's");
  EXPECT_EQ(first_difference(reference.contents, resume_study(other, all_catalogues(), {}, {}, silent).contents), "");
}

TEST_F(RunStudy, ResumedAtEveryGenerationEqualsTheUninterruptedRun) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto reference = run_study(study, path("reference.h5"), false, {}, silent);
  EXPECT_EQ(reference.stopped, "");
  const int generations = 7 + 5;
  for (int stop = 0; stop < generations; ++stop) {
    const std::string file = path("s" + std::to_string(stop) + ".h5");
    StopAt at(stop);
    const auto first = run_study(study, file, false, {}, at);
    // A stop requested in the last generation of a stage takes effect in the next stage; the last stage is finished.
    EXPECT_EQ(first.stopped, stop == generations - 1 ? "" : "SIGINT") << stop;
    const auto second = resume_study(file, all_catalogues(), {}, {}, silent);
    EXPECT_EQ(second.stopped, "");
    EXPECT_EQ(first_difference(reference.contents, second.contents), "") << stop;
    EXPECT_EQ(first_difference(reference.contents, read_study(file)), "") << stop;
    EXPECT_LE(first.evaluations + second.evaluations, reference.evaluations);
  }
}

// As on a machine with fewer instructions than the one on which the study is resumed.
TEST_F(RunStudy, ResumesWithIdenticalBitsOnAnotherInstructionSet) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto reference = run_study(study, path("reference.h5"), false, {}, silent);
  StopAt at(4);
  use_instruction_set(InstructionSet::baseline);
  auto started = run_study(study, path("a.h5"), false, {}, at).contents;
  use_instruction_set(widest_instruction_set());
  EXPECT_THAT(started.machine, HasSubstr(", baseline, "));
  started.machine = "a 4004, 1 cores, baseline, none";
  write_study(path("a.h5"), started);
  const auto resumed = resume_study(path("a.h5"), all_catalogues(), {}, {}, silent).contents;
  EXPECT_EQ(first_difference(reference.contents, resumed), "");
  EXPECT_THAT(resumed.notes, ElementsAre(HasSubstr("started on a 4004, 1 cores, baseline, none, resumed on ")));
}

TEST_F(RunStudy, StoppingDuringReplayLeavesTheFileUnchanged) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  StopAt at(9);
  run_study(study, path("a.h5"), false, {}, at);
  const auto before = read_study(path("a.h5"));
  StopAt early(2);
  const auto outcome = resume_study(path("a.h5"), all_catalogues(), {}, {}, early);
  EXPECT_EQ(outcome.stopped, "SIGINT");
  EXPECT_EQ(outcome.evaluations, 0);
  EXPECT_EQ(first_difference(before, read_study(path("a.h5"))), "");
  EXPECT_EQ(first_difference(before, outcome.contents), "");
}

TEST_F(RunStudy, RecordsBestBaselineRoundedAndMap) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto contents = run_study(study, path("a.h5"), false, {}, silent).contents;
  ASSERT_TRUE(contents.final && contents.final->best && contents.final->baseline && contents.final->rounded);
  const FinalRecord& f = *contents.final;
  EXPECT_EQ(f.best->status, Status::feasible);
  const StageRecord& stage = contents.stages[static_cast<std::size_t>(contents.best.stage)];
  EXPECT_EQ(f.best->objectives[0], stage.table.objective_row(static_cast<std::size_t>(contents.best.row))[0]);
  EXPECT_EQ(f.best->feasible_cells, std::count(f.map->voxels.feasible.begin(), f.map->voxels.feasible.end(), 1));
  EXPECT_THAT(f.map->axes, ElementsAre("x", "z", "theta"));
  EXPECT_THAT(f.map->units, ElementsAre("m", "m", "rad"));
  for (int i = 0; i < 3; ++i) {
    const double steps = f.rounded->parameters[static_cast<std::size_t>(i)] / 0.05;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
  }
  ASSERT_TRUE(f.best_exact);
  EXPECT_NEAR(f.best_exact->objectives[0] / f.best->objectives[0], 1, 0.1);  // a coarse grid
  EXPECT_EQ(f.best->reports.size(), 1u);
  EXPECT_EQ(contents.stages[1].options.empty(), false);
  EXPECT_EQ(contents.stages[0].stop, "generation limit");
  // the second stage starts from the best design of the first stage
  const auto start = contents.stages[1].table.design(0);
  const StageRecord& first = contents.stages[0];
  EXPECT_TRUE(std::ranges::equal(start, first.table.design(static_cast<std::size_t>(first.best_row))));
}

TEST_F(RunStudy, ASweepContainsTheBaseline) {
  const Study study = read_study_toml(R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.95 }
L0 = { min = 0, max = 5 }
[baseline]
a = 0.2
L0 = 2.5
[workspace]
method = "columns"
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "sweep"
points = 9
)",
                                      "s.toml", all_catalogues());
  Progress silent;
  const auto c = run_study(study, path("a.h5"), false, {}, silent).contents;
  EXPECT_NEAR(c.stages[0].table.objective_row(0)[0], 0.550157374606, 1e-9);
  // published volumes over a: 0.510, 0.621, 0.597, 0.285 at 0.15, 0.3, 0.5, 0.95
  const auto volume_at = [&](double a) {
    for (std::size_t r = 0; r < c.stages[0].table.size(); ++r)
      if (std::fabs(c.stages[0].table.design(r)[0] - a) < 1e-9 && c.stages[0].table.design(r)[1] == 2.5)
        return c.stages[0].table.objective_row(r)[0];
    return -1.0;
  };
  EXPECT_NEAR(volume_at(0.15), 0.510, 5e-4);
  EXPECT_NEAR(volume_at(0.95), 0.285, 5e-4);
}

}  // namespace
}  // namespace pkm::testing
