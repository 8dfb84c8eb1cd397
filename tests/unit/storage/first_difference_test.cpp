// Tests of first_difference(), which compares studies in tests of resuming: it detects every difference in results, and
// ignores times, machine and program version.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/storage/first_difference.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

/// The first difference between the sample study and a copy of it after the change.
std::string difference_after(void (*change)(StudyContents&)) {
  StudyContents changed = test::sample_study();
  change(changed);
  return first_difference(test::sample_study(), changed);
}

TEST(FirstDifference, IsEmptyForEqualStudies) {
  EXPECT_EQ(first_difference(test::sample_study(), test::sample_study()), "");
}

TEST(FirstDifference, IgnoresTimesMachineAndProgram) {
  EXPECT_EQ(difference_after([](StudyContents& s) {
              s.machine = s.created = s.updated = s.program_revision = s.program_version = s.toml_file =
                  s.description->file_name = "x";
              s.seconds = 1e9;
              s.stages[0].table.seconds[2] = 7;
              s.stages[0].generations.seconds[1] = 7;
            }),
            "");
}

TEST(FirstDifference, NamesPathAndBothValues) {
  EXPECT_EQ(difference_after([](StudyContents& s) { s.seed = 5; }), "/@seed: 18364758544493064720 against 5");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.state = StudyState::finished; }),
            "/@state: 'interrupted' against 'finished'");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.problem.variables[1].step = 0.5; }),
            "/problem/variables/step[1]: 0 against 0.5");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.stages[0].generations.population[5] = 6; }),
            "/stages/1/generations/population[5]: 5 against 6");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.stages[0].table.status[3] = Status::feasible; }),
            "/stages/1/evaluations/status[3]: 3 against 0");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.stages[0].best_row = 2; }), "/stages/1@best_row: 8 against 2");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.final->map->voxels.feasible[4] = 0; }),
            "/final/map/feasible[0]: 1 against 0");
}

TEST(FirstDifference, DetectsASingleBit) {
  EXPECT_EQ(difference_after([](StudyContents& s) { s.stages[0].table.margins[0] = 0.0; }),
            "/stages/1/evaluations/margin[0].workspace-shape: -0 against 0");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.stages[0].table.objectives[1] = std::nan(""); }),
            "/stages/1/evaluations/objective[1].workspace-ratio: nan against nan");
  EXPECT_NE(difference_after([](StudyContents& s) {
              double& x = s.stages[0].table.designs[7];
              x = std::nextafter(x, 1.0);
            }),
            "");
}

TEST(FirstDifference, DetectsMissingItems) {
  EXPECT_EQ(difference_after([](StudyContents& s) { s.extensions.pop_back(); }),
            "/extensions/stage: 2 against 1 values");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.stages.pop_back(); }), "/stages@count: 3 against 2");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.final.reset(); }), "only one has /final@volume_unit");
  EXPECT_EQ(difference_after([](StudyContents& s) { s.final->baseline.reset(); }),
            "/final/baseline@status against /final/best_exact@status");
}

}  // namespace
}  // namespace pkm
