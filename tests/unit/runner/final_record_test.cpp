// Tests of the final results of a study: the rounded best design and its remarks, exact values of voxel studies.
#include "engine/runner/final_record.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/runner/records.hpp"
#include "objectives/all.hpp"

namespace pkm {
namespace {

Study read(const std::string& text) {
  return read_study_toml(text, "s.toml", {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()});
}

/// A study with the variables a and b and the rounding step `round`.
Study study(const std::string& a_bounds, const std::string& b_bounds, const std::string& round) {
  return read(
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = " + a_bounds + "\nb = " + b_bounds +
      "\n[workspace]\nmethod = \"voxels\"\ncells = { x = 8, z = 8, theta = 8 }\n[[objective]]\ntype = "
      "\"workspace-volume\"\n[[output]]\ntype = \"conditioning\"\n[[stage]]\noptimiser = \"ga\"\n[final]\nround "
      "= " +
      round + "\n");
}

/// The final results of a study whose only evaluation is the design (a, b).
FinalRecord final_of(const Study& study, double a, double b) {
  StudyContents contents = new_contents(study);
  contents.stages.push_back({"ga", {}, EvaluationTable(study.problem->shape())});
  EvaluationTable& table = contents.stages[0].table;
  table.extend(1);
  table.design(0)[0] = a;
  table.design(0)[1] = b;
  contents.best = {0, 0};
  contents.final = final_record(study, contents);
  complete_final_record(study, contents);
  return *contents.final;
}

TEST(RoundedTo, IsTheNearestDecimalNumber) {
  EXPECT_EQ(rounded_to(0.7049, 0.01), 0.7);
  EXPECT_EQ(rounded_to(0.7051, 0.01), 0.71);
  EXPECT_EQ(rounded_to(0.69, 0.1), 0.7);
  EXPECT_EQ(rounded_to(-0.69, 0.1), -0.7);
  for (int i = 0; i <= 3000; ++i) EXPECT_EQ(rounded_to(i / 1000.0 + 4e-4, 0.001), i / 1000.0);
  EXPECT_EQ(rounded_to(1.2, 0.75), 1.5);  // 1 / step is not an integer
  EXPECT_EQ(rounded_to(13, 5), 15);
}

TEST(FinalRecord, EvaluatesTheRoundedDesign) {
  const Study s = study("{ min = 0.15, max = 0.3 }", "{ min = 0.5, max = 1.5 }", "0.1");
  const FinalRecord f = final_of(s, 0.2049, 0.69);
  ASSERT_TRUE(f.rounded);
  EXPECT_EQ(f.rounded->parameters[0], 0.2);
  EXPECT_EQ(f.rounded->parameters[1], 0.7);
  EXPECT_EQ(f.rounded->parameters[2], f.best->parameters[2]);  // fixed parameters are not rounded
  EXPECT_EQ(f.rounded->status, Status::feasible);
  EXPECT_EQ(f.rounded->reason, "");
  EXPECT_GT(f.rounded->objectives[0], 0);
}

TEST(FinalRecord, ReportsVariablesRoundedOutOfTheirBounds) {
  const Study s = study("{ min = 0.15, max = 0.204 }", "{ min = 0.992, max = 1.5 }", "0.01");
  const FinalRecord one = final_of(s, 0.2, 0.994);
  EXPECT_EQ(one.rounded->parameters[1], 0.99);
  EXPECT_EQ(one.rounded->reason, "b = 0.99 m lies outside its bounds");
  EXPECT_EQ(one.rounded->status, Status::feasible);  // it is evaluated nevertheless
  EXPECT_GT(one.rounded->objectives[0], 0);
  const Study both = study("{ min = 0.15, max = 0.156 }", "{ min = 0.992, max = 1.5 }", "0.01");
  EXPECT_EQ(final_of(both, 0.156, 0.994).rounded->reason,
            "a = 0.16 m lies outside its bounds; b = 0.99 m lies outside its bounds");
  const Study edge = study("{ min = 0.15, max = 0.21 }", "{ min = 0.99, max = 1.5 }", "0.01");
  EXPECT_EQ(final_of(edge, 0.2099, 0.9901).rounded->reason, "");  // bounds are inclusive
}

TEST(FinalRecord, DoesNotEvaluateParametersOutsideTheModelsRange) {
  const Study s = study("{ min = 0.002, max = 0.3 }", "{ min = 0.5, max = 1.5 }", "0.01");
  const FinalRecord f = final_of(s, 0.004, 0.7);
  EXPECT_EQ(f.best->status, Status::feasible);
  EXPECT_EQ(f.rounded->status, Status::failed);
  EXPECT_EQ(f.rounded->reason, "a = 0 is outside the model's range 0.001 to 100 m");
  ASSERT_EQ(f.rounded->objectives.size(), 1u);
  EXPECT_TRUE(std::isnan(f.rounded->objectives[0]));
  ASSERT_EQ(f.rounded->reports.size(), 1u);
  EXPECT_TRUE(std::isnan(f.rounded->reports[0]));
}

/// Final results of a voxel study whose only evaluation is its baseline.
struct Result {
  FinalRecord final;
  std::vector<std::string> notes;
};
Result study_in_box(const std::string& mechanism, const std::string& variable, const std::string& box,
                    const std::string& more = "") {
  const Study s = read("[mechanism]\ntype = \"" + mechanism + "\"\n[variables]\n" + variable +
                       " = { min = 0.15, max = 1.5 }\n[baseline]\n[workspace]\nmethod = \"voxels\"\n" +
                       (box.empty() ? "" : "box = { " + box + " }\n") + "[[objective]]\ntype = \"workspace-volume\"\n" +
                       more + "[[stage]]\noptimiser = \"ga\"\n");
  StudyContents contents = new_contents(s);
  contents.stages.push_back({"ga", {}, EvaluationTable(s.problem->shape())});
  contents.stages[0].table.extend(1);
  contents.stages[0].table.design(0)[0] = (*s.baseline)[s.problem->parts().varies[0]];
  contents.best = {0, 0};
  contents.notes = {"another", "no exact values of the best design: a note of an earlier run"};
  contents.final = final_record(s, contents);
  complete_final_record(s, contents);
  return {*contents.final, contents.notes};
}

TEST(FinalRecord, ExactValuesAreThoseWithinTheBox) {
  const Result free = study_in_box("4ppa-2par", "b", "");
  ASSERT_TRUE(free.final.best_exact && free.final.baseline_exact);
  EXPECT_EQ(free.notes, std::vector<std::string>{"another"});
  const Result cut = study_in_box("4ppa-2par", "b", "x = [0.4, 0.5], z = [-0.9, -0.8], theta = [-0.1, 0.1]");
  ASSERT_TRUE(cut.final.best_exact && cut.final.baseline_exact);
  EXPECT_LT(cut.final.best_exact->volume, 0.1 * free.final.best_exact->volume);
  EXPECT_NEAR(cut.final.best_exact->volume, cut.final.best->volume, 0.01 * cut.final.best->volume);
  EXPECT_EQ(cut.notes, free.notes);
  const Result spatial = study_in_box("3crr-r-cru", "l", "x = [0.1, 0.16], y = [0.1, 0.2], z = [0.2, 0.25]");
  ASSERT_TRUE(spatial.final.best_exact);
  EXPECT_GT(spatial.final.best_exact->volume, 0);
  EXPECT_NEAR(spatial.final.best_exact->volume, spatial.final.best->volume, 0.01 * spatial.final.best->volume);
}

TEST(FinalRecord, ABoxAroundAllReachablePosesChangesNoExactValue) {
  const Result free = study_in_box("4ppa-2par", "b", "");
  const Result boxed = study_in_box("4ppa-2par", "b", "x = [0, 0.8], z = [-1.3, 0], theta = [\"-90 deg\", \"90 deg\"]");
  ASSERT_TRUE(boxed.final.best_exact && boxed.final.baseline_exact);
  EXPECT_NEAR(boxed.final.best_exact->volume, free.final.best_exact->volume, 1e-7 * free.final.best_exact->volume);
  EXPECT_EQ(boxed.notes, free.notes);
}

TEST(FinalRecord, ExactValuesOfRegionsOnVoxelsAreNaN) {
  const Result found =
      study_in_box("4ppa-2par", "b", "",
                   "[[output]]\ntype = \"conditioning\"\nregion = \"task\"\n[[region]]\nname = \"task\"\nmethod = "
                   "\"voxels\"\nbox = { x = [0.4, 0.5], z = [-0.9, -0.8], theta = [-0.1, 0.1] }\n");
  EXPECT_GT(found.final.best->reports[0], 0);
  EXPECT_GT(found.final.best_exact->objectives[0], 0);
  EXPECT_TRUE(std::isnan(found.final.best_exact->reports[0]));
}

}  // namespace
}  // namespace pkm
