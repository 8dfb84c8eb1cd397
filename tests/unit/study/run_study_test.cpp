// The runner inside the process: every generation a resume starts from, chains of stages, what the end records.
#include "engine/study/run_study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>

#include "constraints/all.hpp"
#include "engine/core/instruction_set.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/storage/study_file.hpp"
#include "objectives/all.hpp"
#include "tests/unit/setup/real_studies.hpp"
#include "tests/unit/storage/first_difference.hpp"
#include "tests/unit/study/stop_at.hpp"

namespace pkm::testing {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Ne;

const char* const kStudy = R"([study]
name = "two stages"
seed = 3
[mechanism]
type = "4ppa-2par"
[variables]
a   = { min = 0.15, max = 0.3 }
b   = { min = 1.0, max = 1.5 }
l_u = { min = 0.5, max = 0.7 }
[baseline]
a = 0.2
[workspace]
method = "voxels"
cells = { x = 12, z = 14, theta = 16 }
[[objective]]
type = "workspace-ratio"
[[report]]
type = "conditioning"
[[constraint]]
type = "workspace-volume"
min = 0.3
[[stage]]
optimiser = "ga"
population = 8
generations = 6
[[stage]]
optimiser = "ga"
population = 6
generations = 4
crossover = "sbx"
[final]
round = 0.05
[checkpoint]
every = 0
)";

class RunStudy : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "pkmopt-run-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    std::signal(SIGINT, SIG_DFL);  // a script's background process ignores it
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return folder_ + "/" + name; }

  std::string folder_;
};

TEST_F(RunStudy, GoesOnUnderASignalThatTheProcessIgnores) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  StopAt at(2);
  std::signal(SIGINT, SIG_IGN);
  EXPECT_EQ(run_study(study, path("s.h5"), false, {}, at).stopped, "");
  EXPECT_EQ(std::signal(SIGINT, SIG_DFL), SIG_IGN);
}

/// Lets a second writer in: removes the study's lock and replaces the study.
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

TEST_F(RunStudy, WhoseLockIsTakenAwayLeavesTheFileToOthersAndKeepsItsOwn) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto straight = run_study(study, path("straight.h5"), false, {}, silent);
  const std::string kept = path("s-kept-" + std::to_string(::getpid()) + ".h5");
  Intruder intruder(path("s.h5"));
  try {
    run_study(study, path("s.h5"), false, {}, intruder);
    FAIL() << "nothing was noticed";
  } catch (const StorageError& error) {
    EXPECT_EQ(error.what(), path("s.h5") +
                                ": its lock was removed while the study ran, so another process may write "
                                "it; what this run has found is in " +
                                kept + ", and can be resumed there");
  }
  std::ifstream file(path("s.h5"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "the second writer's");
  EXPECT_EQ(first_difference(straight.contents, resume_study(kept, all_catalogues(), {}, {}, silent).contents), "");
}

TEST_F(RunStudy, RecordsThatAreNotThoseOfTheTextAreRefused) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const StudyContents sound = run_study(study, path("s.h5"), false, {}, silent).contents;
  EXPECT_EQ(study_of(sound, all_catalogues()).name, "two stages");
  const auto refusal = [&](const auto& forge) -> std::string {
    StudyContents forged = sound;
    forge(forged);
    try {
      study_of(forged, all_catalogues());
    } catch (const StorageError& error) {
      return error.what();
    }
    return "none";
  };
  const std::string begin = "the study's text and what is recorded of it disagree: ";
  EXPECT_EQ(refusal([](StudyContents& c) { c.problem.mechanism = "quadrupteron"; }),
            begin + "4ppa-2par as mechanism, and quadrupteron");
  EXPECT_EQ(refusal([](StudyContents& c) {
              c.description = {"[mechanism]", "m.toml"};
            }),
            begin + "no file of a mechanism, and one");
  EXPECT_EQ(refusal([](StudyContents& c) {
              c.problem.variables.push_back({"l_d", "m", 0.5, 0.7, 0});
            }),
            begin + "the variables a, b, l_u, and a, b, l_u, l_d");
  EXPECT_EQ(refusal([](StudyContents& c) { c.stages.push_back(c.stages.back()); }), begin + "2 stages, and 3");
  EXPECT_EQ(refusal([](StudyContents& c) { c.stages[1].optimiser = "nlopt"; }), begin + "stage 2 by ga, and by nlopt");
  EXPECT_EQ(refusal([](StudyContents& c) {
              c.extensions.push_back({-1, "generations", 9});
            }),
            begin + "2 stages, and a new limit of stage 0");
}

