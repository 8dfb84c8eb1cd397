// A run for which memory runs out keeps what is complete.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <new>

#include "tests/unit/storage/first_difference.hpp"
#include "tests/unit/study/run_study.hpp"

namespace pkm::testing {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Ne;

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

}  // namespace
}  // namespace pkm::testing
