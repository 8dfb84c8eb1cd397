#include "engine/config/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "engine/math/portable.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "tests/unit/config/right_studies.hpp"

namespace pkm {
namespace {

using ::testing::ElementsAre;

using testing::kFull;
using testing::kSmallest;
using testing::read_right;

TEST(Study, SmallestStudyGetsDefaults) {
  const Study study = read_right(kSmallest);
  const ProblemParts& parts = study.problem->parts();
  EXPECT_EQ(study.name, "wide");
  EXPECT_EQ(study.seed, 1U);
  EXPECT_EQ(study.output_file(), "wide.h5");
  EXPECT_EQ(study.text, kSmallest);
  EXPECT_FALSE(study.baseline || study.round || study.checkpoint_every);
  EXPECT_THAT(parts.parameters, ElementsAre(0.2, 0.8, 0.5, 2));
  ASSERT_TRUE(parts.plan.columns());
  EXPECT_EQ(parts.plan.columns()->tolerance, 1e-8);
  EXPECT_TRUE(parts.plan.fixed.empty()) << "the usual coordinate is in the middle";
  EXPECT_THAT(parts.plan.limits.given, ElementsAre(std::nullopt, std::nullopt));
  EXPECT_EQ(study.problem->objectives()[0].direction, Direction::maximise);
  ASSERT_EQ(study.stages.size(), 1U);
  EXPECT_EQ(study.stages[0].entry->name, "ga");
  EXPECT_EQ(study.stages[0].options.integer("population"), 40);
  EXPECT_FALSE(study.stages[0].options.has("target"));
  EXPECT_EQ(study.stages[0].line, 7);
  EXPECT_THAT(study.warnings, ElementsAre());
}

TEST(Study, PreparesItsSurveyOnce) {
  const int before = testing::prepared_evaluators();
  read_right(kSmallest);
  EXPECT_EQ(testing::prepared_evaluators(), before + 1);
}

TEST(Study, ReadsParametersVariablesAndBaseline) {
  const Study study = read_right(kFull);
  const ProblemParts& parts = study.problem->parts();
  EXPECT_EQ(study.name, "wide <bounds>");
  EXPECT_EQ(study.seed, 7U);
  EXPECT_EQ(study.output_file(), "out.h5");
  EXPECT_THAT(parts.parameters, ElementsAre(0.2, 0.8, 0.5, 0.5));
  ASSERT_EQ(parts.space.dimension(), 2U);
  EXPECT_EQ(parts.space[0].name, "tilt") << "the order of the file, not of the mechanism";
  EXPECT_EQ(parts.space[0].lower, -kPi / 6);
  EXPECT_EQ(parts.space[0].step, 0);
  EXPECT_EQ(parts.space[1].lower, 0.25);
  EXPECT_EQ(parts.space[1].upper, 0.72);
  EXPECT_EQ(parts.space[1].step, 0.1);
  EXPECT_THAT(parts.varies, ElementsAre(2, 0));
  ASSERT_TRUE(study.baseline);
  EXPECT_THAT(*study.baseline, ElementsAre(0.8, 0.8, 0.5, 0.5));
  EXPECT_EQ(study.round, 0.01);
  EXPECT_EQ(study.checkpoint_every, 60);
  EXPECT_THAT(study.warnings,
              ElementsAre("variable a never reaches its max 0.72 m: the largest value min + k step is 0.65 m"));
}

TEST(Study, BoundsAndTargetsTakeTheUnitOfTheirEntry) {
  std::string text = kFull;
  const auto put = [&text](const std::string& was, const std::string& is) {
    text.replace(text.find(was), was.size(), is);
  };
  put("bound = 0", "bound = \"200 mm\"");
  put("target = 2", "target = \"20000 cm^2 rad\"");
  const Study study = read_right(text);
  EXPECT_EQ(study.constraints.back().options.number("bound"), 0.2);
  EXPECT_EQ(study.problem->parts().design_margins[0].unit, "m");
  EXPECT_EQ(study.stages[1].options.number("target"), 2);
}

TEST(Study, DefaultsThatDependOnTheVariablesAreFilledIn) {
  EXPECT_EQ(read_right(kSmallest).stages[0].options.integer("width"), 3);
  EXPECT_EQ(read_right(kFull).stages[1].options.integer("width"), 6);
  EXPECT_EQ(read_right(kSmallest + "width = 8\n").stages[0].options.integer("width"), 8);
}

TEST(Study, WarnsOfAnEmptyWorkspace) {
  const auto warnings = [](const std::string& more) { return read_right(kSmallest + more).warnings; };
  EXPECT_THAT(warnings("[workspace]\ny = 2\n"), ElementsAre());
  EXPECT_THAT(
      warnings("[workspace]\ny = 2.5\n"),
      ElementsAre("the workspace of the middle of the variables' bounds is empty: no pose on the plane y = 2.5 m "
                  "is feasible"));
  EXPECT_THAT(
      warnings("[baseline]\na = 1\n[workspace]\nmethod = \"voxels\"\ny = 2.5\n"
               "box = { x = [0, 1], z = [0, 1], theta = [\"-180 deg\", \"180 deg\"] }\n"),
      ElementsAre("the workspace of the baseline is empty: no pose on the plane y = 2.5 m in the box is feasible"));
  EXPECT_THAT(warnings("[workspace]\nmethod = \"voxels\"\ny = 2.5\ncells = { x = 101, z = 100, theta = 100 }\n"),
              ElementsAre())
      << "too many cells to survey while reading";
}

TEST(Study, ReadsReferences) {
  const Study study = read_right(std::string(kFull) + R"(
[[reference]]
name = "a paper"
design = { a = "300 mm" }
values = { volume = "5000 cm^2 rad", shape = 2 }
seconds = "2 min"
)");
  ASSERT_EQ(study.references.size(), 1U);
  EXPECT_EQ(study.references[0].name, "a paper");
  EXPECT_THAT(study.references[0].design, ElementsAre(std::nullopt, 0.3));
  EXPECT_THAT(study.references[0].values, ElementsAre(std::pair("volume", 0.5), std::pair("shape", 2.0)));
  EXPECT_EQ(study.references[0].seconds, 120);
}

TEST(Study, ReadsWorkspaceAndMergesLimits) {
  const Study study = read_right(kFull);
  const WorkspacePlan& plan = study.problem->parts().plan;
  ASSERT_TRUE(plan.voxels());
  EXPECT_THAT(plan.voxels()->cells, ElementsAre(32, 34, 60));
  ASSERT_TRUE(plan.box());
  EXPECT_THAT(*plan.box(), ElementsAre(ElementsAre(0, 0.8), ElementsAre(-1, 1), ElementsAre(-kPi / 2, 1.5)));
  ASSERT_EQ(plan.fixed.size(), 1u);
  EXPECT_EQ(plan.fixed[0].coordinate, 1);
  EXPECT_EQ(plan.fixed[0].kind, FixedCoordinate::Kind::value);
  EXPECT_EQ(plan.fixed[0].value, 0.2);
  EXPECT_THAT(plan.limits.given, ElementsAre(std::nullopt, kPi / 4));
  EXPECT_THAT(plan.limits.derived, ElementsAre(true, false));
  EXPECT_THAT(study.limit_origins, ElementsAre("constraint[1] gap (line 23)", "workspace.limits (line 19)"));
}

TEST(Study, WorkspaceVariants) {
  const auto plan = [](const std::string& workspace) {
    return read_right(kSmallest + "[workspace]\n" + workspace).problem->parts().plan;
  };
  EXPECT_THAT(plan("method = \"voxels\"").voxels()->cells, ElementsAre(32, 34, 60)) << "the paper's grid";
  EXPECT_FALSE(plan("method = \"voxels\"").box());
  EXPECT_EQ(plan("y = \"integrated\"").fixed.at(0).kind, FixedCoordinate::Kind::integrated);
  EXPECT_EQ(plan("y = \"middle\"").fixed.at(0).kind, FixedCoordinate::Kind::default_value);
  EXPECT_EQ(plan("method = \"voxels\"\ny = \"integrated\"").fixed.at(0).cells, 32);
  EXPECT_EQ(
      plan("method = \"voxels\"\ny = \"integrated\"\ncells = { x = 1, y = 9, z = 1, theta = 1 }").fixed.at(0).cells, 9);
  EXPECT_THAT(plan("nodes = { theta = 9, x = 12 }").columns()->nodes, ElementsAre(12, 9));
  EXPECT_THAT(plan("method = \"voxels\"\ncells = { x = 512, z = 512, theta = 1024 }").voxels()->cells,
              ElementsAre(512, 512, 1024));
  EXPECT_THAT(plan("limits = { gap_min = \"10 mm\" }").limits.given, ElementsAre(0.01, std::nullopt));
}

TEST(Study, ReadsObjectivesConstraintsReports) {
  const Study study = read_right(kFull);
  const ProblemParts& parts = study.problem->parts();
  ASSERT_EQ(parts.objectives.size(), 1U);
  EXPECT_EQ(parts.objectives[0].direction, Direction::minimise);
  EXPECT_EQ(parts.objectives[0].unit, "m^2 rad");
  ASSERT_EQ(parts.design_margins.size(), 1U);
  EXPECT_EQ(parts.design_margins[0].name, "linear");
  ASSERT_EQ(parts.workspace_margins.size(), 1U);
  EXPECT_EQ(parts.workspace_margins[0].name, "big-enough");
  EXPECT_EQ(parts.workspace_margins[0].lower_bound, 0.5);
  EXPECT_FALSE(parts.workspace_margins[0].upper_bound);
  ASSERT_EQ(parts.reports.size(), 1U);
  EXPECT_TRUE(parts.request.has(kConditioning));
  EXPECT_EQ(parts.request.characteristic_length, 0.12);
  const Options& options = study.outputs[0].options;
  EXPECT_EQ(options.word("statistic"), "min");
  EXPECT_EQ(options.integer("count"), 5);
  EXPECT_FALSE(options.flag("exact"));
  EXPECT_FALSE(options.has("weights"));
}

TEST(Study, GreatestValueMakesAMarginToo) {
  const Study study = read_right(kSmallest + "[[constraint]]\ntype = \"volume\"\nmax = 2\n");
  const auto& margin = study.problem->parts().workspace_margins.at(0);
  EXPECT_EQ(margin.upper_bound, 2);
  EXPECT_FALSE(margin.lower_bound);
}

TEST(Study, ReadsStagesInOrder) {
  const Study study = read_right(kFull);
  ASSERT_EQ(study.stages.size(), 2U);
  EXPECT_EQ(study.stages[0].entry->name, "sweep");
  EXPECT_EQ(study.stages[1].options.integer("population"), 10);
  EXPECT_EQ(study.stages[1].options.number("rate"), 0.5);
  EXPECT_EQ(study.stages[1].options.number("target"), 2);
  EXPECT_TRUE(study.stages[1].optimiser);
}

TEST(Study, TwoEntriesWithTheSameLengthShareOneSurvey) {
  const Study study = read_right(kSmallest +
                                 "[[output]]\ntype = \"shape\"\nlength = 1\n[[output]]\ntype = \"shape\"\nname = "
                                 "\"worst\"\nlength = 1\nstatistic = \"min\"\n");
  EXPECT_EQ(study.problem->parts().request.characteristic_length, 1);
}

TEST(Study, FileOnDiskReadsLikeItsText) {
  const std::string path = ::testing::TempDir() + "/from-disk.toml";
  std::ofstream(path) << kFull;
  const Study study = load_study_toml(path, testing::fake_catalogues());
  EXPECT_EQ(study.text, kFull);
  EXPECT_EQ(study.file_name, path);
  EXPECT_EQ(study.problem->space().dimension(), 2U);
}

}  // namespace
}  // namespace pkm