TEST_F(RunStudy, ResumedAtEveryGenerationEqualsTheStraightRun) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto straight = run_study(study, path("straight.h5"), false, {}, silent);
  EXPECT_EQ(straight.stopped, "");
  const int generations = 7 + 5;
  for (int stop = 0; stop < generations; ++stop) {
    const std::string file = path("s" + std::to_string(stop) + ".h5");
    StopAt at(stop);
    const auto first = run_study(study, file, false, {}, at);
    // A stop in a stage's last generation lets the stage end; in the last stage of all the study is then finished.
    EXPECT_EQ(first.stopped, stop == generations - 1 ? "" : "SIGINT") << stop;
    const auto second = resume_study(file, all_catalogues(), {}, {}, silent);
    EXPECT_EQ(second.stopped, "");
    EXPECT_EQ(first_difference(straight.contents, second.contents), "") << stop;
    EXPECT_EQ(first_difference(straight.contents, read_study(file)), "") << stop;
    EXPECT_LE(first.evaluations + second.evaluations, straight.evaluations);
  }
}

/// How many evaluations of the objective "scarce" there is memory for.
std::atomic<int> memory_left;

Catalogues catalogues_with_scarce() {
  Catalogues all = all_catalogues();
  all.objectives.push_back({.name = "scarce",
                            .meaning = "needs memory",
                            .make =
                                [](const EntryContext&) {
                                  return make_quantity([]<class S>(const DesignView<S>& design) {
                                    if (memory_left-- <= 0) throw std::bad_alloc();
                                    const S a = design.parameters[0], b = design.parameters[1];
                                    return S(a * b - a * a - b * b);
                                  });
                                },
                            .reads_survey = false});
  return all;
}

const char* const kScarceStudy = R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.3 }
b = { min = 1.0, max = 1.5 }
[workspace]
method = "voxels"
cells = { x = 6, z = 6, theta = 6 }
[[objective]]
type = "scarce"
[checkpoint]
every = 3600
)";

TEST_F(RunStudy, OutOfMemoryEndsTheRunWithACheckpointAndNoDesignFails) {
  const std::string ga = "[[stage]]\noptimiser = \"ga\"\npopulation = 8\ngenerations = 3\n";
  const std::string stages[] = {
      ga + ga, ga + "[[stage]]\noptimiser = \"nlopt\"\nalgorithm = \"slsqp\"\nevaluations = 8\n",
      "[[stage]]\noptimiser = \"ipopt\"\nevaluations = 8\n", "[[stage]]\noptimiser = \"sweep\"\npoints = 4\n"};
  constexpr int kPlenty = 1 << 30;
  for (const std::string& stage : stages) {
    const Catalogues all = catalogues_with_scarce();
    const Study study = read_study_toml(kScarceStudy + stage, "scarce.toml", all);
    Progress silent;
    memory_left = kPlenty;
    const auto straight = run_study(study, path("straight.h5"), true, {.threads = 1}, silent);
    const int asked = kPlenty - memory_left;  // by the stages' evaluations and by the final ones
    ASSERT_GT(asked, straight.evaluations);
    std::int64_t most_kept = 0;
    for (int memory = 0; memory < asked; memory += memory < asked - 4 ? 7 : 1) {
      SCOPED_TRACE(stage + "memory for " + std::to_string(memory) + " evaluations");
      const std::string file = path("s.h5");
      memory_left = memory;
      try {
        run_study(study, file, true, {.threads = 1 + memory % 2}, silent);
        FAIL() << "nothing was noticed";
      } catch (const StorageError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file + ": out of memory in stage "));
        EXPECT_THAT(error.what(), HasSubstr(" and can be resumed, with fewer threads or more memory"));
      }
      const StudyContents kept = read_study(file);
      EXPECT_EQ(kept.state, StudyState::interrupted);
      for (const StageRecord& record : kept.stages) EXPECT_THAT(record.table.status, Each(Ne(Status::failed)));
      if (stage.ends_with("evaluations = 8\n") && memory < straight.evaluations && kept.stages.size() == 1) {
        EXPECT_LE(kept.evaluations(), memory);
      }
      most_kept = std::max(most_kept, kept.evaluations());
      memory_left = 0;  // the resumed run has no memory for anything new: what is kept stays
      EXPECT_THROW(resume_study(file, all, {}, {}, silent), StorageError);
      EXPECT_EQ(first_difference(kept, read_study(file)), "");
      memory_left = kPlenty;
      const auto resumed = resume_study(file, all, {}, {.threads = 2}, silent);
      EXPECT_EQ(resumed.evaluations, straight.evaluations - kept.evaluations());
      EXPECT_EQ(first_difference(straight.contents, resumed.contents), "");
      EXPECT_EQ(first_difference(straight.contents, read_study(file)), "");
    }
    EXPECT_EQ(most_kept, straight.evaluations);  // where memory was short in the end
  }
}

