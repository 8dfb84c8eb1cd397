// Tests of runs that run out of memory: all complete generations are saved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <new>

#include "tests/unit/runner/run_study.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::testing {
namespace {

using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::Ne;

/// Number of evaluations of the objective "scarce" until it throws std::bad_alloc.
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
                            .uses_workspace = false});
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

TEST_F(RunStudy, OutOfMemoryEndsTheRunWithACheckpointWithoutFailedDesigns) {
  const std::string ga = "[[stage]]\noptimiser = \"ga\"\npopulation = 8\ngenerations = 3\n";
  const std::string stages[] = {
      ga + ga, ga + "[[stage]]\noptimiser = \"nlopt\"\nalgorithm = \"slsqp\"\nevaluations = 8\n",
      "[[stage]]\noptimiser = \"ipopt\"\nevaluations = 8\n", "[[stage]]\noptimiser = \"sweep\"\npoints = 4\n"};
  constexpr int kUnlimited = 1 << 30;
  for (const std::string& stage : stages) {
    const Catalogues all = catalogues_with_scarce();
    const Study study = read_study_toml(kScarceStudy + stage, "scarce.toml", all);
    Progress silent;
    memory_left = kUnlimited;
    const auto reference = run_study(study, path("reference.h5"), true, {.threads = 1}, silent);
    const int required = kUnlimited - memory_left;  // evaluations of the stages and of the final steps
    ASSERT_GT(required, reference.evaluations);
    std::int64_t max_saved = 0;
    for (int memory = 0; memory < required; memory += memory < required - 4 ? 7 : 1) {
      SCOPED_TRACE(stage + "memory for " + std::to_string(memory) + " evaluations");
      const std::string file = path("s.h5");
      memory_left = memory;
      try {
        run_study(study, file, true, {.threads = 1 + memory % 2}, silent);
        FAIL() << "no error";
      } catch (const StorageError& error) {
        EXPECT_THAT(error.what(), HasSubstr(file + ": out of memory in stage "));
        EXPECT_THAT(error.what(), HasSubstr(" and can be resumed with fewer threads or more memory"));
      }
      const StudyContents saved = read_study(file);
      EXPECT_EQ(saved.state, StudyState::interrupted);
      for (const StageRecord& record : saved.stages) EXPECT_THAT(record.table.status, Each(Ne(Status::failed)));
      if (stage.ends_with("evaluations = 8\n") && memory < reference.evaluations && saved.stages.size() == 1) {
        EXPECT_LE(saved.evaluations(), memory);
      }
      max_saved = std::max(max_saved, saved.evaluations());
      memory_left = 0;  // a resumed run without memory for new evaluations leaves the file unchanged
      EXPECT_THROW(resume_study(file, all, {}, {}, silent), StorageError);
      EXPECT_EQ(first_difference(saved, read_study(file)), "");
      memory_left = kUnlimited;
      const auto resumed = resume_study(file, all, {}, {.threads = 2}, silent);
      EXPECT_EQ(resumed.evaluations, reference.evaluations - saved.evaluations());
      EXPECT_EQ(first_difference(reference.contents, resumed.contents), "");
      EXPECT_EQ(first_difference(reference.contents, read_study(file)), "");
    }
    EXPECT_EQ(max_saved, reference.evaluations);  // if memory ran out in the final steps
  }
}

}  // namespace
}  // namespace pkm::testing