// As on a machine that has less than the one that goes on.
TEST_F(RunStudy, GoesOnWithTheSameBitsOnAnotherInstructionSet) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto straight = run_study(study, path("straight.h5"), false, {}, silent);
  StopAt at(4);
  use_instruction_set(InstructionSet::baseline);
  auto begun = run_study(study, path("a.h5"), false, {}, at).contents;
  use_instruction_set(widest_instruction_set());
  EXPECT_THAT(begun.machine, HasSubstr(", baseline, "));
  begun.machine = "a 4004, 1 cores, baseline, none";
  write_study(path("a.h5"), begun);
  const auto resumed = resume_study(path("a.h5"), all_catalogues(), {}, {}, silent).contents;
  EXPECT_EQ(first_difference(straight.contents, resumed), "");
  EXPECT_THAT(resumed.notes, ElementsAre(HasSubstr("begun on a 4004, 1 cores, baseline, none, went on on ")));
}

TEST_F(RunStudy, StoppingWhileItReplaysKeepsTheFile) {
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

TEST_F(RunStudy, TheEndRecordsBestBaselineRoundedAndMap) {
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
  // the second stage starts from the first one's best
  const auto start = contents.stages[1].table.design(0);
  const StageRecord& first = contents.stages[0];
  EXPECT_TRUE(std::ranges::equal(start, first.table.design(static_cast<std::size_t>(first.best_row))));
}

TEST_F(RunStudy, RefusesOtherAlgorithmsAndOtherPaths) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  StopAt at(3);
  auto contents = run_study(study, path("a.h5"), false, {}, at).contents;
  const auto message = [&](const StudyContents& c) {
    write_study(path("b.h5"), c);
    Progress silent;
    try {
      resume_study(path("b.h5"), all_catalogues(), {}, {}, silent);
    } catch (const StorageError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  StudyContents other = contents;
  other.algorithms = kAlgorithms + 1;
  EXPECT_THAT(message(other), HasSubstr("b.h5 was written by pkmopt"));
  StudyContents edited = contents;
  edited.stages[0].table.designs[5] += 1e-9;
  EXPECT_THAT(message(edited), HasSubstr("b.h5 cannot be continued: "));
}

// A file from before the mechanism had its last parameters: they are added, at their defaults.
TEST_F(RunStudy, AParameterGainedSinceIsNoObstacle) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  Progress silent;
  const auto straight = run_study(study, path("straight.h5"), false, {}, silent).contents;
  StopAt at(4);
  StudyContents old = run_study(study, path("a.h5"), false, {}, at).contents;
  const std::size_t count = old.problem.parameters.size();
  old.problem.parameters.resize(count - 2);
  write_study(path("old.h5"), old);
  EXPECT_EQ(read_study(path("old.h5")).problem.parameters.size(), count - 2);
  const auto resumed = resume_study(path("old.h5"), all_catalogues(), {}, {}, silent);
  EXPECT_EQ(resumed.stopped, "");
  EXPECT_EQ(first_difference(straight, read_study(path("old.h5"))), "");
}

TEST_F(RunStudy, RefusesAProblemThatHasChanged) {
  const Study study = read_study_toml(kStudy, "two.toml", all_catalogues());
  StopAt at(3);
  const auto contents = run_study(study, path("a.h5"), false, {}, at).contents;
  const auto message = [&](const auto& change) {
    StudyContents changed = contents;
    change(changed.problem.parameters);
    write_study(path("b.h5"), changed);
    Progress silent;
    try {
      resume_study(path("b.h5"), all_catalogues(), {}, {}, silent);
    } catch (const StorageError& error) {
      return std::string(error.what()).substr(path("b.h5").size());
    }
    return std::string("accepted");
  };
  using Parameters = std::vector<ParameterRecord>;
  EXPECT_EQ(message([](Parameters& p) { p[4].value = 0.16; }),
            " cannot be continued: it was begun with d = 0.16 m, where this program takes 0.15 m");
  EXPECT_EQ(message([](Parameters& p) { p[4].name = "height"; }),
            " cannot be continued: it has the parameter height, which this program's mechanism 4ppa-2par has not");
  EXPECT_EQ(message([](Parameters&) {}), "accepted");
}

TEST_F(RunStudy, RefusesALimitThatTheLastStageHasNot) {
  const Study study = read_study_toml(R"([mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.15, max = 0.3 }
[workspace]
method = "columns"
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "sweep"
points = 5
)",
                                      "s.toml", all_catalogues());
  Progress silent;
  run_study(study, path("a.h5"), false, {}, silent);
  try {
    resume_study(path("a.h5"), all_catalogues(), {.generations = 5, .evaluations = {}}, {}, silent);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "--generations: found an optimiser 'sweep' as the last stage; expected one that has a limit on "
                 "generations");
  }
}

TEST_F(RunStudy, ASweepGoesThroughTheBaseline) {
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
  // the document's values over a: 0.510, 0.621, 0.597, 0.285 at 0.15, 0.3, 0.5, 0.95
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
